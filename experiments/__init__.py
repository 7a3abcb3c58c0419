"""The paper's tables and figures, the ceiling and our own comparisons, off the bus. May import anything pure."""
