"""Messages to and from the pilot's session: one drive and one trial for each percept."""

from __future__ import annotations

import base64
import json
import math
from dataclasses import replace
from typing import Any

from components.pilot import ports
from components.pilot.choice import table_of as table_of_trial
from components.pilot.leash import leashed
from components.pilot.messages import table_of
from components.pilot.progress import Failure, Heard, Mode, Outcome, Phase, Progress, Wish
from components.pilot.rules import Rules
from components.pilot.saved import Saved, from_text, to_text
from components.pilot.session import step
from components.pilot.sight import sight_of
from components.pilot.trial import Frame
from docking.policy import PolicyTable
from runtime.contract import Event, Output
from schemas.drive_pb2 import Applied, BaseState, Drive
from schemas.grasp_pb2 import Grasp
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import SessionEnd
from schemas.trial_pb2 import Trial

_NUMBERS = ("v_mps", "omega_radps", "odometry_x_m", "odometry_y_m", "odometry_heading_rad")
_PERSON = "teleop"
"""The commander of base that is a person."""
_HEARD = {
    "stale": "late_ns",
    "rear": "hindered_ns",
    "rear-bumper": "hindered_ns",
    "reverse": "hindered_ns",
    "fence": "hindered_ns",
}
"""Base's words for why the robot was not moved -> what is remembered of it."""


class Pilot:
    """Runs trials: drives to the goal cell by the trial's controller, servoes, has the object picked up, drives back.

    A percept whose capture time was answered before is ignored. Nothing is forgotten by `save` and `load`.
    """

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        self._rules = Rules.of(params, seed)
        self._progress = Progress()
        self._heard = Heard()
        self._table = PolicyTable.from_bytes(params.policy) if params.policy else None
        self.refused = 0
        """Policy messages that were not valid."""

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Answer a percept; remember the others."""
        if event.port == "percept":
            return self._answer(event.message, event.capture_ns)
        if event.port == "base":
            self._hear_base(event.message, event.capture_ns)
        elif event.port == "grasp":
            self._hear_grasp(event.message, event.capture_ns)
        elif event.port == "applied":
            self._hear_applied(event.message, event.capture_ns)
        elif event.port == "policy":
            self._hear_policy(event.message)
        return ()

    def save(self) -> bytes:
        """Everything, as JSON."""
        table = None if self._table is None else base64.b64encode(self._table.to_bytes()).decode()
        return json.dumps(
            {"session": to_text(Saved(self._progress, self._heard)), "policy": table}, sort_keys=True
        ).encode()

    def load(self, state: bytes) -> None:
        """Go on where `save` was called.

        Raises:
            ValueError: not a valid state; the pilot stays as it was.
        """
        try:
            saved = json.loads(state)
            session = from_text(saved["session"])
            policy = saved["policy"]
            table = None if policy is None else PolicyTable.from_bytes(base64.b64decode(policy, validate=True))
        except (KeyError, TypeError, RecursionError) as error:
            raise ValueError(f"pilot state is incomplete or mistyped: {error!r}") from error
        (self._progress, self._heard), self._table = session, table

    def _answer(self, percept: Percept, capture_ns: int) -> tuple[Output, ...]:
        before = self._progress
        if capture_ns <= before.answered_ns:
            return ()
        sight = sight_of(self._rules.task, percept.visible, percept.slope, percept.pan_rad, percept.tilt_rad)
        self._progress, wish = step(self._rules, before, Frame(capture_ns, sight, self._heard, self._table))
        drive = _drive(leashed(self._rules, wish, sight, self._heard.watchdog_s))
        outputs = (Output("trial", self._trial(wish)), Output("drive", drive))  # trial has the longer way
        if self._progress.phase == Phase.FINISHED != before.phase:
            return (*outputs, Output("end", SessionEnd(reason="finished")))
        return outputs

    def _trial(self, wish: Wish) -> Trial:
        now, rules = self._progress, self._rules
        table = table_of_trial(rules, self._table, now)
        return Trial(
            phase=Phase(now.phase).name,
            mode=Mode(now.mode).name,
            number=now.number,
            outcome=Outcome(now.outcome).name,
            ended=now.ended,
            controller=wish.controller,
            action=wish.action,
            policy_version=0 if table is None else table.version,
            place=wish.place,
            start=rules.start_of(now.number) if wish.place else 0,
            goal_reached=now.goal_reached,
            began_ns=now.began_ns,
            failure=Failure(now.failure).name,
            failure_ns=max(now.failure_ns, 0),
            dock_share=now.forecast.share,
            dock_s=now.forecast.time_s,
            back_off_m=now.forecast.back_off_m,
            side=_side(rules, now),
        )

    def _hear_base(self, state: BaseState, capture_ns: int) -> None:
        heard = self._heard
        if capture_ns >= heard.base_ns:
            numbers: dict[str, Any] = {name: _finite(getattr(state, name)) for name in _NUMBERS}
            numbers["watchdog_s"] = max(0.0, _finite(state.watchdog_s))
            self._heard = replace(heard, base_ns=capture_ns, bumper=state.bumper, **numbers)

    def _hear_applied(self, applied: Applied, capture_ns: int) -> None:
        heard = self._heard
        led = applied.commander == _PERSON and applied.v_mps > 0.0
        led_ns = (capture_ns if heard.led_ns < 0 else heard.led_ns) if led else -1
        field = _HEARD.get(applied.commander)
        newest: dict[str, Any] = {} if field is None else {field: max(capture_ns, getattr(heard, field))}
        self._heard = replace(heard, led_ns=led_ns, **newest)

    def _hear_grasp(self, grasp: Grasp, capture_ns: int) -> None:
        heard = self._heard
        if capture_ns >= heard.grasp_ns:
            done = grasp.stage == Grasp.DONE
            self._heard = replace(heard, grasp_ns=capture_ns, grasp_done=done, picked=done and grasp.picked)

    def _hear_policy(self, policy: Policy) -> None:
        """Take the newest policy; one that is known when the evaluation begins is frozen."""
        frozen = self._progress.phase != Phase.TRAIN and not self._rules.params.shadow
        if frozen and self._table is not None:
            return
        try:
            self._table = table_of(policy)
        except ValueError:
            self.refused += 1


def _side(rules: Rules, progress: Progress) -> str:
    if not rules.compares or progress.phase != Phase.EVALUATE:
        return ""
    return "b" if rules.is_rivals(progress) else "a"


def _drive(wish: Wish) -> Drive:
    return Drive(engaged=wish.engaged, v_mps=wish.v_mps, omega_radps=wish.omega_radps)


def _finite(value: float) -> float:
    return value if math.isfinite(value) else 1e9
