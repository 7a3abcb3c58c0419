"""A WebSocket on 127.0.0.1 to which Foxglove connects, for a running system or for a recording with its controls."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any

import foxglove
from foxglove.websocket import (
    Capability,
    PlaybackCommand,
    PlaybackControlRequest,
    PlaybackState,
    PlaybackStatus,
    ServerListener,
    WebSocketServer,
)

from runtime.clock import SECOND_NS
from runtime.params import ConfigurationError
from runtime.recording import Recording
from runtime.runfile import Run
from viewer.foxglove_sink import FoxgloveSink
from viewer.live import follow
from viewer.loopback import HOST
from viewer.recorded import opened, span_ns
from viewer.reel import Reel

_POLL_S = 0.1


class Watchers(ServerListener):
    """What those who are connected ask for; on the server's threads."""

    def __init__(self, sink: FoxgloveSink, reel: Reel | None, origin_ns: int) -> None:
        """Nobody is connected.

        Args:
            sink: what they see.
            reel: plays a recording; None if they watch a running system.
            origin_ns: wall-clock time at session time 0.
        """
        self._sink = sink
        self._reel = reel
        self._origin_ns = origin_ns

    def on_subscribe(self, client: Any, channel: Any) -> None:  # noqa: ARG002
        """Somebody wants to see a topic."""
        self._sink.joined()

    def on_playback_control_request(self, playback_control_request: PlaybackControlRequest) -> PlaybackState | None:
        """Play, pause, speed, seek."""
        if self._reel is None:
            return None
        asked = playback_control_request
        plays = asked.playback_command == PlaybackCommand.Play
        sought_ns = None if asked.seek_time is None else asked.seek_time - self._origin_ns
        self._reel.ask(plays=plays, rate=asked.playback_speed, sought_ns=sought_ns)
        return PlaybackState(
            status=PlaybackStatus.Playing if plays else PlaybackStatus.Paused,
            current_time=self._origin_ns + (self._reel.time_ns if sought_ns is None else sought_ns),
            playback_speed=asked.playback_speed,
            did_seek=sought_ns is not None,
            request_id=asked.request_id,
        )


class Session:
    """An open socket."""

    def __init__(self, server: WebSocketServer, sink: FoxgloveSink, reel: Reel | None, origin_ns: int) -> None:
        """Show nothing before `run`."""
        self._server = server
        self._sink = sink
        self._reel = reel
        self._origin_ns = origin_ns

    @property
    def url(self) -> str:
        """To connect to."""
        return f"ws://{HOST}:{self._server.port}"

    def run(self, run: Run | None, hz: float, is_over: Callable[[], bool]) -> None:
        """Show a running system until nobody looks any more, or play the recording."""
        if self._reel is not None:
            self._reel.run(is_over, self._tell)
        elif run is not None:
            follow(run, self._sink, hz, is_over)
        while not is_over():
            self._sink.flush()
            time.sleep(_POLL_S)

    def _tell(self, reel: Reel) -> None:
        """Where the reel is."""
        status = PlaybackStatus.Playing if reel.plays else PlaybackStatus.Paused
        self._server.broadcast_playback_state(
            PlaybackState(
                status=PlaybackStatus.Ended if reel.has_ended else status,
                current_time=self._origin_ns + reel.time_ns,
                playback_speed=reel.rate,
                did_seek=False,
                request_id=None,
            )
        )
        self._server.broadcast_time(self._origin_ns + reel.time_ns)


@contextmanager
def opened_socket(file: Path | None, port: int) -> Iterator[Session]:
    """Open the socket.

    Args:
        file: a recording; None for a running system.
        port: to listen on; 0 = any.

    Raises:
        ConfigurationError: the port is taken, or the file is no session of ours.
    """
    context = foxglove.Context()
    recording = Recording(file) if file is not None else None
    origin_ns = _origin_ns(recording)
    sink = FoxgloveSink(context, origin_ns)
    reel = Reel(lambda: opened(recording.file), sink) if recording is not None else None
    span = None
    if recording is not None:
        opened(recording.file)
        first_ns, last_ns = span_ns(recording)
        span = (origin_ns + first_ns, origin_ns + last_ns)
    server = _started(context, Watchers(sink, reel, origin_ns), port, span)
    try:
        yield Session(server, sink, reel, origin_ns)
    finally:
        server.stop()


def _started(context: foxglove.Context, watchers: Watchers, port: int, span: tuple[int, int] | None) -> WebSocketServer:
    try:
        return foxglove.start_server(
            name="berth",
            host=HOST,
            port=port,
            capabilities=[Capability.Time],
            server_listener=watchers,
            context=context,
            playback_time_range=span,
        )
    except (OSError, RuntimeError, ValueError) as error:
        raise ConfigurationError(f"--port must be one that is free here; got {port}: {error}") from None


def _origin_ns(recording: Recording | None) -> int:
    """Wall-clock time at session time 0."""
    if recording is None:
        return time.time_ns()
    try:
        return round(datetime.fromisoformat(recording.session().get("started", "")).timestamp()) * SECOND_NS
    except ValueError:
        return 0
