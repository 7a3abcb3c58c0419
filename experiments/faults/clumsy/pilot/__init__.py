"""`components.pilot` with a fuse."""
