"""Small systems of real processes for the tests of the runtime."""

import json
import secrets
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from runtime.launch import load
from runtime.supervise import Supervisor
from runtime.system import System

DEADLINE_S = 30.0
TAPS = {"witness": ("tests.runtime.parts.witness", "heard.jsonl"), "recorder": ("components.recorder", "session.mcap")}
"""Name of a tap -> its package and the file that it writes."""


class Heard(NamedTuple):
    key: str
    schema: str
    payload: bytes
    run: int
    sequence: int
    capture_ns: int
    time_ns: int


def small_system(
    directory: Path,
    overrides=(),
    *,
    fold: str = "echo",
    echo: str = "",
    world: str = "",
    tap: str = "witness",
    clock: str = "lockstep",
    stall_s: float = 20.0,
    only=(),
) -> System:
    """World, a fold that answers it and a tap, in a realm of their own; `world` and `echo`: more lines of the two."""
    directory.mkdir(exist_ok=True)
    file = directory / "small.toml"
    package, recording = TAPS[tap]
    file.write_text(
        f"""
realm = "test/{secrets.token_hex(6)}"
[session]
clock = "{clock}"
stall_s = {stall_s}
end = "world/end"
[component.world]
run = "tests.runtime.parts.world"
inputs = {{ drive = "{fold}/drive", ack = "{tap}/ack" }}
{world}
[component.{fold}]
run = "tests.runtime.parts.{fold}"
inputs = {{ image = "world/image" }}
{echo}
[component.{tap}]
run = "{package}"
""",
        encoding="utf-8",
    )
    return load(file, overrides, recording=directory / recording, only=only)


def recorded_system(directory: Path, overrides=(), **options) -> System:
    """The same with the real recorder; options as of `small_system`."""
    return small_system(directory, overrides, tap="recorder", **options)


def heard(system: System) -> list[Heard]:
    """What the witness has written down."""
    assert system.recording is not None
    rows = [json.loads(line) for line in system.recording.read_text(encoding="utf-8").splitlines()]
    return [Heard(key, schema, bytes.fromhex(payload), *rest) for key, schema, payload, *rest in rows]


def run_until(supervisor: Supervisor, condition: Callable[[], bool] = lambda: False) -> None:
    """Look after the processes until a condition holds or the session ends."""
    deadline_s = time.monotonic() + DEADLINE_S
    while not condition() and supervisor.poll(0.01):
        assert time.monotonic() < deadline_s, (supervisor.missing, supervisor.statuses)


def run_to_end(supervisor: Supervisor) -> None:
    """Run until the session ends by itself, and stop it."""
    run_until(supervisor)
    supervisor.stop()


def wait_for(condition: Callable[[], bool], seconds: float) -> bool:
    """Whether a condition came true in time."""
    deadline_s = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline_s:
            return False
    return True
