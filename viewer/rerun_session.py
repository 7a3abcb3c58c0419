"""Opens a Rerun recording with our layout: in a window, in the browser, or in a file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

import rerun as rr

from runtime.params import ConfigurationError
from viewer.front import Front
from viewer.program import Program, native, served
from viewer.rerun_layout import layout
from viewer.rerun_sink import RerunSink

_APPLICATION = "berth"
_FILE_S = 600.0


@contextmanager
def opened(
    where: Path | Literal["web", "window"], name: str, memory_limit: str, *, port: int, follow: bool, patience_s: float
) -> Iterator[tuple[RerunSink, str, Callable[[], bool]]]:
    """A viewer that is ready to show a session.

    Args:
        where: a file to write, or where the viewer is.
        name: of the session, shown there.
        memory_limit: most that the viewer keeps, in Rerun's words.
        port: of the web page.
        follow: show the newest moment; else begin at the beginning.
        patience_s: how long a viewer is waited for that hangs; then it misses some.

    Yields:
        The sink; the page's address, empty if there is none; and whether the viewer was closed.

    Raises:
        ConfigurationError: no display, the port is taken, the file can not be written.
    """
    recording = rr.RecordingStream(_APPLICATION)
    if isinstance(where, Path):
        _save(recording, where, follow=follow)
        yield from _shown(recording, name, "", lambda: False, _FILE_S)
    elif where == "window":
        with native(memory_limit) as program:
            _connect(recording, program, follow=follow)
            yield from _shown(recording, name, "", lambda: program.is_over, patience_s)
    else:
        program, pages = served(memory_limit)
        with program, Front(port, pages, program.port) as front:
            _connect(recording, program, follow=follow)
            yield from _shown(recording, name, front.url, lambda: program.is_over, patience_s)


def _save(recording: rr.RecordingStream, file: Path, *, follow: bool) -> None:
    try:
        file.open("xb").close()
    except OSError as error:
        raise ConfigurationError(f"--save {file}: can not be made: {error.strerror}") from None
    recording.save(file, default_blueprint=layout(follow=follow))


def _connect(recording: rr.RecordingStream, program: Program, *, follow: bool) -> None:
    recording.connect_grpc(program.url, default_blueprint=layout(follow=follow))


def _shown(
    recording: rr.RecordingStream, name: str, url: str, is_closed: Callable[[], bool], patience_s: float
) -> Iterator[tuple[RerunSink, str, Callable[[], bool]]]:
    recording.send_recording_name(name)
    sink = RerunSink(recording, patience_s=patience_s)
    try:
        yield sink, url, is_closed
    finally:
        sink.close()
