"""`components.grasper` with a fuse."""
