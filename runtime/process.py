"""One component as a process: `python -m runtime.process`, its assignment on standard input.

Standard input stays open while the supervisor lives; its end is the order to stop.
"""

from __future__ import annotations

import ctypes
import gc
import os
import signal
import sys
import threading
import time
import traceback

from runtime.assignment import Assignment
from runtime.contract import ComponentError
from runtime.device import opened
from runtime.hosted import Hosted
from runtime.live import Fold, is_on_control_path
from runtime.params import ConfigurationError
from runtime.station import Station, Stop
from runtime.system import class_of, params_of, ports_of
from runtime.tap import Tap
from runtime.wire import new_run

_GRACE_S = 1.5
"""An orphan that has not ended by itself after this is ended hard."""
_SWITCH_S = 0.0005
"""A message waits for Python's lock up to two switch intervals (measured); the default is 5 ms."""
_BEHIND_NICE = 5
"""Learner and recorder give way to the control path when the processor is short."""
_PR_SET_PDEATHSIG = 1


def main() -> int:
    """Run the component; returns the exit code."""
    assignment = Assignment.from_json(sys.stdin.readline())
    stop = Stop()
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, lambda *_: stop.ask())
    follow_supervisor()
    sys.setswitchinterval(_SWITCH_S)
    try:
        run_component(assignment, stop)
    except (ComponentError, ConfigurationError) as error:
        print(f"{assignment.name}: {error}", flush=True)  # noqa: T201  (standard output is the component's log)
        return 1
    except Exception:  # noqa: BLE001  (the last line of defence: a traceback in the log, and a code)
        traceback.print_exc()
        return 1
    return 0


def run_component(assignment: Assignment, stop: Stop) -> None:
    """Make the component and its shell, and run them to the end."""
    spec = assignment.system.component(assignment.name)
    run = new_run()
    if not is_on_control_path(ports_of(spec.run).OUTPUTS):
        os.nice(_BEHIND_NICE)
    kind = class_of(spec.run)
    if "cv2" in sys.modules:
        sys.modules["cv2"].setNumThreads(1)  # results must not depend on the number of cores
    shell: Fold | Tap
    if spec.tap:
        tap = kind(params_of(spec, assignment.system.file), assignment.system, assignment.started)
        shell = Tap(Station(assignment, tap.outputs, run, stop), tap)
    else:
        hosted = Hosted(spec, run, assignment.system.file)
        device = opened(spec, assignment.system.file)
        shell = Fold(Station(assignment, hosted.outputs, run, stop), hosted, device)
    gc.freeze()  # what exists now stays; later collections need not look at it
    shell.run()


def follow_supervisor() -> None:
    """Stop when the supervisor ends, however it ends."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
    threading.Thread(target=_await_end_of_input, daemon=True).start()


def _await_end_of_input() -> None:
    while os.read(sys.stdin.fileno(), 4096):
        pass
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(_GRACE_S)
    os._exit(1)


if __name__ == "__main__":
    sys.exit(main())
