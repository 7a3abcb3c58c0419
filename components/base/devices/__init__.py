"""Robots that base can drive."""
