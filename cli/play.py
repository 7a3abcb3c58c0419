"""`berth play FILE`: put a log on the bus."""

from __future__ import annotations

import json
import re
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.in_process import on_signal
from cli.keys import GONE, pressed
from cli.picking import EXCLUDE, INCLUDE, TOPICS, selection
from runtime.answers import Answers, stands
from runtime.clock import PacedClock
from runtime.contract import ComponentError
from runtime.joining import description
from runtime.params import ConfigurationError
from runtime.player import Player
from runtime.playhead import Playhead
from runtime.playlist import Playlist
from runtime.recording import Recording
from runtime.runfile import Run, find
from runtime.stage import joined_stage, own_stage
from runtime.system import ComponentSpec, System, ports_of

FILE = Annotated[Path, typer.Argument(help="Session to play; a torn one is played up to its tear.")]
RATE = Annotated[
    float, typer.Option("-r", "--rate", help="Log seconds per second; 0 = as fast as possible.", min=0, max=1e6)
]
FAST = Annotated[bool, typer.Option("--fast", help="As fast as the listeners take it; nothing is lost. Same as -r 0.")]
LOOP = Annotated[bool, typer.Option("-l", "--loop", help="Begin anew at the end, until Ctrl-C.")]
START = Annotated[float, typer.Option("--start-offset", help="Seconds of the log to leave out.", min=0, max=1e7)]
DURATION = Annotated[float | None, typer.Option(help="Seconds of the log to play.", min=0, max=1e7)]
REMAP = Annotated[list[str] | None, typer.Option(help="OLD:=NEW: play a topic on another key. May be repeated.")]
PAUSED = Annotated[bool, typer.Option("-p", "--paused", help="Start paused: space goes on.")]
REALM = Annotated[str, typer.Option(help="Realm to play in; default: replay/ and the log's own.")]
REPLACE = Annotated[str, typer.Option(help="Stand in for these components of a running system, with commas between.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output, at the end.")]
_KEYS = {
    " ": "pause", ".": "step", "\x1b[C": "step", "q": "quit", "\x1b[D": "back", ",": "back", "\x1b[A": "forward"
}  # fmt: skip
_REALM = re.compile(r"[A-Za-z0-9_-]+(/[A-Za-z0-9_-]+)*")
_HELP = "space pauses and goes on, . or -> plays one message, , or <- goes back 5 s, up goes on 5 s, q ends it"


def play(
    file: FILE,
    rate: RATE = 1.0,
    fast: FAST = False,
    loop: LOOP = False,
    start_offset: START = 0.0,
    duration: DURATION = None,
    topics: TOPICS = "",
    include: INCLUDE = "",
    exclude: EXCLUDE = "",
    remap: REMAP = None,
    paused: PAUSED = False,
    realm: REALM = "",
    replace: REPLACE = "",
    as_json: JSON = False,
) -> None:
    """Put a log on the bus, in a realm of its own. Example: berth play recordings/a.mcap -r 2 -x image."""
    replaced = tuple(name for name in replace.split(",") if name)
    if paused and not sys.stdin.isatty():
        sys.stderr.write("paused, and standard input is no terminal: it will not go on, only a signal ends it\n")
    run = find(realm) if replaced else None
    head = Playhead(0.0 if fast else rate, paused=paused)
    playlist = Playlist(
        Recording(file),
        selection(topics, include, exclude),
        _remap(remap or []),
        start_s=start_offset,
        duration_s=duration,
        owners=replaced,
        known=None if run is None else _listened_to(run, loop=loop),
        by_frame=run is not None and description(run).system.clock == "lockstep",
    )
    opened = (
        _own(playlist, head, realm, loop=loop) if run is None else _joined(playlist, head, run, replaced, loop=loop)
    )
    table, failed = _played(opened)
    table["log_s"] = round((head.time_ns - playlist.start_ns) / 1e9, 3)
    sys.stdout.write(json.dumps(table) + "\n" if as_json else "".join(f"{k:12} {v}\n" for k, v in table.items()))
    raise typer.Exit(1 if failed else 0)


def _played(opened: AbstractContextManager[Player]) -> tuple[dict[str, object], bool]:
    """Play to the end; returns what is to be told about it, and whether it failed."""
    began_s = time.monotonic()
    failed = False
    with opened as player:
        try:
            reason = _run(player)
        except ComponentError as error:
            failed, reason = True, str(error)
    wall_s = round(time.monotonic() - began_s, 3)
    return {"played": player.played, "epochs": player.epochs, "wall_s": wall_s, "exit_reason": reason}, failed


def _run(player: Player) -> str:
    def obey(key: str) -> None:
        if key == GONE:
            player.stop("the terminal has gone")
        elif key in _KEYS:
            player.command(_KEYS[key])

    with on_signal(lambda: player.stop("interrupted")), pressed(obey) as terminal:
        if terminal:
            sys.stderr.write(_HELP + "\n")
        return player.run()


def _remap(pairs: list[str]) -> dict[str, str]:
    table = {}
    for pair in pairs:
        old, sign, new = pair.partition(":=")
        if not sign or new.count("/") != 1 or not all(part.isidentifier() for part in new.split("/")):
            raise ConfigurationError(f"--remap must be OLD:=COMPONENT/PORT; got {pair!r}")
        table[old] = new
    return table


@contextmanager
def _own(playlist: Playlist, head: Playhead, realm: str, *, loop: bool) -> Iterator[Player]:
    """A player in a realm of its own."""
    realm = realm or f"replay/{playlist.launch.get('realm', 'unknown')}"
    if not _REALM.fullmatch(realm):
        raise ConfigurationError(f"--realm must be words joined by /; got {realm!r}")
    with own_stage(playlist, realm) as stage:
        sys.stderr.write(f"playing {len(playlist.topics)} topics in realm {realm}\n")
        yield Player(playlist, stage, head, loop=loop)


@contextmanager
def _joined(playlist: Playlist, head: Playhead, run: Run, replaced: tuple[str, ...], *, loop: bool) -> Iterator[Player]:
    """A player in the place of components of a running system."""
    session = description(run)
    specs = [spec for spec in _specs(playlist.launch) if spec.name in replaced]
    kinds = {key: ports_of(spec.run).OUTPUTS[port].kind for spec in specs for port, key in spec.outputs.items()}
    own = {key for spec in session.system.components for key in spec.outputs.values()}
    lockstep, frames = session.system.clock == "lockstep", _frames(session.system)
    if head.rate == 0 and not lockstep:
        raise ConfigurationError(f"--rate must be > 0 in {run.realm}, whose clock is real; got 0")
    clock = PacedClock(session.origin_ns, session.system.pace or 1.0)

    def now(capture_ns: int) -> int:
        """The running system's time at which a moment of the log happens again."""
        return clock.session_ns(head.monotonic_ns(capture_ns, time.monotonic_ns()))

    with joined_stage(run, session, playlist, kinds) as stage:
        sys.stderr.write(f"playing {', '.join(sorted(playlist.topics))} in realm {run.realm}\n")
        yield Player(
            playlist,
            stage,
            head,
            loop=loop,
            clock=False,
            seeks=not (lockstep and frames),  # a running world begins every epoch at its beginning
            answers=Answers(stands(specs, own), frames) if lockstep else None,
            stall_s=session.system.stall_s,
            capture=None if lockstep else now,
        )


def _listened_to(run: Run, *, loop: bool) -> set[str]:
    """Keys that may come on a running system's bus; in a loop not the one that would end it."""
    return set(run.topics) - ({description(run).system.end} if loop else set())


def _frames(system: System) -> set[str]:
    """Keys on which a world shows its frames."""
    return {
        key
        for spec in system.components
        for port, key in spec.outputs.items()
        if ports_of(spec.run).OUTPUTS[port].delayed
    }


def _specs(launch: Mapping[str, Any]) -> list[ComponentSpec]:
    """Components of the log's resolved launch file."""
    names = {field.name for field in fields(ComponentSpec)}
    try:
        return [ComponentSpec(**{k: v for k, v in row.items() if k in names}) for row in launch["components"]]
    except (TypeError, KeyError, AttributeError):
        raise ConfigurationError("--replace: the log's launch file must be one of this release") from None
