"""Object centroid and table-edge slope from one image."""
