"""Frames for the eyes: from a device, or from a session that is played in its place."""
