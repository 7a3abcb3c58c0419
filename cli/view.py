"""`berth view [FILE]`: a running system or a recording in a viewer."""

from __future__ import annotations

import importlib.util
import re
import sys
import time
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
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
OPEN = Annotated[bool, typer.Option("--open/--no-open", help="With --web: open the browser.")]
_SIZE = re.compile(r"[1-9][0-9]{0,4}(MB|GB|%)")
_POLL_S = 0.1


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
    open_browser: OPEN = True,
) -> None:
    """Watch a running system, or a recording with a time line. Example: berth view recordings/sim.mcap --web."""
    _check(file, web, foxglove, save, layout, port, realm, memory_limit)
    run = None if file is not None else find(realm)
    asked: list[str] = []
    with on_signal(lambda: asked.append("interrupted")):
        if foxglove:
            _in_foxglove(file, run, 8765 if port is None else port, layout, hz, lambda: bool(asked))
        else:
            _in_rerun(file, run, save, port, hz, memory_limit, lambda: bool(asked), web=web, open_browser=open_browser)


def _check(
    file: Path | None,
    web: bool,
    foxglove: bool,
    save: Path | None,
    layout: Path | None,
    port: int | None,
    realm: str,
    memory_limit: str,
) -> None:
    if web + foxglove + (save is not None) > 1:
        raise ConfigurationError("--web, --foxglove and --save: only one of them")
    if file is not None and realm:
        raise ConfigurationError("--realm must stand without a file")
    if layout is not None and not foxglove:
        raise ConfigurationError("--layout must stand with --foxglove")
    if port is not None and not (web or foxglove):
        raise ConfigurationError("--port must stand with --web or --foxglove")
    if not _SIZE.fullmatch(memory_limit):
        raise ConfigurationError(f"--memory-limit must be like 500MB, 2GB or 25%; got {memory_limit!r}")
    if save is not None and save.exists():
        raise ConfigurationError(f"--save {save}: must not exist yet")
    module = "foxglove" if foxglove else "rerun"
    if importlib.util.find_spec(module) is None:
        raise ConfigurationError(f"berth view needs {module}; `make setup-view` brings it")


def _in_rerun(
    file: Path | None,
    run: Run | None,
    save: Path | None,
    port: int | None,
    hz: float,
    memory_limit: str,
    is_asked: Callable[[], bool],
    *,
    web: bool,
    open_browser: bool,
) -> None:
    from viewer import live, recorded, rerun_session  # noqa: PLC0415  (a second, and only here)

    where: Path | Literal["web", "window"] = save or ("web" if web else "window")
    found = recorded.opened(file) if file is not None else None
    name = str(file or (run.realm if run is not None else ""))
    with rerun_session.opened(where, name, memory_limit, port=9090 if port is None else port, live=run is not None) as (
        sink,
        url,
        is_closed,
    ):
        if url:
            sys.stderr.write(f"showing {name} at {url} ; Ctrl-C ends it\n")
            if open_browser:
                webbrowser.open(url)
        if found is not None:
            with _told(name) as told:
                recorded.show(*found, sink, told)
        elif run is not None:
            live.follow(run, sink, hz, lambda: is_asked() or is_closed())
            sys.stderr.write("" if is_asked() or is_closed() else "the system has ended\n")
        while save is None and not (is_asked() or is_closed()):
            time.sleep(_POLL_S)


@contextmanager
def _told(file: str) -> Iterator[Callable[[float], None]]:
    """Say how far the reading of a file is."""
    console = Console(stderr=True)
    with console.status(f"reading {file}") as status:
        yield lambda second: status.update(f"reading {file}: {second / 60:.1f} robot minutes")


def _in_foxglove(
    file: Path | None, run: Run | None, port: int, layout: Path | None, hz: float, is_asked: Callable[[], bool]
) -> None:
    from viewer import foxglove_layout, foxglove_session  # noqa: PLC0415

    with foxglove_session.opened_socket(file, port) as session:
        if layout is not None:
            foxglove_layout.write(layout)
        sys.stderr.write(
            f"showing {file or (run.realm if run is not None else '')} at {session.url} ; Ctrl-C ends it\n"
        )
        session.run(run, hz, is_asked)
