"""`berth record -o FILE`: record a system that runs already."""

from __future__ import annotations

import json
import sys
import time
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from cli.in_process import on_signal
from cli.picking import EXCLUDE, INCLUDE, TOPICS, selection
from components.recorder.component import Recorder
from components.recorder.ports import Params
from runtime.assignment import Assignment
from runtime.clock import SECOND_NS, FrameClock, LogTimes, PacedClock
from runtime.contract import ComponentError, Output
from runtime.inbox import Arrival
from runtime.joining import description
from runtime.listener import Listener
from runtime.messages import descriptor_set
from runtime.params import ConfigurationError
from runtime.runfile import find
from runtime.wire import new_run

OUTPUT = Annotated[Path, typer.Option("-o", "--output", help="File to make; an existing one is never overwritten.")]
REALM = Annotated[str, typer.Option(help="Which system, if more than one runs.")]
DURATION = Annotated[float | None, typer.Option(help="Wall seconds to stop after.", min=0.0)]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output, at the end.")]
_GAP = "record/gap"
_TICK_NS = SECOND_NS // 10
_SLICE_S = 0.02
_FAREWELL_NS = 300_000_000
"""How long the last messages of a system that has ended are waited for."""


def record(
    output: OUTPUT,
    topics: TOPICS = "",
    include: INCLUDE = "",
    exclude: EXCLUDE = "",
    realm: REALM = "",
    duration: DURATION = None,
    as_json: JSON = False,
) -> None:
    """Record a running system until Ctrl-C or its end. Example: berth record -o look.mcap -x image."""
    wanted = selection(topics, include, exclude)
    run = find(realm)
    wanted.check(run.topics, run.realm)
    keys = [key for key in run.topics if wanted.takes(key)]
    session = description(run)
    transcript = Transcript(output, session)
    for schema in run.topics.values():
        descriptor_set(schema)  # now, not while the first messages come
    with Listener(run, keys, block=session.system.clock == "lockstep") as listener:
        sys.stderr.write(f"recording {len(keys)} topics of {run.realm} into {output}; Ctrl-C ends it\n")
        reason = _follow(listener, transcript, duration)
        table = transcript.close(listener, reason)
    sys.stdout.write(json.dumps(table) + "\n" if as_json else "".join(f"{k:12} {v}\n" for k, v in table.items()))
    raise typer.Exit(1 if transcript.error else 0)


class Transcript:
    """What was heard so far, on its way into a file."""

    def __init__(self, file: Path, session: Assignment) -> None:
        """Make the file.

        Args:
            file: to be made.
            session: the running system.
        """
        started = datetime.now(UTC).isoformat(timespec="milliseconds")
        self._recorder = Recorder(Params(file=str(file)), session.system, started)
        self._file = file
        self._clock = PacedClock(session.origin_ns, session.system.pace or 1.0)
        self._lockstep = session.system.clock == "lockstep"
        self._frames = FrameClock()
        self._log_times = LogTimes()
        self._run = new_run()
        self._gaps = 0
        self._began_ns = time.monotonic_ns()
        self._tick_due_ns = self._began_ns
        self._counts: dict[str, int] = {}
        self._lost = 0
        self.error = ""
        """Why the file can not be written any more."""

    def take(self, heard: Arrival) -> None:
        """Write one message, and before the next one what is missing in front of it."""
        run, sequence, capture_ns = heard.stamp
        self._frames.advance(capture_ns if self._lockstep else self._clock.session_ns(time.monotonic_ns()))
        self._counts[heard.key] = self._counts.get(heard.key, 0) + 1
        for output in self._write(heard.key, heard.schema, heard.payload, run, sequence, capture_ns):
            if output.port == "gap":
                self._lost += output.message.count
                payload = output.message.SerializeToString(deterministic=True)
                self._write(_GAP, "berth.Gap", payload, self._run, self._gaps, capture_ns)
                self._gaps += 1

    def _write(
        self, key: str, schema: str, payload: bytes, run: int, sequence: int, capture_ns: int
    ) -> tuple[Output, ...]:
        log_ns = self._log_times.log_ns(key, run, capture_ns) if self._lockstep else self._frames.now_ns
        return self._recorder.message(key, schema, payload, run, sequence, capture_ns, log_ns)

    def tick(self) -> None:
        """Let the recorder flush when it is time to."""
        now_ns = time.monotonic_ns()
        if now_ns >= self._tick_due_ns:
            self._tick_due_ns = now_ns + _TICK_NS
            self._recorder.tick(self._frames.now_ns)

    def close(self, listener: Listener, reason: str) -> dict[str, object]:
        """Finish the file; returns what is to be told about it."""
        try:
            self._recorder.close()
        except ComponentError as error:
            self.error = str(error)
        return {
            "recording": str(self._file),
            "wall_s": round((time.monotonic_ns() - self._began_ns) / SECOND_NS, 3),
            "messages": sum(self._counts.values()),
            "lost": self._lost,
            "dropped": listener.dropped,
            "refused": listener.refused,
            "topics": self._counts,
            "exit_reason": self.error or reason,
        }


def _follow(listener: Listener, transcript: Transcript, duration_s: float | None) -> str:
    """Record until somebody or something ends it; returns why."""
    asked: list[str] = []
    deadline_s = time.monotonic() + duration_s if duration_s is not None else float("inf")
    with on_signal(lambda: asked.append("interrupted")):
        try:
            while not asked and not listener.is_over:
                _take_some(listener, transcript)
                if time.monotonic() >= deadline_s:
                    return "duration"
            _hear_out(listener, transcript)
        except (ComponentError, ConfigurationError) as error:
            transcript.error = str(error)
    return asked[0] if asked else "the system has ended"


def _take_some(listener: Listener, transcript: Transcript) -> None:
    until_s = time.monotonic() + _SLICE_S
    transcript.tick()
    while (left_s := until_s - time.monotonic()) > 0 and (heard := listener.take(left_s)) is not None:
        transcript.take(heard)


def _hear_out(listener: Listener, transcript: Transcript) -> None:
    """What was said before the end may still be on its way; a system that goes on is not waited for."""
    until_ns = time.monotonic_ns() + _FAREWELL_NS
    while time.monotonic_ns() < until_ns:
        heard = listener.take(_SLICE_S)
        if heard is not None:
            transcript.take(heard)
        elif not listener.is_over:
            return
