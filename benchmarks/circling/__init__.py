"""A part for measurements: drives the robot in a circle from wherever it runs, by the newest frame it has heard of."""
