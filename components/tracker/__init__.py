"""Keeps the object in the image centre; publishes the percept."""
