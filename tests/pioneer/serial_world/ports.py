"""As the simulator's."""

from components.simulator.ports import INPUTS, OUTPUTS, Params

__all__ = ["INPUTS", "OUTPUTS", "Params"]
