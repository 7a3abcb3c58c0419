"""The world as a component: commands in, frames out. In lockstep it waits for its commands; else it follows ticks."""

from __future__ import annotations

import numpy as np

from components.simulator import ports
from components.simulator.base import Twist
from components.simulator.beginning import first_start
from components.simulator.commands import STALLS, Gate
from components.simulator.head import Target
from components.simulator.messages import Placing, Reporter
from components.simulator.world import SUBSTEP_NS, World
from docking.starts import start
from runtime.contract import STALL, STOP, TICK, ComponentError, Event, Output

CATCH_UP_NS = 2_000_000_000
"""In real time, a tick later than this (a suspended machine) is not caught up with: the world stood still."""
ODOMETRY_STREAM = 2
"""Tag of the generator of the run's odometry errors."""


class Simulator:
    """Base, head, gripper and camera of a robot before a table."""

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        self._params = params
        self._seed = seed
        self._reporter = Reporter(params, seed)
        self._gate = Gate(params.frame_ns)
        self._world: World | None = None
        self._frames = 0
        self._place: tuple[int, int, int] | None = None
        self._placed_for: tuple[int, int] | None = None
        self._placing = Placing(0, placed=False)

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Frame 0 on the first tick; then a frame whenever the clock says so."""
        if event.port == STOP:
            return ()
        if self._world is None:
            return self._begin(event.time_ns) if event.port == TICK else ()
        if self._params.clock == "real":
            return self._real(self._world, event)
        return self._lockstep(self._world, event)

    def _begin(self, time_ns: int) -> tuple[Output, ...]:
        self._world = World(self._params, first_start(self._params, self._seed), time_ns)
        scales = np.random.default_rng([self._seed, 0, ODOMETRY_STREAM]).normal(1.0, self._params.odometry_scale, 2)
        self._world.odometry_scale = (float(scales[0]), float(scales[1]))
        return self._frame(self._world)

    def _lockstep(self, world: World, event: Event) -> tuple[Output, ...]:
        if event.port == TICK:
            return ()
        if event.port == STALL:
            return self._stalled(world)
        self._take(world, event, world.time_ns)
        if self._gate.missing:
            return ()
        self._gate.stalls = 0
        return self._next_frame(world)

    def _stalled(self, world: World) -> tuple[Output, ...]:
        self._gate.stalls += 1
        if self._gate.stalls >= STALLS:
            waited = ", ".join(self._gate.missing)
            raise ComponentError(f"simulator: {STALLS} stalls in a row; the newest frame was not answered on: {waited}")
        return self._next_frame(world)

    def _real(self, world: World, event: Event) -> tuple[Output, ...]:
        if event.port != TICK:
            if event.port != STALL:
                self._take(world, event, event.time_ns)
            return ()
        if event.time_ns - world.time_ns > CATCH_UP_NS:
            world.time_ns += (event.time_ns - world.time_ns) // self._params.frame_ns * self._params.frame_ns
        return self._catch_up(world, event.time_ns)

    def _catch_up(self, world: World, now_ns: int) -> tuple[Output, ...]:
        """Step up to now; of several frames that are due, only the newest is taken."""
        due = (now_ns - self._gate.newest_ns) // self._params.frame_ns
        capture_ns = self._gate.newest_ns + due * self._params.frame_ns
        outputs: tuple[Output, ...] = ()
        while world.time_ns + SUBSTEP_NS <= now_ns:
            world.step()
            if world.time_ns == capture_ns:
                outputs = self._frame(world)
        return outputs

    def _take(self, world: World, event: Event, arrival_ns: int) -> None:
        """Obey a command; nonsense in it moves nothing."""
        message = event.message
        if event.port == "drive":
            wiring = self._params.wiring
            twist = Twist(wiring.forward * message.v_mps, wiring.turn * message.omega_radps)
            world.base.command(twist, arrival_ns)
            reversals = (
                message.lift_reversed != wiring.lift_reversed,
                message.fingers_reversed != wiring.fingers_reversed,
            )
            world.gripper.command(message.gripper, *reversals)
        elif event.port == "aim":
            pan, tilt = self._params.wiring.pan, self._params.wiring.tilt
            angles = (pan * message.pan_rad, tilt * message.tilt_rad)
            rates = (pan * message.pan_rate_radps, tilt * message.tilt_rate_radps)
            world.head.follow(Target(*angles, *rates, event.capture_ns))
        elif event.port == "trial" and message.place:
            self._place = (message.phase, message.number, message.start)
        self._gate.answer(event.port, event.capture_ns)

    def _next_frame(self, world: World) -> tuple[Output, ...]:
        for _ in range(self._params.frame_ns // SUBSTEP_NS):
            world.step()
        return self._frame(world)

    def _frame(self, world: World) -> tuple[Output, ...]:
        self._carry(world)
        outputs = self._reporter.frame(world, self._frames, self._placing)
        self._frames += 1
        self._gate.open_frame(world.time_ns)
        world.collided = world.base.bumper or world.base.rear_bumper
        return outputs

    def _carry(self, world: World) -> None:
        """Place the robot if a trial asked for it, once per trial, just before the frame is taken."""
        self._placing = Placing(self._placing.start, placed=False)
        if self._place is None:
            return
        phase, number, start_number = self._place
        self._place = None
        if self._placed_for == (phase, number):
            return
        self._placed_for = (phase, number)
        world.place(start(self._params.starts, self._params.starts_seed, start_number, self._params.task))
        self._placing = Placing(start_number, placed=True)
