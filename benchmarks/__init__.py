"""Each prints the floor it compares with, measured in the same run."""
