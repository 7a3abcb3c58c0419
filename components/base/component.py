"""The robot base as a fold: commands in, one command out for each frame, and a stop whenever there is a reason."""

from __future__ import annotations

import math
from typing import Any, cast

from components.base import ports
from components.base.arbiter import NOBODY, Arbiter, Wish
from components.base.backing import Reading
from components.base.drive import EARLY_NS, GONE, STOPPED, Drive
from components.base.motion import NS, STILL, Motion, is_sane
from components.base.polarity import beams_read, odometry_read, wired
from runtime import contract
from runtime.contract import Event, Output
from schemas import drive_pb2
from schemas.drive_pb2 import Applied, BaseCommand, BaseState, GripperAction

COMMANDERS = ("teleop", "grasper", "pilot")
"""Highest priority first."""
_GRIPPER = frozenset(GripperAction.values())
_NUMBERS = ("odometry_x_m", "odometry_y_m", "odometry_heading_rad", "v_mps", "omega_radps")


class Base:
    """Arbitrates, limits, stops.

    A frame is answered at once when the answer can not change any more; with the real clock also on the tick after
    `join_s`. The age of a command is that of the frame it answers, on this host's clock. In lockstep no time passes
    without an answer, so ticks mean nothing; the world's own watchdog acts when it steps without a command.
    """

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del seed  # nothing is random here
        self._params = params
        # With the real clock a word stands until the tick that ends it.
        early_ns = 0 if params.clock == "lockstep" else EARLY_NS
        max_age_ns = round(params.max_age_s * NS) - early_ns
        self._arbiter = Arbiter(COMMANDERS, params.commanders, max_age_ns, params.begins_with)
        self._drive = Drive(params)
        self._state = BaseState()
        self._state_ns = -1
        self.refused = 0
        """Commands and readings that were not finite or absurd."""

    def handle(self, event: Event) -> tuple[Output, ...]:
        """See the class."""
        if event.port in COMMANDERS:
            return self._command(event)
        if event.port == "device":
            return self._device(event.message, event.capture_ns)
        if event.port == contract.TICK:
            return self._tick(event.time_ns)
        if event.port == contract.GONE:
            return self._gone(event.message, event.time_ns)
        return self._halt(STOPPED, event.time_ns) if event.port == contract.STOP else ()

    def _command(self, event: Event) -> tuple[Output, ...]:
        if event.capture_ns > event.time_ns:
            self.refused += 1
            return ()
        wish = Wish(bool(event.message.engaged), self._motion(event.message), event.capture_ns)
        self._arbiter.hear(event.port, wish, event.time_ns)
        if event.port == "teleop" and event.capture_ns >= self._drive.dead_man_ns:
            self._drive.dead_man_ns = event.capture_ns if event.message.dead_man else -1
        if self._arbiter.is_awaited(event.port):
            return self._decide(event.capture_ns, event.time_ns, wait=True)
        return self._free(event.port, event.time_ns)

    def _motion(self, command: Any) -> Motion:
        if not is_sane(command.v_mps, command.omega_radps):
            self.refused += 1
            return STILL
        gripper = command.gripper if command.gripper in _GRIPPER else drive_pb2.GRIPPER_KEEP
        return Motion(command.v_mps, command.omega_radps, gripper)

    def _decide(self, capture_ns: int, time_ns: int, *, wait: bool) -> tuple[Output, ...]:
        decision = self._arbiter.decide(capture_ns, time_ns, wait=wait)
        return () if decision is None else self._said(*self._drive.apply(decision, time_ns), capture_ns)

    def _free(self, commander: str, time_ns: int) -> tuple[Output, ...]:
        """A person's command, and the end of it, counts at once; in lockstep it waits for the next frame."""
        if self._params.clock == "lockstep":
            return ()
        decision = self._arbiter.free(commander, time_ns)
        if decision is not None:
            return self._said(*self._drive.apply(decision, time_ns), decision.capture_ns)
        return self._halt(NOBODY, time_ns) if self._drive.commander == commander else ()

    def _tick(self, time_ns: int) -> tuple[Output, ...]:
        if self._params.clock == "lockstep":
            return ()
        frame = self._arbiter.overdue(time_ns, round(self._params.join_s * NS))
        if frame is not None:
            return self._decide(frame, time_ns, wait=False)
        reason = self._drive.check(time_ns)
        return () if reason is None else self._halt(reason, time_ns)

    def _gone(self, name: str, time_ns: int) -> tuple[Output, ...]:
        if name not in self._params.stop_when_gone:
            return ()
        self._drive.gone_ns = time_ns
        self._arbiter.close(time_ns)
        return self._halt(GONE, time_ns)

    def _halt(self, reason: str, time_ns: int) -> tuple[Output, ...]:
        return self._said(*self._drive.stop(reason), time_ns)

    def _device(self, reading: BaseState, capture_ns: int) -> tuple[Output, ...]:
        if capture_ns <= self._state_ns:
            return ()
        self._state_ns = capture_ns
        state = BaseState()
        state.CopyFrom(reading)
        numbers = odometry_read(tuple(getattr(reading, name) for name in _NUMBERS), self._params)
        if not all(map(math.isfinite, numbers)):
            self.refused += 1
            numbers = tuple(getattr(self._state, name) for name in _NUMBERS)
        for name, number in zip(_NUMBERS, numbers, strict=True):
            setattr(state, name, number)
        state.inner_beam, state.outer_beam = beams_read(reading.inner_beam, reading.outer_beam, self._params)
        self._state = state
        self._drive.bumper, self._drive.guard = state.bumper, state.guard
        self._drive.backing.see(_reading(state, capture_ns))
        return (Output("state", state),)

    def _said(self, commander: str, motion: Motion, capture_ns: int) -> tuple[Output, ...]:
        """The command to the device and what everyone may know of it."""
        v, omega = wired(motion, self._params)
        action = cast("GripperAction", motion.gripper)
        command = BaseCommand(v_mps=v, omega_radps=omega, gripper=action)
        command.lift_reversed, command.fingers_reversed = self._params.lift_reversed, self._params.fingers_reversed
        applied = Applied(v_mps=motion.v_mps, omega_radps=motion.omega_radps, commander=commander, gripper=action)
        return Output("actuate", command, capture_ns), Output("applied", applied, capture_ns)


def _reading(state: BaseState, capture_ns: int) -> Reading:
    """What backing up needs to know."""
    range_m = state.rear_range_m if state.HasField("rear_range_m") else None
    pose = (state.odometry_x_m, state.odometry_y_m, state.odometry_heading_rad)
    return Reading(capture_ns, *pose, range_m, state.rear_bumper)
