"""Ctrl-C and kill -9 of each process while the robot drives, real-time clock: how fast it stops, and what is left.

Where base's ears and the robot's own watchdog must do it, the supervisor is frozen, so that it can not help.
"""

from __future__ import annotations

import json
import os
import signal
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from benchmarks.figure import Figure
from benchmarks.watched import START_S, Watched, wait_until, watched
from components.base.ports import Params as Base
from components.simulator.params import Params as World
from docking.task import Task
from runtime.launch import load
from runtime.recording import Recording

LAUNCH = Path("launch/sim.toml")
_END_S, _REST_S = 10.0, 5.0
_ABSENT = float("inf")
"""Stands for what never came."""


def figures() -> list[Figure]:
    """Ctrl-C, then each process in turn."""
    named = load(LAUNCH, recording=Path("none.mcap")).components
    watched_by_base = load(LAUNCH).component("base").params["stop_when_gone"]
    found = control_c()
    for spec in named:
        if spec.name == "base":
            found += base_killed()
        elif spec.name in watched_by_base:
            found += alone(spec.name)
        else:
            found += helped(spec.name, recovers=spec.restart != "never")
    return found


def control_c() -> list[Figure]:
    """All stopped, at rest, recording complete."""
    with driving() as (system, recording):
        asked_ns = time.monotonic_ns()
        system.process.send_signal(signal.SIGINT)
        gone = wait_until(lambda: not system.left(), _END_S)
        stopped_s = (time.monotonic_ns() - asked_ns) / 1e9 if gone else _ABSENT
        code, _, _ = system.end(_END_S)
        kept = Recording(recording)
        *_, last = kept.messages({"base/actuate"})
        command = last.decoded()
        missing = sum(topic.lost for topic in kept.topics()) if kept.whole() else _ABSENT
    return [
        Figure("Ctrl-C: all processes gone", stopped_s, "s", at_most=2.0),
        Figure("Ctrl-C: last command, speed", abs(command.v_mps) + abs(command.omega_radps), at_most=0.0),
        Figure("Ctrl-C: messages missing in the recording", missing, at_most=0),
        Figure("Ctrl-C: exit code", code, at_least=0, at_most=0),
    ]


def alone(name: str) -> list[Figure]:
    """A process that base watches is killed; base stops by liveliness alone."""
    with driving() as (system, _):
        system.process.send_signal(signal.SIGSTOP)
        killed_ns = system.kill(name)
        zero_s = _first_zero_s(system, killed_ns)
        rests = name != "simulator" and wait_until(system.seen.rests, _REST_S)
        rest_s = (system.seen.rest_ns(killed_ns, World().acceleration_mps2) - killed_ns) / 1e9 if rests else _ABSENT
        system.process.send_signal(signal.SIGCONT)
        ends = _ended(system, name)
    figures = [Figure(f"kill -9 {name}: first zero command", zero_s * 1e3, "ms", at_most=50, note="base, liveliness")]
    if name != "simulator":  # with it the world is gone, too
        figures.append(_rest(name, rest_s, World().command_latency_s))
    return figures + ends


def base_killed() -> list[Figure]:
    """Nobody commands any more: the robot's own watchdog brakes."""
    with driving() as (system, _):
        system.process.send_signal(signal.SIGSTOP)
        killed_ns = system.kill("base")
        rests = wait_until(system.seen.rests, _REST_S)
        full_mps = max(seen.v_mps for seen in system.seen.truths if seen.at_ns >= killed_ns)
        world = World()
        rest_s = (system.seen.rest_ns(killed_ns, world.acceleration_mps2) - killed_ns) / 1e9 if rests else _ABSENT
        system.process.send_signal(signal.SIGCONT)
        ends = _ended(system, "base")
    brakes_s = rest_s - full_mps / world.acceleration_mps2
    limit_s = world.watchdog_s + world.command_latency_s
    note = f"the device's watchdog: {world.watchdog_s:g} s + latency"
    braking = Figure("kill -9 base: braking begins", brakes_s * 1e3, "ms", at_most=1e3 * limit_s, note=note)
    return [braking, _rest("base", rest_s, limit_s), *ends]


def helped(name: str, *, recovers: bool) -> list[Figure]:
    """A process that the motion does not need is killed: the session ends, or the process is started again."""
    with driving() as (system, _):
        killed_ns = system.kill(name)
        if recovers:
            back_s = _back_s(system, name, killed_ns)
            return [Figure(f"kill -9 {name}: started again", back_s, "s", note="the robot drives on meanwhile")]
        zero_s = _first_zero_s(system, killed_ns)
        ends = _ended(system, name)
    note = f"the supervisor stops all; silence alone: {1e3 * Base().max_age_s:.0f} ms"
    return [Figure(f"kill -9 {name}: first zero command", zero_s * 1e3, "ms", at_most=300, note=note), *ends]


def _rest(name: str, rest_s: float, delay_s: float) -> Figure:
    speed, deceleration = Task().speed_mps, World().acceleration_mps2
    note = f"v/deceleration: {1e3 * speed / deceleration:.0f} ms, after up to {1e3 * delay_s:.0f} ms"
    return Figure(f"kill -9 {name}: robot at rest", rest_s * 1e3, "ms", note=note)


def _first_zero_s(system: Watched, killed_ns: int) -> float:
    wait_until(lambda: system.seen.first_zero(killed_ns), _REST_S)
    seen = system.seen.first_zero(killed_ns)
    return (seen.at_ns - killed_ns) / 1e9 if seen is not None else _ABSENT


def _ended(system: Watched, name: str) -> list[Figure]:
    """What is left, and the exit code."""
    wait_until(lambda: not system.left(), _END_S)
    left = len(system.left())
    code, out, _ = system.end(_END_S)
    reason = json.loads(out)["exit_reason"]
    return [
        Figure(f"kill -9 {name}: processes left", left, at_most=0),
        Figure(f"kill -9 {name}: exit code", code, at_least=1, note=reason),
    ]


def _back_s(system: Watched, name: str, killed_ns: int) -> float:
    old = system.pids[name]
    came = wait_until(lambda: system.look().get(name, old) != old, _END_S)
    return (time.monotonic_ns() - killed_ns) / 1e9 if came else _ABSENT


@contextmanager
def driving() -> Iterator[tuple[Watched, Path]]:
    """(system whose robot drives in a trial, its recording)."""
    with tempfile.TemporaryDirectory() as name:
        recording = Path(name) / "stopping.mcap"
        words = ("--clock", "real", "--record", str(recording))
        with watched(Path(name), f"benchmark/stopping-{os.getpid()}", words) as system:
            drives = wait_until(lambda: system.seen.drives() or system.process.poll() is not None, START_S)
            assert drives, "the robot does not drive"
            assert system.look(), "the system ended before it drove"
            yield system, recording
