"""The contract checker: runs a launch file's components in one process and tells who breaks which rule, and where."""

from __future__ import annotations

import hashlib
import itertools
import os
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from runtime.contract import ComponentError, Event
from runtime.hosted import Hosted, Sample
from runtime.lockstep import Lockstep
from runtime.params import ConfigurationError
from runtime.system import ComponentSpec, System

SHELL_EVENTS = ("tick", "gone", "stall", "stop")


class Finding(NamedTuple):
    """One rule, for one component."""

    component: str
    rule: str
    kept: bool
    detail: str = ""


@dataclass
class Trace:
    """What one component was handed and what it said."""

    events: list[Event] = field(default_factory=list)
    outputs: list[list[Sample]] = field(default_factory=list)

    def digest(self) -> str:
        """Hash over all output bytes and stamps."""
        found = hashlib.sha256()
        for batch in self.outputs:
            for sample in batch:
                found.update(repr((sample.key, sample.sequence, sample.capture_ns)).encode() + sample.payload)
        return found.hexdigest()


def traces(system: System, duration_s: float) -> dict[str, Trace]:
    """Run the system in this process and keep everything.

    Raises:
        ConfigurationError: its clock is not lockstep, it has no world that shows frames, or a component can not go on.
    """
    if system.clock != "lockstep":
        raise ConfigurationError(f"{system.file}: session.clock must be lockstep to be checked; got {system.clock!r}")
    found: dict[str, Trace] = {spec.name: Trace() for spec in system.components if not spec.tap}
    engine = Lockstep(system)

    def keep(name: str, event: Event, samples: list[Sample]) -> None:
        found[name].events.append(event)
        found[name].outputs.append(samples)

    engine.observe = keep
    try:
        engine.run(duration_s)
    except ComponentError as error:
        raise ConfigurationError(f"{system.file}: can not be tried in one process: {error}") from None
    return found


def check(system: System, duration_s: float = 15.0) -> list[Finding]:
    """Every rule for every component of a system.

    Args:
        system: the resolved launch file.
        duration_s: session time to run.
    """
    found = traces(system, duration_s)
    other = _digests_elsewhere(system, duration_s)
    findings = []
    for spec in system.components:
        if spec.tap:
            continue
        trace = found[spec.name]
        same = other.get(spec.name) == trace.digest()
        findings.append(Finding(spec.name, "same bytes under another hash seed", same))
        findings.append(_resumes(spec, trace, system.file))
        findings += _answers(spec, trace)
        findings.append(_causes(spec, trace, system.file))
    return findings


def _digests_elsewhere(system: System, duration_s: float) -> dict[str, str]:
    """Digests of the same session in a fresh process under another hash seed."""
    environment = {**os.environ, "PYTHONHASHSEED": "4242"}
    done = subprocess.run(
        [sys.executable, "-m", "runtime.check", str(duration_s)],
        input=system.to_json().encode(),
        env=environment,
        stdout=subprocess.PIPE,
        check=True,
    )
    return dict(line.split(" ", 1) for line in done.stdout.decode().splitlines())


def _resumes(spec: ComponentSpec, trace: Trace, file: str) -> Finding:
    """Cut at the middle event, save, load into a fresh one: the remaining bytes must be the same."""
    rule = "same bytes after save and load"
    half = len(trace.events) // 2
    first = Hosted(spec, 1, file)
    if not hasattr(first.component, "save"):
        return Finding(spec.name, rule, kept=True, detail="keeps nothing: restarts cold")
    for event in trace.events[:half]:
        first.handle(event)
    second = Hosted(spec, 1, file)
    second.component.load(first.component.save())
    for event, expected in zip(trace.events[half:], trace.outputs[half:], strict=True):
        said = [(sample.key, sample.payload) for sample in second.handle(event)]
        if said != [(sample.key, sample.payload) for sample in expected]:
            return Finding(
                spec.name, rule, kept=False, detail=f"differs at {event.time_ns / 1e9:.3f} s on {event.port}"
            )
    return Finding(spec.name, rule, kept=True)


def _answers(spec: ComponentSpec, trace: Trace) -> Iterator[Finding]:
    """Every per-frame output exactly once for every frame but the last few, which the end may have cut off."""
    for port, declared in Hosted(spec, 1).outputs.items():
        if not declared.per_frame:
            continue
        key = spec.outputs[port]
        stamps = [sample.capture_ns for batch in trace.outputs[:-1] for sample in batch if sample.key == key]
        frames = sorted(set(stamps))
        twice = [stamp for stamp, count in Counter(stamps).items() if count > 1]
        gaps = {b - a for a, b in itertools.pairwise(frames)}
        kept = bool(frames) and not twice and len(gaps) <= 1
        detail = "" if kept else f"{len(frames)} frames, {len(twice)} answered twice, {len(gaps)} different periods"
        yield Finding(spec.name, f"{port} answers every frame once", kept, detail)


def _causes(spec: ComponentSpec, trace: Trace, file: str) -> Finding:
    """Outputs come only on the input ports that they declare."""
    ports = {spec.outputs[port]: (port, declared.on) for port, declared in Hosted(spec, 1, file).outputs.items()}
    for event, batch in zip(trace.events, trace.outputs, strict=True):
        for sample in batch:
            port, causes = ports[sample.key]
            if event.port not in causes and event.port not in SHELL_EVENTS:
                detail = f"{port} came on {event.port}; declared: {', '.join(causes)}"
                return Finding(spec.name, "outputs come on declared inputs", kept=False, detail=detail)
    return Finding(spec.name, "outputs come on declared inputs", kept=True)


def _main() -> None:
    found = traces(System.from_json(sys.stdin.read()), float(sys.argv[1]))
    for name, trace in found.items():
        sys.stdout.write(f"{name} {trace.digest()}\n")


if __name__ == "__main__":
    _main()
