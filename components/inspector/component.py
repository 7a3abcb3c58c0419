"""Stands where tracker and pilot stand in a session, moves a little, and says what it found."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import cast

import numpy as np

from components.inspector import gripper_axes, head_axes, ports, tuning, wheels
from components.inspector.judgement import Judgement
from components.inspector.latency import Records
from components.inspector.run import Robot, Run, Wish
from components.inspector.sample import Sample
from components.inspector.servo import Track
from runtime.contract import Event, Output
from schemas.drive_pb2 import BaseState, Drive, GripperAction
from schemas.head_pb2 import HeadCommand, HeadState
from schemas.inspection_pb2 import Finding
from schemas.session_pb2 import SessionEnd
from schemas.trial_pb2 import Trial
from schemas.view_pb2 import View

FINISHED = "finished"
"""Reason of an end after the whole script."""
_MOST_ROWS = 10_000
"""Readings kept."""


class Inspector:
    """Answers every view once; commands are open-loop, so a wrong sign can not run away.

    The newest readings of head and base go with a view. Where exact times matter, every reading is kept with its own.
    """

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del seed  # nothing is random here
        self._params = params
        self._run = Run(params)
        self._head: HeadState | None = None
        self._base: BaseState | None = None
        self._stopped_by = ""
        self._answered_ns = -1
        self._waited = 0
        self._said = False
        self._told: list[tuple[float, float, float]] = []
        self._read: list[tuple[float, float, float]] = []
        self._seen: list[tuple[float, float, float]] = []

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Answer a view; remember the others."""
        if event.port == "view":
            return self._answer(event)
        if event.port == "head":
            self._head = event.message
            self._keep(self._read, event.capture_ns, event.message.pan_rad, event.message.tilt_rad)
        elif event.port == "base":
            self._base = event.message
        elif event.port == "applied":
            obeys = event.message.commander == "pilot"
            self._stopped_by = "" if obeys else event.message.commander or "nobody"
        return ()

    def _answer(self, event: Event) -> tuple[Output, ...]:
        if event.capture_ns <= self._answered_ns:
            return ()
        self._answered_ns = event.capture_ns
        wish = self._step(event.message, event.capture_ns)
        self._keep(self._told, max(event.time_ns, event.capture_ns), wish.pan_rad, wish.tilt_rad)
        outputs = (Output("trial", Trial()), Output("drive", _drive(wish)), Output("aim", _aim(wish)))
        if self._run.done and not self._said:
            self._said = True
            return (*outputs, *self._findings(), Output("end", SessionEnd(reason=self._run.reason or FINISHED)))
        return outputs

    def _step(self, view: View, capture_ns: int) -> Wish:
        if not self._ready():
            self._waited += 1
            if self._waited * self._params.frame_s <= self._params.wait_s:
                return Wish()
        if self._head is None or self._base is None:
            self._run.end(f"{'head' if self._head is None else 'base'} says nothing")
        if view.object_visible:
            self._keep(self._seen, capture_ns, view.object_u_px, view.object_v_px)
        base, head = self._base or BaseState(), self._head or HeadState()
        reason = self._stopped_by if not base.guard else "guard"
        return self._run.step(_sample(view, head, base, capture_ns), Robot(base.bumper, reason))

    def _ready(self) -> bool:
        """Head and base have told of themselves, and are connected; once they have, what follows is no beginning."""
        if self._run.samples:
            return True
        head, base = self._head, self._base
        if head is None or base is None or base.guard:
            return False
        return math.isfinite(head.pan_rad) and math.isfinite(head.tilt_rad)

    def _keep(self, rows: list[tuple[float, float, float]], time_ns: int, first: float, second: float) -> None:
        if self._params.stage == "head" and len(rows) < _MOST_ROWS and math.isfinite(first) and math.isfinite(second):
            rows.append((time_ns * 1e-9, first, second))

    def _findings(self) -> tuple[Output, ...]:
        if self._run.reason:
            return ()
        return tuple(Output("finding", finding(judgement)) for judgement in self._judgements())

    def _judgements(self) -> Sequence[Judgement]:
        samples, params = self._run.samples, self._params
        if params.stage == "fingertips":
            return gripper_axes.judge(samples, swapped_in_force=params.beams_swapped)
        if params.stage == "head":
            return tuning.judge(self._records(), params)
        found, focal_px = head_axes.judge(samples, params)
        return [*found, *wheels.judge(samples, params, focal_px)]

    def _records(self) -> Records:
        told, read, seen = (np.array(rows) for rows in (self._told, self._read, self._seen))
        return Records(
            Track(told[:, 0], told[:, 1]),
            Track(told[:, 0], told[:, 2]),
            read[:, 0],
            read[:, 1:],
            seen[:, 0],
            seen[:, 1:],
        )


def finding(judgement: Judgement) -> Finding:
    """As a message."""
    fields = judgement._asdict()
    fields["verdict"] = cast("Finding.Verdict", int(judgement.verdict))
    fields["change"] = cast("Finding.Change", int(judgement.change))
    return Finding(**fields)


def _sample(view: View, head: HeadState, base: BaseState, capture_ns: int) -> Sample:
    return Sample(
        capture_ns,
        "",
        view.object_visible,
        view.object_u_px,
        view.object_v_px,
        view.edge_v_px if view.edge_visible else math.nan,
        head.pan_rad,
        head.tilt_rad,
        base.odometry_x_m,
        base.odometry_y_m,
        base.odometry_heading_rad,
        base.inner_beam,
        base.outer_beam,
        base.lift_up,
        base.lift_down,
        base.fingers_closed,
    )


def _drive(wish: Wish) -> Drive:
    action = cast("GripperAction", int(wish.gripper))
    return Drive(engaged=True, v_mps=wish.v_mps, omega_radps=wish.omega_radps, gripper=action)


def _aim(wish: Wish) -> HeadCommand:
    return HeadCommand(pan_rad=wish.pan_rad, tilt_rad=wish.tilt_rad)
