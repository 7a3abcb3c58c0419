"""One running system, shot at again and again: what was done when, and what was left."""

from __future__ import annotations

import json
import os
import signal
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from experiments.faults import inject
from experiments.faults.plan import FOLDS, SUPERVISOR, Injection
from experiments.watched import LAUNCH, START_S, Watched, is_alive, wait_until, watched

RECORDING = "session.mcap"
_MOVES_MPS = 0.03
_FRESH_NS = 400_000_000
_BACK_S = 120.0
"""A start of a learner takes three; on a busy machine a minute."""
_DIES_S, _ENDS_S, _ALONE_S = 4.0, 120.0, 1.2
"""To run out of memory; for a session to end on a busy machine; without the supervisor: for a robot to rest."""
_STATUS_NS = 100_000_000
"""What a dead component said last is not on its way for longer."""
_DEATH_S = 8.0
"""A fused component dies on its next message, a killed one at once."""


class NeverMovedError(RuntimeError):
    """The robot did not drive in time, so nothing was tried; on a busy machine a start may take too long."""


@dataclass
class Incident:
    """What was done, and what was seen of it from outside."""

    injection: Injection
    at_ns: int
    """Session time, as all times here."""
    over_ns: int = 0
    """When a passing fault was over, or the session."""
    next_ns: int = 0
    """When the next one was done, or the session's end."""
    died: bool = False
    back: bool = False
    """The robot moved again, with all processes there."""


@dataclass
class Happened:
    """A session and its end."""

    incidents: list[Incident]
    reason: str = ""
    """As `berth run` gave it, or what it said instead."""
    code: int | None = None
    left: list[int] = field(default_factory=list)
    """Processes that have outlived it."""
    ended: bool = False
    origin_ns: int = 0
    """Monotonic time at which session time is 0."""


class Range:
    """A system to be shot at."""

    def __init__(self, system: Watched, directory: Path) -> None:
        self._system = system
        self._directory = directory
        self.pids: set[int] = set()
        """All that ever were."""

    @cached_property
    def origin_ns(self) -> int:
        """Monotonic time at which session time is 0; known once the session runs."""
        return self._system.origin_ns

    @property
    def now_ns(self) -> int:
        """Session time."""
        return time.monotonic_ns() - self.origin_ns

    @property
    def over(self) -> bool:
        """Whether the session has ended."""
        return self._system.process.poll() is not None

    def await_moment(self, frames: int, timeout_s: float) -> bool:
        """Wait for so many frames and then until the robot moves with everybody there."""
        seen = self._system.seen
        first = len(seen.truths) + frames

        def has_come() -> bool:
            return len(seen.truths) >= first and self._moves() and self._all_there()

        return wait_until(lambda: self.over or has_come(), timeout_s) and not self.over

    def _moves(self) -> bool:
        """The robot moves, and a fresh command says so."""
        seen = self._system.seen
        if not (seen.truths and seen.commands):
            return False
        truth, command = seen.truths[-1], seen.commands[-1]
        fresh = self.now_ns - truth.capture_ns < _FRESH_NS and self.now_ns - command.capture_ns < _FRESH_NS
        return fresh and abs(truth.v_mps) > _MOVES_MPS and abs(command.v_mps) > _MOVES_MPS

    def _all_there(self) -> bool:
        found = self._look()
        return found.keys() >= set(FOLDS)

    def _look(self) -> dict[str, int]:
        found = self._system.look() if not self.over else {}
        self.pids |= set(found.values())
        return found

    def hit(self, injection: Injection) -> Incident:
        """Do it, and wait for what comes of it."""
        found = {**self._look(), SUPERVISOR: self._system.process.pid}
        pid = found[injection.victim]
        incident = Incident(injection, self.now_ns)
        if injection.lasts_s:
            {"pause": inject.pause, "slow": inject.slow}[injection.fault](pid, injection.lasts_s)
        else:
            incident.died = self._strike(injection, pid)
        incident.over_ns = self.now_ns
        if incident.died and not injection.restarts:
            wait_until(lambda: self.over, _ENDS_S)
        else:
            incident.back = self._works(injection.victim) and self.await_moment(2, _BACK_S)
        incident.next_ns = self.now_ns
        return incident

    def _works(self, name: str) -> bool:
        """Whether a component, started again or not, says that it runs."""
        after_ns = time.monotonic_ns() + _STATUS_NS
        seen = self._system.seen
        return name == SUPERVISOR or wait_until(lambda: self.over or seen.status_ns.get(name, 0) > after_ns, _BACK_S)

    def _strike(self, injection: Injection, pid: int) -> bool:
        """Whether it died of it."""
        if injection.alone:
            os.kill(self._system.process.pid, signal.SIGSTOP)
        undo = self._deed(injection, pid)
        try:
            wait_s = _DIES_S if injection.fault == "memory" else _DEATH_S
            died = wait_until(lambda: not is_alive(pid), wait_s)
            if injection.alone:
                time.sleep(_ALONE_S)
        finally:
            undo()
            if injection.alone:
                os.kill(self._system.process.pid, signal.SIGCONT)
        return died

    def _deed(self, injection: Injection, pid: int) -> Callable[[], None]:
        if injection.fault == "kill":
            inject.kill(pid)
            return lambda: None
        if injection.fault == "memory":
            return inject.starve(pid)
        return inject.light(fuse_of(self._directory, injection.victim))

    def end(self, happened: Happened) -> None:
        """Ask the session to end if it runs, and note what it says and leaves."""
        self._look()
        if not self.over:
            self._system.process.send_signal(signal.SIGINT)
        happened.ended = wait_until(lambda: self.over, _ENDS_S)
        wait_until(lambda: not any(map(is_alive, self.pids)), _ENDS_S)
        happened.left = [pid for pid in self.pids if is_alive(pid)]
        if happened.ended:
            happened.code, out, err = self._system.end(_ENDS_S)
            happened.reason = reason_in(out) or err.strip().rpartition("\n")[2]


def reason_in(out: str) -> str:
    """Exit reason in what `berth run --json` printed; empty if there is none."""
    try:
        return str(json.loads(out)["exit_reason"])
    except (ValueError, KeyError, TypeError):
        return ""


def fuse_of(directory: Path, name: str) -> Path:
    """File that makes a component fail."""
    return directory / f"{name}.fuse"


def launch_file(directory: Path, realm: str, clumsy: Sequence[str]) -> Path:
    """`launch/sim.toml` in a realm of its own, with a fuse in some components."""
    text = LAUNCH.read_text(encoding="utf-8").replace('realm = "berth/sim"', f'realm = "{realm}"')
    for name in clumsy:
        text = text.replace(f'run = "components.{name}"', f'run = "experiments.faults.clumsy.{name}"')
    file = directory / "sim.toml"
    file.write_text(text, encoding="utf-8")
    return file


def words(directory: Path, clumsy: Sequence[str], seed: int) -> list[str]:
    """Arguments of `berth run`. Trials are not followed, so that no report is written: here nobody reads one."""
    fuses = [("--set", f"{name}.fuse={fuse_of(directory, name)}") for name in clumsy]
    told = ("--clock", "real", "--seed", str(seed), "--record", str(directory / RECORDING))
    fixed = (*told, "--set", 'session.trial=""')
    return [*fixed, *(word for pair in fuses for word in pair)]


def run_session(injections: Sequence[Injection], seed: int, directory: Path) -> tuple[Happened, Watched]:
    """Start a system, do these things to it, end it.

    Returns:
        What happened, and what a bystander saw.

    Raises:
        NeverMovedError: nothing could be tried.
    """
    clumsy = sorted({one.victim for one in injections if one.fault == "crash"})
    realm = f"faults/{os.getpid()}-{seed}"
    launch = launch_file(directory, realm, clumsy)
    happened = Happened([])
    with (
        tempfile.TemporaryDirectory(prefix="berth-run-") as home,
        watched(Path(home), realm, words(directory, clumsy, seed), launch=launch) as system,
    ):
        shot_at = Range(system, directory)
        for injection in injections:
            if not shot_at.await_moment(injection.frames, START_S):
                break
            happened.incidents.append(shot_at.hit(injection))
        happened.origin_ns = shot_at.origin_ns
        shot_at.end(happened)
    if not happened.incidents:
        raise NeverMovedError(f"the robot never moved: {happened.reason}")
    return happened, system
