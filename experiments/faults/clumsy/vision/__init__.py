"""`components.vision` with a fuse."""
