"""Progress of a command that takes more than a moment: a bar in a terminal, a line now and then elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Timer
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

QUIET = Annotated[bool, typer.Option("--quiet", help="No progress.")]
LINE_S = 10.0
"""From one line to the next where there is no terminal. What is done sooner says nothing there."""
Told = Callable[[float], None]


@contextmanager
def doing(what: str, *, quiet: bool) -> Iterator[Told]:
    """Show on standard error that something is being done.

    Args:
        what: in words.
        quiet: show nothing.

    Yields:
        A function to call with the share that is done, 0 to 1; who never calls it is shown as busy.
    """
    if quiet:
        yield lambda _share: None
    elif sys.stderr.isatty():
        with _bar() as bar:
            task = bar.add_task(what, total=None)
            yield lambda share: bar.update(task, total=1.0, completed=share)
    else:
        lines = _Lines(what)
        try:
            yield lines.told
        finally:
            lines.end()


def _bar() -> Progress:
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    return Progress(*columns, console=Console(stderr=True), transient=True)


class _Lines:
    """Says after a moment what is going on, and how far it is now and then."""

    def __init__(self, what: str) -> None:
        self._what = what
        self._next_s = time.monotonic() + 2 * LINE_S
        self._first = Timer(LINE_S, self._say, [f"{what} ..."])
        self._first.daemon = True
        self._first.start()

    def told(self, share: float) -> None:
        """Say it if it is time to."""
        if time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + LINE_S
            self._say(f"{self._what}: {100 * share:.0f} %")

    def end(self) -> None:
        """Nothing more is said."""
        self._first.cancel()

    def _say(self, line: str) -> None:
        sys.stderr.write(line + "\n")
