"""A `berth run` in a process of its own, watched from outside: its processes, base's commands, the truth."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import zenoh

from runtime.assignment import READY_TIMEOUT_S, Assignment
from runtime.bus import direct, open_peer
from runtime.wire import Decoder, unpack_stamp
from schemas.drive_pb2 import BaseCommand
from schemas.truth_pb2 import Truth

LAUNCH = Path(__file__).parent.parent / "launch" / "sim.toml"
START_S = READY_TIMEOUT_S + 30.0
"""Longest wait for a system to drive: a first start compiles; one that waits for a component in vain says so before."""
_DRIVING_MPS = 0.08
_LOOK_S = 0.002


class Seen(NamedTuple):
    """A command of base or a truth of the simulator, as a bystander saw it."""

    at_ns: int
    """Monotonic time of its arrival."""
    capture_ns: int
    v_mps: float
    omega_radps: float

    @property
    def still(self) -> bool:
        """Whether it neither moves nor turns."""
        return self.v_mps == 0.0 and self.omega_radps == 0.0


class Bystander:
    """Notes base's commands and the truth. They are few: eight a second each, for some seconds."""

    def __init__(self, session: zenoh.Session, realm: str) -> None:
        self.commands: list[Seen] = []
        self.truths: list[Seen] = []
        self.status_ns: dict[str, int] = {}
        """Component -> monotonic time at which its newest status came; there is one a second."""
        for key, kind, rows in (
            ("base/actuate", BaseCommand, self.commands),
            ("simulator/truth", Truth, self.truths),
        ):
            session.declare_subscriber(f"{realm}/{key}", direct(_noter(kind, rows)))
        session.declare_subscriber(f"{realm}/*/status", direct(self._note_status))

    def _note_status(self, sample: zenoh.Sample) -> None:
        self.status_ns[str(sample.key_expr).split("/")[-2]] = time.monotonic_ns()

    def drives(self) -> bool:
        """Whether the robot moves as fast as it does in a trial, and base commands it."""
        return (
            bool(self.truths and self.commands)
            and self.truths[-1].v_mps > _DRIVING_MPS
            and self.commands[-1].v_mps > _DRIVING_MPS
        )

    def first_zero(self, since_ns: int) -> Seen | None:
        """First command to stand still that came after a monotonic time."""
        return next((seen for seen in list(self.commands) if seen.at_ns >= since_ns and seen.still), None)

    def rests(self) -> bool:
        """Whether the newest truth is at rest."""
        return bool(self.truths) and self.truths[-1].still

    def rest_ns(self, since_ns: int, deceleration_mps2: float) -> int:
        """Monotonic time at which the robot came to rest, from the speed in the last frame in which it moved."""
        offset_ns = min(seen.at_ns - seen.capture_ns for seen in self.truths)
        moving = [seen for seen in self.truths if seen.v_mps != 0.0]
        last = moving[-1]
        return max(since_ns, offset_ns + last.capture_ns + round(abs(last.v_mps) / deceleration_mps2 * 1e9))


def _noter(kind: type[BaseCommand | Truth], rows: list[Seen]) -> Callable[[zenoh.Sample], None]:
    decode = Decoder(kind)

    def note(sample: zenoh.Sample) -> None:
        at_ns = time.monotonic_ns()
        if sample.attachment is not None:
            message = decode(sample.payload.to_bytes())
            capture_ns = unpack_stamp(sample.attachment.to_bytes()).capture_ns
            rows.append(Seen(at_ns, capture_ns, message.v_mps, message.omega_radps))

    return note


class Watched:
    """A running system."""

    def __init__(self, process: subprocess.Popen[str], table: dict[str, str], bystander: Bystander) -> None:
        self.process = process
        self.realm = table["realm"]
        self.directory = Path(table["directory"])
        """Holds the logs and the session's description."""
        self.seen = bystander
        self.pids: dict[str, int] = {}
        """Component -> process id, as of the last `look`."""

    @property
    def origin_ns(self) -> int:
        """Monotonic time at which session time is 0."""
        return Assignment.from_json((self.directory / "session.json").read_text(encoding="utf-8")).origin_ns

    def look(self) -> dict[str, int]:
        """Find the components' processes: children of ours, told apart by their logs (Linux)."""
        self.pids = children(self.process.pid)
        return self.pids

    def kill(self, name: str) -> int:
        """Kill a component hard; returns the monotonic time before."""
        now_ns = time.monotonic_ns()
        os.kill(self.pids[name], signal.SIGKILL)
        return now_ns

    def left(self) -> list[str]:
        """Components that still run."""
        return [name for name, pid in self.pids.items() if is_alive(pid)]

    def told(self) -> str:
        """What its processes have written and what was seen of it, for whoever asks why it does not drive."""
        logs = sorted(Path(f"/proc/{pid}/fd/1") for pid in self.look().values())
        lines = [f"{log.readlink().stem}: {log.read_text(encoding='utf-8')[-500:]}" for log in logs if log.exists()]
        return "\n".join([f"{len(self.seen.truths)} truths, {len(self.seen.commands)} commands", *lines])

    def end(self, timeout_s: float) -> tuple[int, str, str]:
        """(exit code, standard output, standard error) once it has ended."""
        out, err = self.process.communicate(timeout=timeout_s)
        return self.process.returncode, out, err


def children(pid: int) -> dict[str, int]:
    """Component -> process id of a supervisor's children."""
    found = {}
    for word in Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii").split():
        with contextlib.suppress(OSError):
            log = Path(f"/proc/{word}/fd/1").readlink()
            if log.suffix == ".log":
                found[log.stem] = int(word)
    return found


def is_alive(pid: int) -> bool:
    """Whether a process runs; a zombie does not."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return False
    return state != "Z"


def wait_until(condition: Callable[[], object], timeout_s: float) -> bool:
    """Whether a condition came true in time."""
    deadline_s = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() >= deadline_s:
            return False
        time.sleep(_LOOK_S)
    return True


def realm_copy(directory: Path, name: str) -> Path:
    """`launch/sim.toml` in a realm of its own."""
    file = directory / "system.toml"
    text = LAUNCH.read_text(encoding="utf-8").replace('realm = "berth/sim"', f'realm = "{name}"')
    file.write_text(text, encoding="utf-8")
    return file


def command_line(*arguments: str) -> list[str]:
    """The command `berth`, as this interpreter runs it."""
    return [sys.executable, "-c", "from cli.main import main; main()", *arguments]


@contextmanager
def watched(
    directory: Path, realm: str, arguments: Sequence[str] = (), *, launch: Path | None = None
) -> Iterator[Watched]:
    """Start a system and watch it; whatever is left of it is killed at the end.

    Args:
        directory: for its launch file, its run file and its logs.
        realm: a name that nobody else uses.
        arguments: more words after `berth run LAUNCH`.
        launch: file in that realm; None = `launch/sim.toml` with it.
    """
    home = directory / "run"
    home.mkdir(mode=0o700)
    process = subprocess.Popen(  # noqa: S603  (this interpreter)
        command_line("run", str(launch or realm_copy(directory, realm)), "--json", *arguments),
        cwd=LAUNCH.parent.parent,
        env={**os.environ, "XDG_RUNTIME_DIR": str(home)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    system: Watched | None = None
    try:
        table = _run_table(home / "berth" / f"{realm.replace('/', '+')}.run.json", process)
        with open_peer(table["endpoint"]) as session:
            system = Watched(process, table, Bystander(session, realm))
            yield system
    finally:
        _clear(process, system)


def _run_table(file: Path, process: subprocess.Popen[str]) -> dict[str, str]:
    table: dict[str, str] = {}

    def is_there() -> bool:
        with contextlib.suppress(OSError, ValueError):
            table.update(json.loads(file.read_text(encoding="utf-8")))
        return bool(table) or process.poll() is not None

    if not wait_until(is_there, START_S) or not table:
        raise RuntimeError(f"berth did not start: {process.communicate(timeout=5)[1]}")
    return table


def _clear(process: subprocess.Popen[str], system: Watched | None) -> None:
    pids = list((system.pids if system is not None else {}).values())
    if process.poll() is None:
        pids += children(process.pid).values()
        process.kill()
    process.communicate()
    for pid in pids:
        with contextlib.suppress(OSError):
            if b"runtime.process" in Path(f"/proc/{pid}/cmdline").read_bytes():  # and not somebody who has its number
                os.kill(pid, signal.SIGKILL)
