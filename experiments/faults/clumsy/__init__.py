"""The system's components, each of which fails on a message when it is told to."""
