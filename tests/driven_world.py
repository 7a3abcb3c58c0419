"""The simulator as a component with a driven world: what its robot says replaces what the simulator says."""

from __future__ import annotations

import numpy as np

from components.simulator.beginning import first_start
from components.simulator.component import ODOMETRY_STREAM, Simulator


class DrivenWorld(Simulator):
    """Base class. `World` makes the world; `born` sees it; `told` says what goes out on which port."""

    def _begin(self, time_ns):
        world = self.World(self._params, first_start(self._params, self._seed), time_ns)
        scales = np.random.default_rng([self._seed, 0, ODOMETRY_STREAM]).normal(1.0, self._params.odometry_scale, 2)
        world.odometry_scale = (float(scales[0]), float(scales[1]))
        self._world = world
        self.born(world, time_ns)
        return self._frame(world)

    def _frame(self, world):
        outputs = super()._frame(world)
        told = self.told(world, {output.port: output.message for output in outputs})
        return tuple(output._replace(message=told.get(output.port, output.message)) for output in outputs)
