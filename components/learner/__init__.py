"""Memory, filter, model, sweep: turns percepts and applied commands into a policy table."""
