"""Live progress of a session: a small panel in a terminal, a line now and then elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.live import Live
from rich.table import Table

from docking.score import Trial
from report.forecast import sentence
from report.frames import Scoreboard
from schemas.trial_pb2 import Trial as TrialMessage

REFRESH_S = 0.25
LINE_S = 10.0


class Progress:
    """Shows a scoreboard; the wall clock comes in as an argument."""

    def __init__(self, title: str, *, quiet: bool) -> None:
        """Make it; nothing is shown before the first update.

        Args:
            title: name of the session.
            quiet: show nothing at all.
        """
        self._console = Console(stderr=True)
        self._title = title
        self._quiet = quiet
        self._live = (
            Live(console=self._console, auto_refresh=False, transient=False)
            if self._console.is_terminal and not quiet
            else None
        )
        self._next_s = 0.0

    def __enter__(self) -> Self:
        """Take the terminal."""
        if self._live is not None:
            self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give the terminal back."""
        if self._live is not None:
            self._live.stop()

    def update(self, board: Scoreboard, wall_s: float, messages: int, lost: int, more: Mapping[str, str]) -> None:
        """Show the state if it is time to.

        Args:
            board: trials so far.
            wall_s: wall time since the start.
            messages: messages seen on the bus.
            lost: messages lost.
            more: further rows; an empty one is left out.
        """
        if self._quiet or wall_s < self._next_s:
            return
        rows = _rows(board, wall_s, messages, lost) + [(name, words) for name, words in more.items() if words]
        if self._live is not None:
            self._next_s = wall_s + REFRESH_S
            self._live.update(_panel(self._title, rows), refresh=True)
        else:
            self._next_s = wall_s + LINE_S
            self._console.print(", ".join(f"{name}: {value}" for name, value in rows), highlight=False)


def _rows(board: Scoreboard, wall_s: float, messages: int, lost: int) -> list[tuple[str, str]]:
    state = board.trial
    phase = TrialMessage.Phase.Name(state.phase) if state is not None else "TRAIN"
    mode = TrialMessage.Mode.Name(state.mode).lower() if state is not None else "starting"
    told = sentence(state) if state is not None else ""
    return [
        ("phase", f"{phase.lower()}, {mode}"),
        ("robot minutes", f"{board.robot_s / 60:.1f}"),
        ("trials", str(len(board.scorer.trials))),
        *([("this trial", told)] if told else []),
        ("success over the last 20", _success(board.scorer.last(20, phase), phase)),
        ("policy version", str(state.policy_version if state is not None else 0)),
        ("collisions", str(board.scorer.collisions)),
        ("speed", f"{board.robot_s / max(wall_s, 1e-9):.1f} x real time"),
        ("messages", f"{messages}, lost {lost}"),
    ]


def _success(trials: list[Trial], phase: str) -> str:
    """In training a success is the goal cell; in evaluation a docking and a pick-up are shown too."""
    if not trials:
        return "-"
    reached = f"{100 * sum(t.reached for t in trials) / len(trials):.0f} % reached"
    if phase != "EVALUATE":
        return reached
    docked = 100 * sum(t.docked for t in trials) / len(trials)
    picked = 100 * sum(t.picked for t in trials) / len(trials)
    return f"{reached}, {docked:.0f} % docked, {picked:.0f} % picked"


def _panel(title: str, rows: list[tuple[str, str]]) -> Table:
    table = Table(title=title, show_header=False, title_justify="left", min_width=58)
    table.add_column(style="dim")
    table.add_column()
    for row in rows:
        table.add_row(*row)
    return table
