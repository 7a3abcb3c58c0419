"""One component's process, seen from its supervisor."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import IO

from runtime.assignment import Assignment
from runtime.device import kind_of

ENVIRONMENT = {
    # Results must not depend on the number of cores.
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "NUMBA_NUM_THREADS": "1",
    "PYTHONUNBUFFERED": "1",
}
_LINE_BYTES = 8192


class Child:
    """A spawned process in a group of its own, so that Ctrl-C reaches the supervisor alone.

    One that reads the terminal stays in the supervisor's group: the system lets no other read it.
    """

    def __init__(self, assignment: Assignment, log: Path) -> None:
        """Start it; its output is appended to its log."""
        kind = kind_of(assignment.system.component(assignment.name))
        self.name = assignment.name
        self.log = log
        with log.open("ab") as stream:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "runtime.process"],
                stdin=subprocess.PIPE,
                stdout=stream,
                stderr=subprocess.STDOUT,
                env={**os.environ, **ENVIRONMENT},
                process_group=None if kind is not None and kind.terminal else 0,
            )
        self._input: IO[bytes] | None = self._process.stdin
        self._tell(assignment.to_json().encode() + b"\n")

    def _tell(self, line: bytes) -> None:
        try:
            if self._input is not None:
                self._input.write(line)
                self._input.flush()
        except BrokenPipeError:
            pass  # it has died already; `exit_code` tells

    @property
    def pid(self) -> int:
        """Of the process."""
        return self._process.pid

    @property
    def exit_code(self) -> int | None:
        """None while it runs; minus the signal's number if it was killed."""
        return self._process.poll()

    def send(self, number: signal.Signals) -> None:
        """Signal it, if it still runs."""
        if self.exit_code is None:
            self._process.send_signal(number)

    def release(self) -> None:
        """Close what is left of an ended process."""
        if self._input is not None:
            with contextlib.suppress(BrokenPipeError):
                self._input.close()
            self._input = None

    def describe_end(self) -> str:
        """How it ended, in one line: the signal, or the last line of its log."""
        code = self.exit_code
        if code is None:
            return f"{self.name} runs"
        if code < 0:
            return f"{self.name} was killed by {signal.Signals(-code).name}"
        said = last_line(self.log)
        return f"{self.name} ended with exit code {code}" + (f": {said}" if said else "")


def last_line(log: Path) -> str:
    """The last line of a log that is not empty: of a traceback, its error."""
    with log.open("rb") as stream:
        stream.seek(max(0, stream.seek(0, os.SEEK_END) - _LINE_BYTES))
        lines = [line.strip() for line in stream.read().decode(errors="replace").splitlines()]
    return next((line for line in reversed(lines) if line), "")
