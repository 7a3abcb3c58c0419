"""Writes what a component says in a replay as a recording of its own."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from runtime.hosted import Sample
from runtime.log import LogWriter
from runtime.recorded_system import recorded_component
from runtime.recording import Recording


@contextmanager
def writer_of(
    recording: Recording, name: str, overrides: Iterable[str], output: Path
) -> Iterator[Callable[[Sample, int], None]]:
    """A function that appends an output and the session time of its cause.

    The file holds the session's launch file with the component's parameters as they are now.

    Raises:
        ConfigurationError: no such component, or the file exists already or can not be made.
    """
    system, _ = recorded_component(recording, name, overrides)
    launch = recording.launch()
    for entry in launch["components"]:
        if entry["name"] == name:
            entry["params"] = json.loads(system.to_json())["components"][0]["params"]
    text = json.dumps(launch, indent=1, sort_keys=True)
    started = recording.session().get("started", "")
    log = LogWriter(output, dataclasses.replace(system, text=text), started=started)

    def write(sample: Sample, time_ns: int) -> None:
        log.write(*sample, time_ns=max(time_ns, sample.capture_ns))

    try:
        yield write
    except BaseException:
        output.unlink()
        raise
    log.close()
