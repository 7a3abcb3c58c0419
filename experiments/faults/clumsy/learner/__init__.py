"""`components.learner` with a fuse."""
