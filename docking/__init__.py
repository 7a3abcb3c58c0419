"""The task's mathematics, pure: one plant, one task, one set of cells for simulator, learner and experiments."""
