"""`components.simulator` with a fuse."""
