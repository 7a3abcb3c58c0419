"""Drives ahead, as a pilot would that has no eyes."""
