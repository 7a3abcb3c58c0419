"""The pure core of every viewer: a session's messages in, what to show out."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import partial
from typing import Any

from report.shadow import task_of
from runtime.recording import Logged
from schemas.drive_pb2 import Applied
from schemas.head_pb2 import HeadState
from schemas.image_pb2 import CompressedImage
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import SessionEnd, Status
from schemas.trial_pb2 import Trial
from schemas.truth_pb2 import Truth
from schemas.view_pb2 import View
from viewer.camera import Camera
from viewer.course import Course
from viewer.plan import Plan
from viewer.policy_map import PolicyMap
from viewer.processes import Processes
from viewer.rate import Rate
from viewer.room import Room
from viewer.shown import Lines, Number, Page, Remark, Shown, Word
from viewer.wiring import Wiring

SECOND_NS = 1_000_000_000


class Scene:
    """Folds messages of one session, live or recorded. Memory is bounded however long it is."""

    def __init__(self, launch: Mapping[str, Any], *, picture_ns: int, policy_ns: int = SECOND_NS) -> None:
        """Nothing was said yet.

        Args:
            launch: the session's resolved launch file; of any release.
            picture_ns: least time between two camera images, on the clock of `take`.
            policy_ns: as above, between two pictures of the policy.
        """
        self.task = task_of(launch)
        self.room = Room.of(launch, self.task)
        self._lockstep = launch.get("clock") == "lockstep"
        self._wiring = Wiring(launch)
        self._camera = Camera(picture_ns)
        self._plan = Plan(self.room)
        self._course = Course(self.room)
        self._map = PolicyMap(policy_ns)
        self._processes = Processes()
        self._page = Rate(SECOND_NS)
        self._commander = ""
        self._newest_ns = 0
        self.malformed = 0
        """Messages that could not be read."""

    def furniture(self) -> dict[str, Lines]:
        """What is there before the first message, and stays."""
        return self.room.furniture()

    def take(self, logged: Logged, now_ns: int) -> list[Shown]:
        """One message.

        Args:
            logged: as recorded, or as heard: `time_ns` is then the session time of its arrival.
            now_ns: of the clock by which rates are bounded: session time for a file, wall time live.
        """
        shown = self._processes.heard(logged.topic, logged.run, logged.sequence, logged.capture_ns)
        if not self._wiring.takes(logged.topic, logged.schema):
            return shown
        message = logged.decoded()
        if message is None:
            self.malformed += 1
            return shown
        self._newest_ns = max(self._newest_ns, logged.capture_ns)
        handlers: dict[type[Any], Any] = {
            CompressedImage: partial(self._camera.image, now_ns=now_ns),
            View: self._camera.view,
            HeadState: _head,
            Percept: self._percept,
            Applied: self._applied,
            Policy: partial(self._map.policy, now_ns=now_ns),
            Trial: self._course.said,
            Truth: self._truth,
            SessionEnd: _ended,
        }
        if isinstance(message, Status):
            shown += self._processes.status(message, logged.run, logged.time_ns)
        else:
            shown += handlers[type(message)](message, logged.capture_ns) + self._age(logged)
        if self._page.passes(now_ns):
            shown += self.pages()
        return [each for each in shown if not _is_nonsense(each)]

    def _percept(self, message: Percept, capture_ns: int) -> list[Shown]:
        shown = self._plan.percept(message, capture_ns) + self._course.percept(message, capture_ns)
        angles = (message.slope, message.pan_rad, message.tilt_rad)
        if not message.visible or not all(map(math.isfinite, angles)):
            return shown
        seen = self.task.seen(*angles)
        return [
            *shown,
            *self._map.here(seen.beta_rad, seen.alpha_rad, capture_ns),
            Shown("percept/beta_deg", capture_ns, Number(math.degrees(seen.beta_rad))),
            Shown("percept/alpha_deg", capture_ns, Number(math.degrees(seen.alpha_rad))),
        ]

    def _truth(self, message: Truth, capture_ns: int) -> list[Shown]:
        return self._plan.truth(message, capture_ns) + self._course.truth(message, capture_ns)

    def _applied(self, message: Applied, capture_ns: int) -> list[Shown]:
        shown = [
            Shown("drive/speed_cmps", capture_ns, Number(100.0 * message.v_mps)),
            Shown("drive/turn_degps", capture_ns, Number(math.degrees(message.omega_radps))),
        ]
        if message.commander != self._commander:
            self._commander = message.commander
            shown.append(Shown("drive/commander", capture_ns, Word(message.commander[:40])))
        return shown

    def _age(self, logged: Logged) -> list[Shown]:
        """How old a message's cause was when it was heard; in lockstep no time passes in between."""
        if self._lockstep:
            return []
        age_ms = (logged.time_ns - logged.capture_ns) / 1e6
        return [Shown(f"latency_ms/{logged.topic.replace('/', '_')}", logged.capture_ns, Number(age_ms))]

    def pages(self) -> list[Shown]:
        """The tables as they stand: the last word of a session."""
        return [
            Shown("processes", self._newest_ns, Page(self._processes.table())),
            Shown("session", self._newest_ns, Page(self.summary())),
        ]

    def summary(self) -> str:
        """The session in a few lines of Markdown."""
        course, trial = self._course, self._course.trial
        rows = {
            "robot minutes": f"{self._newest_ns / 60e9:.1f}",
            "trials": f"{course.ended}: " + ", ".join(f"{count} {name}" for name, count in course.counts.items()),
            "policy version": str(trial.policy_version if trial is not None else 0),
            "plan": f"in {self.room.unit}",
            "messages missing": str(self._processes.missing),
            "clock": "lockstep: no latency by definition" if self._lockstep else "real",
        }
        return "| | |\n|---|---|\n" + "".join(f"| {name} | {value} |\n" for name, value in rows.items())


def _head(message: HeadState, capture_ns: int) -> list[Shown]:
    return [
        Shown("head/pan_deg", capture_ns, Number(math.degrees(message.pan_rad))),
        Shown("head/tilt_deg", capture_ns, Number(math.degrees(message.tilt_rad))),
    ]


def _ended(message: SessionEnd, capture_ns: int) -> list[Shown]:
    return [Shown("log/processes", capture_ns, Remark(f"the session ends: {message.reason[:200]}"))]


def _is_nonsense(shown: Shown) -> bool:
    return isinstance(shown.what, Number) and not math.isfinite(shown.what.value)


def launch_of(text: str) -> dict[str, Any]:
    """A running system's resolved launch file."""
    table = json.loads(text)
    return table if isinstance(table, dict) else {}
