"""`components.head` with a fuse."""
