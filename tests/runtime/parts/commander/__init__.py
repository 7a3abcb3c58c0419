"""A part for the tests of the runtime."""
