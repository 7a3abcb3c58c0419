"""The camera of the emulated robot: pictures come from a socket of the test."""
