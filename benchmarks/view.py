"""An hour of `berth view` beside a robot in real time: what the viewer's processes keep.

What a browser keeps is the browser's: Rerun's page there has the same limit, of its own.

python -m benchmarks.view [--minutes M] [--keep DIRECTORY]
"""

from __future__ import annotations

import argparse
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Self

from benchmarks.figure import Figure
from benchmarks.soak import soak
from benchmarks.watched import command_line

MINUTES = 60.0
LIMIT_MB = 100.0
"""Of Rerun's program, small enough to be reached in ten minutes."""
_PROGRAM_MB = 50.0
"""What the program has without data, and to spare. It keeps data twice, each within the limit: to serve and to show."""
_END_S = 30.0
_PROGRAM = "program of"
_VIEWERS = {
    "view --web": ("--web", "--no-open", "--port=0", f"--memory-limit={LIMIT_MB:g}MB"),
    "view --foxglove": ("--foxglove", "--port=0"),
}


def figures(minutes: float = MINUTES, keep: str = "") -> list[Figure]:
    """The robot's processes too: nobody who looks may cost them memory or messages."""
    with Viewers() as viewers:
        return [_bounded(figure) for figure in soak("real", minutes * 60.0, keep, viewers.pids)]


def _bounded(figure: Figure) -> Figure:
    """Rerun's program is to fill what it may have, and no more: its last quarter counts, not its growth."""
    if _PROGRAM not in figure.name:
        return figure
    last_mb = float(figure.note.removesuffix(" MB").rpartition(" ")[2])
    return figure._replace(value=last_mb, unit="MB", at_most=2 * LIMIT_MB + _PROGRAM_MB)


class Viewers:
    """The command, once for each kind of viewer. Use as a context manager."""

    def __init__(self) -> None:
        """None is started before somebody asks for their processes."""
        self._started: dict[str, subprocess.Popen[bytes]] = {}

    def pids(self, realm: str) -> Mapping[str, int]:
        """Theirs, and that of Rerun's program."""
        for name, words in _VIEWERS.items():
            if name not in self._started:
                command = command_line("view", "--realm", realm, *words)
                self._started[name] = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        found = {name: process.pid for name, process in self._started.items() if process.poll() is None}
        return found | {f"{_PROGRAM} {name}": child for name, pid in found.items() for child in _children(pid)}

    def __enter__(self) -> Self:
        """Nothing runs yet."""
        return self

    def __exit__(self, *_: object) -> None:
        """End them."""
        for process in self._started.values():
            process.terminate()
            process.wait(_END_S)


def _children(pid: int) -> list[int]:
    try:
        return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii").split()]
    except (FileNotFoundError, ProcessLookupError):
        return []


def main() -> None:
    """Print the numbers."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.view", description=__doc__)
    parser.add_argument("--minutes", type=float, default=MINUTES)
    parser.add_argument("--keep", default="", help="directory for recording and samples")
    options = parser.parse_args()
    for figure in figures(options.minutes, options.keep):
        print(f"{figure.name:36} {figure.value:10.3f} {figure.unit:4} {figure.rule:8} {figure.note}")


if __name__ == "__main__":
    main()
