"""What the verbs about recordings answer to a shell; 2, bad input, is given by `cli.main`."""

GOOD = 0
DIFFERENT = 1
LOSSY = 3
"""Right as far as it goes, but something is missing."""
