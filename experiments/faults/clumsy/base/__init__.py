"""`components.base` with a fuse."""
