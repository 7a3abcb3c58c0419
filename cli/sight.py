"""Percepts of a robot that stands still: from a recording, from a running system, or from the eyes alone."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from google.protobuf.message import DecodeError

from cli.observer import Observer, observe
from docking.showing import NotShownError, Percept
from docking.task import Task
from runtime.launch import load
from runtime.params import build
from runtime.recording import Recording
from runtime.runfile import Run
from runtime.supervise import Supervisor
from runtime.system import ComponentSpec, System, ports_of
from schemas.percept_pb2 import Percept as PerceptMessage

SCHEMA = "berth.Percept"
WHEELS = frozenset({"berth.Drive", "berth.BaseCommand"})
"""Who says these can move the robot."""
PATIENCE_S = 60.0
"""The head's search for the object takes a quarter of this."""
SIMULATOR = "components.simulator"
_SLICE_S = 0.1


class Frame(NamedTuple):
    """One percept and its capture time."""

    capture_ns: int
    percept: Percept


@dataclass
class Eye:
    """Percepts of a running system, as they come."""

    observer: Observer
    alive: Callable[[], bool]
    """Looks after the system; false when it has ended."""

    def frames(self, count: int) -> list[Frame]:
        """The next so many frames, from the first one on in which the object is seen.

        Raises:
            NotShownError: the object is not seen for long, or the system ends.
        """
        found: list[Frame] = []
        self.observer.take(0.0)
        deadline_s = time.monotonic() + PATIENCE_S
        while len(found) < count:
            found += [frame for frame in self._new() if found or frame.percept.visible]
            if not found and time.monotonic() > deadline_s:
                raise NotShownError(f"object and table edge must be seen; they were not for {PATIENCE_S:g} s")
        return found[:count]

    def wait(self, condition: Callable[[], bool]) -> None:
        """Let frames go by until a condition holds."""
        while not condition():
            self._new()

    def _new(self) -> list[Frame]:
        if not self.alive():
            raise NotShownError("the robot must be seen by a running system; it has ended")
        seen = [row for row in self.observer.take(_SLICE_S) if row.stamp is not None]
        return list(_frames((row.stamp.capture_ns, row.payload) for row in seen if row.stamp is not None))


def _frames(rows: Any) -> Iterator[Frame]:
    for capture_ns, payload in rows:
        try:
            message = PerceptMessage.FromString(payload)
        except DecodeError:
            continue
        yield Frame(capture_ns, Percept(message.visible, message.slope, message.pan_rad, message.tilt_rad))


def recorded_frames(recording: Recording, at_s: float | None, count: int) -> list[Frame]:
    """Consecutive frames of a session.

    Args:
        recording: the session.
        at_s: session time of the first; None = the last ones of the session.
        count: how many.

    Raises:
        NotShownError: it holds no percepts.
    """
    rows = [row for row in recording.messages() if row.schema == SCHEMA]
    if not rows:
        raise NotShownError(f"{recording.file}: must hold percepts; there are none")
    if len({row.topic for row in rows}) > 1:
        raise NotShownError(f"{recording.file}: must hold the percepts of one robot")
    frames = list(_frames((row.capture_ns, row.payload) for row in rows))
    if at_s is None:
        return frames[-count:]
    return [frame for frame in frames if frame.capture_ns >= round(at_s * 1e9)][:count]


def recorded_task(recording: Recording) -> Task:
    """The task of a session's components; the default one if the session says nothing."""
    specs = recording.launch().get("components", [])
    tasks = [
        spec["params"]["task"]
        for spec in (specs if isinstance(specs, list) else [])
        if isinstance(spec, dict) and isinstance(spec.get("params"), dict) and "task" in spec["params"]
    ]
    task = tasks[0] if tasks else {}
    return build(Task, task if isinstance(task, Mapping) else {}, f"{recording.file}: task")


def task_of(system: System) -> Task:
    """The task that a system's components share."""
    tasks = [spec.params["task"] for spec in system.components if "task" in spec.params]
    return build(Task, tasks[0] if tasks else {}, f"{system.file}: task")


def loaded_eyes(launch: Path, overrides: Sequence[str], recording: Path | None) -> System:
    """The part of a system that sees, never in lockstep; whoever could move the wheels is left out.

    A simulated robot is put into the pick-up pose.

    Raises:
        ConfigurationError: the launch file is wrong.
        NotShownError: nobody in it publishes percepts.
    """
    whole = load(launch, overrides)
    clock = "real" if whole.clock == "lockstep" else ""
    posed = [f"{spec.name}.begins=goal" for spec in whole.components if spec.run == SIMULATOR]
    names = eyes(whole)
    taps = [spec.name for spec in load(launch, overrides, recording=recording).components if spec.tap]
    return load(launch, [*posed, *overrides], clock=clock, only=(*names, *taps), recording=recording)


def eyes(system: System) -> list[str]:
    """Names of the components that percepts come from, without those that can move the wheels, in launch order."""
    source = {key: spec for spec in system.components for key in spec.outputs.values()}
    schemas = {spec.name: {port: kind.schema for port, kind in _outputs(spec.run)} for spec in system.components}
    wanted = [spec for spec in system.components if SCHEMA in _names(schemas[spec.name])]
    if not wanted:
        raise NotShownError(f"{system.file}: must have a component that publishes {SCHEMA}")
    found = set()
    while wanted:
        spec = wanted.pop()
        if spec.name not in found and not WHEELS & _names(schemas[spec.name]):
            found.add(spec.name)
            wanted += [source[key] for key in _needed(spec) if key in source]
    return [spec.name for spec in system.components if spec.name in found and not spec.tap]


def _needed(spec: ComponentSpec) -> list[str]:
    """Keys of the inputs that a component can not do without."""
    ports = ports_of(spec.run).INPUTS
    return [key for port, key in spec.inputs.items() if not getattr(ports[port], "optional", False)]


def _outputs(run: str) -> Sequence[tuple[str, Any]]:
    return list(ports_of(run).OUTPUTS.items())


def _names(schemas: Mapping[str, Any]) -> set[str]:
    return {schema.DESCRIPTOR.full_name for schema in schemas.values()}


def percept_key(topics: Mapping[str, str], where: str) -> str:
    """The one key on which percepts come.

    Raises:
        NotShownError: there is none, or there are several.
    """
    keys = [key for key, schema in topics.items() if schema == SCHEMA]
    if len(keys) != 1:
        raise NotShownError(f"{where}: must have one publisher of {SCHEMA}; got {', '.join(keys) or 'none'}")
    return keys[0]


@contextmanager
def eye_of(run: Run) -> Iterator[Eye]:
    """Of a system that runs already."""
    with observe(run, percept_key(run.topics, run.realm)) as observer:
        yield Eye(observer, lambda: True)


@contextmanager
def eye_started(system: System) -> Iterator[Eye]:
    """Of a system that is started for this, and stopped afterwards."""
    with Supervisor(system) as supervisor:
        with observe(supervisor.run, percept_key(supervisor.run.topics, system.file)) as observer:
            yield Eye(observer, lambda: supervisor.poll(0.01))
        supervisor.stop("shown")
