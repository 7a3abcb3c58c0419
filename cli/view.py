"""`berth view [FILE]`: a running system or a recording in a viewer."""

from __future__ import annotations

import importlib.util
import os
import re
import sys
import time
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import typer
from rich.console import Console

from cli.in_process import on_signal
from runtime.params import ConfigurationError
from runtime.runfile import Run, find

FILE = Annotated[Path | None, typer.Argument(help="Recording (MCAP); without one: the running system.")]
WEB = Annotated[bool, typer.Option("--web", help="Rerun's viewer in the browser; nothing is downloaded.")]
FOXGLOVE = Annotated[bool, typer.Option("--foxglove", help="A WebSocket for Foxglove instead.")]
SAVE = Annotated[Path | None, typer.Option(help="Write a file for Rerun's viewer (.rrd) instead.")]
LAYOUT = Annotated[Path | None, typer.Option(help="With --foxglove: write the layout to import there (JSON).")]
PORT = Annotated[int | None, typer.Option(help="Of --web (9090) or --foxglove (8765), on 127.0.0.1.", min=0, max=65535)]
REALM = Annotated[str, typer.Option(help="Which system, if more than one runs.")]
HZ = Annotated[float, typer.Option(help="Live: most camera images a second.", min=0.1, max=100.0)]
MEMORY = Annotated[str, typer.Option(help="Most that the viewer keeps; the oldest goes first.")]
END = Annotated[bool, typer.Option("--at-end", help="Open a recording at its end instead of at its beginning.")]
OPEN = Annotated[bool, typer.Option("--open/--no-open", help="With --web: open the browser.")]
_SIZE = re.compile(r"[1-9][0-9]{0,4}(MB|GB|%)")
_POLL_S = 0.1
_LIVE_S, _FILE_S = 0.05, 60.0
"""How long a viewer that hangs is waited for; then it misses something."""


def view(
    file: FILE = None,
    web: WEB = False,
    foxglove: FOXGLOVE = False,
    save: SAVE = None,
    layout: LAYOUT = None,
    port: PORT = None,
    realm: REALM = "",
    hz: HZ = 8.0,
    memory_limit: MEMORY = "1GB",
    at_end: END = False,
    open_browser: OPEN = True,
) -> None:
    """Watch a running system, or a recording with a time line. Example: berth view recordings/sim.mcap --web."""
    wish = Wish(file, web, foxglove, save, layout, port, realm, memory_limit, hz, at_end, open_browser)
    _check(wish)
    run = None if file is not None else find(realm)
    asked: list[str] = []
    with on_signal(lambda: asked.append("interrupted")):
        (_in_foxglove if foxglove else _in_rerun)(wish, run, lambda: bool(asked))


@dataclass(frozen=True)
class Wish:
    """What a person has asked for."""

    file: Path | None
    web: bool
    foxglove: bool
    save: Path | None
    layout: Path | None
    port: int | None
    realm: str
    memory_limit: str
    hz: float
    at_end: bool
    open_browser: bool


def _check(wish: Wish) -> None:
    if wish.web + wish.foxglove + (wish.save is not None) > 1:
        raise ConfigurationError("--web, --foxglove and --save: only one of them")
    if wish.file is not None and wish.realm:
        raise ConfigurationError("--realm must stand without a file")
    if wish.file is None and wish.at_end:
        raise ConfigurationError("--at-end must stand with a file")
    if wish.layout is not None and not wish.foxglove:
        raise ConfigurationError("--layout must stand with --foxglove")
    if wish.port is not None and not (wish.web or wish.foxglove):
        raise ConfigurationError("--port must stand with --web or --foxglove")
    if not _SIZE.fullmatch(wish.memory_limit):
        raise ConfigurationError(f"--memory-limit must be like 500MB, 2GB or 25%; got {wish.memory_limit!r}")
    module = "foxglove" if wish.foxglove else "rerun"
    if importlib.util.find_spec(module) is None:
        raise ConfigurationError(f"berth view needs {module}; `make setup-view` brings it")


def _in_rerun(wish: Wish, run: Run | None, is_asked: Callable[[], bool]) -> None:
    os.environ.setdefault("RUST_LOG", "off")  # else the SDK complains at length when a window is closed
    from viewer import live, recorded, rerun_session  # noqa: PLC0415  (a second, and only here)

    where: Path | Literal["web", "window"] = wish.save or ("web" if wish.web else "window")
    found = recorded.opened(wish.file) if wish.file is not None else None
    port, follow, name = (
        wish.port or (9090 if wish.port is None else 0),
        run is not None or wish.at_end,
        _name(wish, run),
    )
    patience_s = _LIVE_S if run is not None else _FILE_S
    with rerun_session.opened(where, name, wish.memory_limit, port=port, follow=follow, patience_s=patience_s) as (
        sink,
        url,
        is_closed,
    ):
        _invite(url, name, open_browser=wish.open_browser)

        def is_over() -> bool:
            return is_asked() or is_closed()

        if found is not None:
            with _told(name) as told:
                recorded.show(*found, sink, told)
        elif run is not None:
            live.follow(run, sink, wish.hz, is_over)
            sys.stderr.write("" if is_over() else "the system has ended\n")
        while wish.save is None and not is_over():
            time.sleep(_POLL_S)


def _name(wish: Wish, run: Run | None) -> str:
    return run.realm if run is not None else str(wish.file)


def _invite(url: str, name: str, *, open_browser: bool) -> None:
    if url:
        sys.stderr.write(f"showing {name} at {url} ; Ctrl-C ends it\n")
        if open_browser:
            webbrowser.open(url)


def _in_foxglove(wish: Wish, run: Run | None, is_asked: Callable[[], bool]) -> None:
    from viewer import foxglove_layout, foxglove_session  # noqa: PLC0415

    with foxglove_session.opened_socket(wish.file, 8765 if wish.port is None else wish.port) as session:
        if wish.layout is not None:
            foxglove_layout.write(wish.layout)
        sys.stderr.write(f"showing {_name(wish, run)} at {session.url} ; Ctrl-C ends it\n")
        session.run(run, wish.hz, is_asked)


@contextmanager
def _told(file: str) -> Iterator[Callable[[float], None]]:
    """Say how far the reading of a file is."""
    console = Console(stderr=True)
    with console.status(f"reading {file}") as status:
        yield lambda second: status.update(f"reading {file}: {second / 60:.1f} robot minutes")
