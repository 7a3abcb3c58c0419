"""Two machines and a bad network between them: commands beside pictures, and a robot driven through everything.

The commands' ages are there and back, by one clock; the pictures are of 640 x 480 px, 15 a second: 5 Mbit/s
for a link of 2. What the air loses is lost packet by packet (`benchmarks.wire`), so TCP repeats it as it would.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from benchmarks.account import account
from benchmarks.bad_network import AHEAD_S, BAD, CUT_S, RATE_BPS, Interruption, Story, told
from benchmarks.figure import Figure
from benchmarks.machines import two_machines
from benchmarks.probe import Aged, Load, Probe
from benchmarks.wire import GOOD

_SECONDS = 40.0
"""A thousand commands each."""
_MOST_RATIO = 2.0
_STOP_S = 0.3
_TICK_S = 0.05
"""Base looks at its clock this often at least."""


def figures() -> list[Figure]:
    """Commands beside pictures, then the robot."""
    with tempfile.TemporaryDirectory() as name:
        found = commands(Path(name))
    with tempfile.TemporaryDirectory() as name:
        return found + robot(Path(name))


def commands(directory: Path) -> list[Figure]:
    """Ages on a good and on a bad link, with and without pictures, at one rate."""
    found = []
    with two_machines(directory, radio=True) as cable:
        cable.narrow(RATE_BPS)
        probe = Probe(cable)
        for words, quality in (("2 Mbit/s", GOOD), ("2 Mbit/s, 5 % lost, 50 ms jitter", BAD)):
            cable.become(quality)
            alone, adapted, full = (probe.aged(Load(_SECONDS, what)) for what in ("none", "preview", "all"))
            found += _ages(words, alone, adapted, full, asked=quality is BAD)
    return found


def _ages(words: str, alone: Aged, adapted: Aged, full: Aged, *, asked: bool) -> list[Figure]:
    """What is asked is asked of the pictures as the system sends them, and noted of pictures as they are."""
    ratio, ratio_full = (each.percentile_ms(99) / alone.percentile_ms(99) for each in (adapted, full))
    spread = ", ".join(f"p{p} {alone.percentile_ms(p):.0f}" for p in (50, 90))
    return [
        Figure(f"{words}: command p99, nothing else", alone.percentile_ms(99), "ms", note=spread),
        Figure(f"{words}: with previews", ratio, "times", at_most=_MOST_RATIO if asked else None, note=_noted(adapted)),
        Figure(f"{words}: with pictures as they are", ratio_full, "times", note=_noted(full)),
    ]


def _noted(aged: Aged) -> str:
    return (
        f"p99 {aged.percentile_ms(99):.0f} ms, {len(aged.ages_ms)} of {aged.sent}; {aged.pictures / _SECONDS:.1f} "
        f"pictures/s of {aged.picture_bytes / 1e3:.0f} kB, {aged.picture_ms:.0f} ms old"
    )


def robot(directory: Path) -> list[Figure]:
    """A robot driven from a laptop; all is read from the recordings."""
    with two_machines(directory, radio=True) as cable:
        story = told(cable, directory)
    killed = _interrupted(story, f"laptop (clocks {AHEAD_S:g} s ahead) killed and started again", story.killed)
    cut = _interrupted(story, f"5 % lost, 50 ms jitter, cut for {CUT_S:g} s", story.cut)
    said = account(story.robot, story.laptop)
    return [
        *killed,
        *cut,
        Figure("messages that the laptop's recording lacks", said.lacking, note=f"{said.sent} are in the robot's"),
        Figure("not as its gap records say, message by message", said.wrong, "keys", at_most=0),
    ]


def _interrupted(story: Story, words: str, interruption: Interruption) -> list[Figure]:
    late = story.old_commands(interruption)
    moved = story.moves_by_old_commands(interruption)
    return [
        Figure(f"{words}: stop", 1e3 * story.stop_s(interruption), "ms", at_most=1e3 * (_STOP_S + _TICK_S)),
        Figure(f"{words}: motion by old commands", moved, at_most=0, note=f"{late} old commands came"),
        Figure(f"{words}: drives again after", story.back_s(interruption), "s", note="nobody on the robot restarted"),
    ]
