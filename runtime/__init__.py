"""Shells, launch files, supervision and logs. Names no component: the launch file does."""
