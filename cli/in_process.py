"""A whole session in this one process, in lockstep."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from cli.session import Watch
from runtime.lockstep import Lockstep, Tap
from runtime.one_thread import keep_start_up_out_of_collections, limit_threads
from runtime.system import ComponentSpec, System, class_of, params_of


def run_in_process(system: System, watch: Watch, started: str, duration_s: float | None) -> str:
    """Run to the end; returns its reason.

    Args:
        system: resolved launch file whose clock is lockstep; its taps are made here.
        watch: gets trials and truth.
        started: wall-clock time for the recording.
        duration_s: session time to stop at; None = the session's own end.

    Raises:
        ConfigurationError: the recording can not be made.
        ComponentError: a component can not go on.
    """
    limit_threads()
    taps = [_tap(spec, system, started) for spec in system.components if spec.tap]
    engine = Lockstep(system, taps=taps)

    def follow(message: Any, capture_ns: int) -> None:
        watch.take(message, capture_ns)
        watch.messages = engine.messages
        watch.show()
        if watch.over:
            engine.stop(watch.over)

    for key in (system.trial, system.truth):
        if key:
            engine.watch(key, follow)
    limit_threads()  # OpenCV listens only once it is imported
    keep_start_up_out_of_collections()
    with on_signal(lambda: engine.stop("interrupted")):
        return engine.run(duration_s)


def _tap(spec: ComponentSpec, system: System, started: str) -> Tap:
    tap: Tap = class_of(spec.run)(params_of(spec, system.file), system, started)
    return tap


@contextmanager
def on_signal(call: Callable[[], None]) -> Iterator[None]:
    """Call once on SIGINT or SIGTERM, or when the terminal is closed."""

    def handler(_number: int, _frame: FrameType | None) -> None:
        call()

    numbers = [signal.SIGINT, signal.SIGTERM]
    if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN:  # nohup means it
        numbers.append(signal.SIGHUP)
    before = {number: signal.signal(number, handler) for number in numbers}
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)
