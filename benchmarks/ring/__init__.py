"""The simulation's graph with trivial folds: what the bus alone costs."""
