"""Runs one component of a session again, in the order of its journal, and compares what it says."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from runtime.comparison import Comparison, Difference
from runtime.contract import DEVICE, Port
from runtime.fingerprint import fingerprint
from runtime.hosted import Sample
from runtime.mcap_items import Fault
from runtime.params import ConfigurationError
from runtime.recorded_system import recorded_component
from runtime.recording import Logged, Recording
from runtime.rerun import Outcome, Rerun
from runtime.system import ComponentSpec, ports_of
from runtime.window import Window

_SNAPSHOT = "berth.Snapshot"
_SNAPSHOTS_KEPT = 4
"""A supervisor keeps the newest one that it has heard; the one or two after it may not have reached it."""


@dataclass
class Report:
    """What came of a replay."""

    component: str
    runs: list[Outcome] = field(default_factory=list)
    comparisons: list[Comparison] = field(default_factory=list)
    """One for each of `runs`."""
    notes: list[str] = field(default_factory=list)
    """Why less can be said than one might wish, in words."""
    other_machine: bool = False
    """Recorded with other libraries or on another processor: real numbers are compared with a tolerance."""

    def count(self, name: str) -> int:
        """Sum of a count of the comparisons: identical, different, unpaired, beyond."""
        return sum(getattr(comparison, name) for comparison in self.comparisons)

    @property
    def differs(self) -> bool:
        """Something that was compared is not the same."""
        return self.count("different") > 0 or any(outcome.raised for outcome in self.runs)

    @property
    def is_lossy(self) -> bool:
        """Something could not be replayed or compared."""
        incomplete = any(outcome.words for outcome in self.runs)
        return incomplete or self.count("unpaired") + self.count("beyond") > 0

    @property
    def first(self) -> list[Difference]:
        """The first differences of all runs."""
        return [difference for comparison in self.comparisons for difference in comparison.first]

    @property
    def events(self) -> int:
        """Events handed over."""
        return sum(outcome.events for outcome in self.runs)

    @property
    def outputs(self) -> dict[str, int]:
        """Key -> messages said."""
        total: dict[str, int] = {}
        for outcome in self.runs:
            for key, count in outcome.outputs.items():
                total[key] = total.get(key, 0) + count
        return total


def replay(
    recording: Recording,
    name: str,
    overrides: Iterable[str] = (),
    *,
    compare: bool = True,
    tell: Callable[[Sample, int], None] | None = None,
) -> Report:
    """Run a component of a session again.

    One pass over the file; what is kept of it is bounded. What the component said then is compared, never read.

    Args:
        recording: the session.
        name: of the component.
        overrides: other parameters, see `recorded_component`.
        compare: whether to look at the recorded outputs at all.
        tell: called with each output and the session time of its cause.

    Raises:
        ConfigurationError: no such session or component, or the session holds no journal of it.
    """
    _, spec = recorded_component(recording, name, overrides)
    report = Report(name, other_machine=_recorded_fingerprint(recording) != fingerprint())
    _Replay(recording, spec, report, compare, tell).run()
    if not report.runs:
        raise ConfigurationError(f"{recording.file}: holds no journal of {name}; without it nothing can be replayed")
    return report


class _Replay:
    def __init__(
        self,
        recording: Recording,
        spec: ComponentSpec,
        report: Report,
        compare: bool,
        tell: Callable[[Sample, int], None] | None,
    ) -> None:
        self._recording = recording
        self._spec = spec
        self._report = report
        self._compare = compare
        self._tell = tell
        self._journal = f"{spec.name}/journal"
        inputs: Any = ports_of(spec.run).INPUTS
        wired = {port: key for port, key in spec.inputs.items() if isinstance(inputs.get(port), Port)}
        self._windows = {port: Window() for port in wired}
        self._readers: dict[str, list[Window]] = {}
        for port, key in wired.items():
            self._readers.setdefault(key, []).append(self._windows[port])
        said = {key for port, key in spec.outputs.items() if port != DEVICE}  # that is what its device read
        self._outputs = frozenset(said) if compare else frozenset()
        self._comparisons: dict[int, Comparison] = {}
        self._snapshots: dict[tuple[int, int], bytes] = {}
        self._rerun: Rerun | None = None
        self._done: set[int] = set()

    def run(self) -> None:
        faults: list[Fault] = []
        for logged in self._recording.messages({*self._readers, *self._outputs, self._journal}, faults):
            if logged.topic == self._journal:
                self._read_journal(logged)
            elif logged.topic in self._outputs:
                self._record(logged)
            for window in self._readers.get(logged.topic, ()):
                window.add(logged)
            if self._rerun is not None and logged.topic in self._readers:
                self._rerun.advance()
        self._close()
        self._report.notes += [f"byte {fault.offset}: {fault.words}" for fault in faults]

    def _read_journal(self, logged: Logged) -> None:
        if logged.run in self._done:
            return
        if self._rerun is None or self._rerun.outcome.run != logged.run:
            self._close()
            self._rerun = self._begin(logged.run)
        self._rerun.read(logged.payload)

    def _begin(self, run: int) -> Rerun:
        comparison = self._comparison(run)

        def say(sample: Sample) -> None:
            if self._compare:
                comparison.say(sample)
            self._keep(sample)
            if self._tell is not None:
                self._tell(sample, rerun.outcome.until_ns)

        rerun = Rerun(self._spec, run, str(self._recording.file), self._windows, self._snapshots, say)
        self._report.runs.append(rerun.outcome)
        self._report.comparisons.append(comparison)
        return rerun

    def _keep(self, sample: Sample) -> None:
        """Of the snapshots said, the newest: a later run may have gone on from one of them."""
        if sample.schema == _SNAPSHOT:
            self._snapshots[sample.run, sample.sequence] = sample.payload
            if len(self._snapshots) > _SNAPSHOTS_KEPT:
                del self._snapshots[next(iter(self._snapshots))]

    def _record(self, logged: Logged) -> None:
        if logged.run not in self._done:
            self._comparison(logged.run).record(logged)

    def _comparison(self, run: int) -> Comparison:
        if run not in self._comparisons:
            self._comparisons[run] = Comparison(tolerant=self._report.other_machine)
        return self._comparisons[run]

    def _close(self) -> None:
        """The run that was replayed last is over: its component ended, or the file did."""
        if self._rerun is None:
            return
        outcome = self._rerun.finish()
        if len(self._report.runs) > 1:
            how = "went on from a snapshot" if outcome.went_on else "is replayed as from a cold start"
            self._report.notes.append(f"{self._spec.name} was started again: run {outcome.run:016x} {how}")
        self._comparisons.pop(outcome.run).finish(to_the_end=outcome.ended)
        self._done.add(outcome.run)
        self._rerun = None


def _recorded_fingerprint(recording: Recording) -> object:
    try:
        return json.loads(recording.session().get("fingerprint", "{}"))
    except (ValueError, RecursionError):
        return {}
