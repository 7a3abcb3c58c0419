"""Prints every number we claim, with its floor: `make bench`, or `python -m benchmarks NAME...`."""

from __future__ import annotations

import argparse
import importlib
import json
import sys
import time

from rich.console import Console
from rich.table import Table

from benchmarks.figure import Figure

BENCHMARKS = {
    "render": "one camera frame: rendered, encoded, decoded, understood",
    "vision": "the table's edge with a stripe and without one: error, frames lost, cost",
    "lamps": "colours learned in one frame, under lamps of 2700 to 6500 K and a tenth to four times the light",
    "sweep": "the sweep kernel against C, and robot-seconds learned per core-second",
    "tracking": "error of the tracker and of the percept, in the loop with rendered images",
    "speed": "lockstep on the bus and in one process against real time",
    "latency": "frame to command against a bare chain of as many processes",
    "stopping": "Ctrl-C and kill -9 of each process: how fast the robot stops",
    "networks": "commands beside pictures on a bad link; a robot driven through a killed laptop, loss and a cut",
    "recorder": "what the recorder costs and loses, and what a kill -9 costs",
    "soak": "an hour in real time, eight hours in lockstep: memory of each process, messages lost, rates",
    "view": "an hour of `berth view` beside a robot in real time: memory of the viewer's processes",
    "replay": "a live session of 5 minutes, every component replayed: share of equal outputs, speed",
    "relearn": "learning again from 40 robot-minutes against reading the same channels with the mcap library",
    "report": "the report about a session of 40 robot-minutes, against reading its file",
    "fuzz_reader": "ten thousand spoiled recordings through everything that reads one",
    "fuzz_pioneer": "ten thousand spoiled byte streams through the readers of a Pioneer's line",
    "pioneer": "the learned policy through a Pioneer's serial protocol beside the direct simulation, 200 paired starts",
    "ros2": "the learned policy through ROS 2 messages of both bridges beside the direct simulation, 50 paired starts",
    "hardware": "wrong signs, units, beams and latencies: found and put right, by small motions; false alarms",
    "evaluation": "the frozen policy after 40 robot-minutes beside linear controllers, 500 paired starts",
    "minutes_live": "learned live in 5 robot-minutes, one speed to reverse: docked of 500 paired starts, forecasts",
    "goal": "a taught goal, the camera 5 cm aside and yawed 3 deg, against the axis: 500 paired starts",
}
"""Module below benchmarks/ -> what it measures. Each has `figures() -> list[Figure]`."""
_WIDTH = 160
"""Columns of a table in a file or a pipe."""


def main() -> int:
    """Run the named benchmarks, or all; exit code 1 if a number is not what it must be."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(BENCHMARKS))
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")
    options = parser.parse_args()
    for name in options.names:
        if name not in BENCHMARKS:
            parser.error(f"{name} is unknown; known are {', '.join(BENCHMARKS)}")
    stream = sys.stderr if options.json else sys.stdout
    console = Console(file=stream, width=None if stream.isatty() else _WIDTH)
    found: dict[str, list[Figure]] = {}
    for name in options.names or BENCHMARKS:
        console.print(f"[bold]{name}[/]: {BENCHMARKS[name]}")
        began_s = time.monotonic()
        found[name] = importlib.import_module(f"benchmarks.{name}").figures()
        console.print(_table(found[name]))
        console.print(f"[dim]{time.monotonic() - began_s:.0f} s[/]\n")
    if options.json:
        sys.stdout.write(json.dumps({name: [f._asdict() for f in figures] for name, figures in found.items()}) + "\n")
    return 1 if any(figure.kept is False for figures in found.values() for figure in figures) else 0


def _table(figures: list[Figure]) -> Table:
    table = Table("figure", "measured", "asked", "", "note", header_style="dim")
    for figure in figures:
        mark = {True: "[green]kept[/]", False: "[red]not kept[/]", None: ""}[figure.kept]
        table.add_row(figure.name, f"{figure.value:.4g} {figure.unit}".strip(), figure.rule, mark, figure.note)
    return table


if __name__ == "__main__":
    sys.exit(main())
