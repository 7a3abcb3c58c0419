"""Keyboard and gamepad."""
