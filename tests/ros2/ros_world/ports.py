"""As the simulator's, and how the robot is bridged."""

from dataclasses import dataclass

from components.simulator import params
from components.simulator.ports import INPUTS, OUTPUTS
from runtime.params import one_of


@dataclass(frozen=True)
class Params(params.Params):
    bridge: str = one_of("ros2dds", "ros2dds", "rmw_zenoh")


__all__ = ["INPUTS", "OUTPUTS", "Params"]
