"""What every way of running a system has in common: its recording's name, its progress, its summary."""

from __future__ import annotations

import dataclasses
import re
import time
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from cli.progress import Progress
from docking.score import Trial, outcomes
from report.frames import Scoreboard


@dataclass
class Summary:
    """What `berth run --json` prints."""

    robot_s: float = 0.0
    wall_s: float = 0.0
    messages: int = 0
    lost: int = 0
    refused: int = 0
    trials: int = 0
    docked: int = 0
    picked: int = 0
    collisions: int = 0
    recording: str = ""
    report: str = ""
    exit_reason: str = ""

    def table(self) -> dict[str, Any]:
        """As one JSON object."""
        return dataclasses.asdict(self)


class Watch:
    """Follows a running session: scores its trials, shows progress, makes the summary."""

    def __init__(self, progress: Progress) -> None:
        self.board = Scoreboard(keeps_paths=False)
        self.messages = 0
        self.lost = 0
        self.refused = 0
        self.refusal = ""
        """How many messages were refused, and why."""
        self.restarted = ""
        """How often a component was started again, and why."""
        self.note = ""
        """What is wrong at the moment, in words."""
        self.drives = ""
        """Who has the robot, or why it rests, and how fast it goes; empty where nobody looks."""
        self.usage = ""
        """What a person must know to take part."""
        self.over = ""
        """Why the session shall end now; empty as long as it shall not."""
        self._progress = progress
        self._began_s = time.monotonic()

    def take(self, message: Any, capture_ns: int) -> None:
        """A `Trial` or a `Truth` from the bus."""
        self.board.take(message, capture_ns)

    def show(self) -> None:
        """Refresh the progress if it is time to."""
        more = {
            "drives": self.drives,
            "keys": self.usage,
            "refused": self.refusal,
            "restarted": self.restarted,
            "note": self.note,
        }
        self._progress.update(self.board, time.monotonic() - self._began_s, self.messages, self.lost, more)

    def summary(self, reason: str, recording: Path | None) -> Summary:
        """The session's numbers. Trials are all; docked and picked are those of the evaluation."""
        trials = self.board.scorer.trials
        counts = dict(outcomes(evaluated(trials)))
        return Summary(
            robot_s=round(self.board.robot_s, 3),
            wall_s=round(time.monotonic() - self._began_s, 3),
            messages=self.messages,
            lost=self.lost,
            refused=self.refused,
            trials=len(trials),
            docked=counts["docked"],
            picked=counts["picked"],
            collisions=self.board.scorer.collisions,
            recording=str(recording or ""),
            exit_reason=reason,
        )


def evaluated(trials: Sequence[Trial]) -> list[Trial]:
    """Trials of the evaluation."""
    return [trial for trial in trials if trial.phase == "EVALUATE"]


def recording_name(launch: Path, now: datetime) -> Path:
    """recordings/<launch file>-<UTC time>.mcap."""
    stem = re.sub(r"[^A-Za-z0-9_-]", "-", launch.stem)
    return Path("recordings") / f"{stem}-{now:%Y%m%d-%H%M%S}.mcap"


def now() -> datetime:
    """Wall-clock time."""
    return datetime.now(UTC)
