"""The pick-up after docking: lower until the beams see the object, close, lift."""
