"""Progress of a command that takes more than a moment: a bar in a terminal, a line now and then elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

AFTER_S = 2.0
"""What is done sooner says nothing, where there is no terminal."""
LINE_S = 10.0
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
        yield _Lines(what).told


def _bar() -> Progress:
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    return Progress(*columns, console=Console(stderr=True), transient=True)


class _Lines:
    """A line now and then."""

    def __init__(self, what: str) -> None:
        self._what = what
        self._next_s = time.monotonic() + AFTER_S

    def told(self, share: float) -> None:
        """Say it if it is time to."""
        if time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + LINE_S
            sys.stderr.write(f"{self._what}: {100 * share:.0f} %\n")
