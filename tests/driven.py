"""A simulated world whose robot is driven by another than the simulator's own base."""

from __future__ import annotations

from components.simulator.base import Twist
from components.simulator.world import World


class Driven(World):
    """A world that asks its robot, before each step, how fast the wheels shall turn."""

    def __init__(self, params, start, time_ns):
        super().__init__(params, start, time_ns)
        self.twist = lambda _time_ns: (0.0, 0.0)
        self.before_step = lambda _time_ns: None

    def step(self):
        self.before_step(self.time_ns)
        self.base.command(Twist(*self.twist(self.time_ns)), self.time_ns)
        super().step()
