"""`components.tracker` with a fuse."""
