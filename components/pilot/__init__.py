"""Policies, teacher, trials, reverse: turns percepts into drive commands."""
