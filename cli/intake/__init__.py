"""Brings data of others into a session."""
