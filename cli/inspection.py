"""A system with the inspector in the place of tracker and pilot, and one run of it."""

from __future__ import annotations

import dataclasses
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from cli.in_process import on_signal
from runtime.contract import ComponentError
from runtime.lockstep import Lockstep
from runtime.params import ConfigurationError
from runtime.supervise import Supervisor
from runtime.system import ComponentSpec, System, ports_of
from runtime.wiring import check_wiring

NAME = "inspector"
FINISHED = "finished"
"""The inspector's reason when it came to its end."""
LONGEST_S, SILENCE_S = 120.0, 30.0
"""Session time after which a stage is given up, and wall time without a frame."""
_TOO_SLOW = f"not at its end after {LONGEST_S:g} s: frames come too slowly"
_KEPT = ("components.simulator", "components.camera", "components.vision", "components.head", "components.base")
"""And whatever shows vision its pictures."""
_BEGINS = {"facing": "facing", "head": "facing", "fingertips": "fingertips"}
_TILT_BELOW_RAD = 0.09
"""The head may be told to look up by this, so that a tilt that runs the wrong way shows itself."""


@dataclass
class Result:
    """One stage."""

    reason: str = ""
    robot_s: float = 0.0
    findings: list[Any] = field(default_factory=list)
    """`berth.Finding`, in order."""

    @property
    def finished(self) -> bool:
        """The script came to its end."""
        return self.reason == FINISHED


def of_run(system: System, run: str) -> ComponentSpec | None:
    """The component of a package or of one's own with the same ports (one's own robot); None if there is none."""
    return next((spec for spec in system.components if _plays(spec, run)), None)


def _plays(spec: ComponentSpec, run: str) -> bool:
    outputs = ports_of(run).OUTPUTS
    return spec.run == run or (bool(outputs) and outputs == ports_of(spec.run).OUTPUTS)


def inspected(system: System, stage: str) -> System:
    """The system that runs a stage: camera, vision, head and base as they are, and the inspector.

    Raises:
        ConfigurationError: one of them is missing.
    """
    vision, head, base = (_demanded(system, f"components.{name}") for name in ("vision", "head", "base"))
    shown = vision.inputs.get("image")
    kept = [
        spec for spec in system.components if shown in spec.outputs.values() or any(_plays(spec, run) for run in _KEPT)
    ]
    names = [spec.name for spec in kept]
    changed = [_changed(spec, stage, names) for spec in kept]
    made = dataclasses.replace(
        system,
        components=(*changed, _inspector(system, stage, vision, head, base)),
        end=f"{NAME}/end",
        trial=f"{NAME}/trial",
    )
    check_wiring(made)
    return made


def _demanded(system: System, run: str) -> ComponentSpec:
    spec = of_run(system, run)
    if spec is None:
        raise ConfigurationError(f"{system.file}: component must have one that runs {run!r} to be checked")
    return spec


def _changed(spec: ComponentSpec, stage: str, names: Sequence[str]) -> ComponentSpec:
    """The component with the inspector as its commander."""
    if _plays(spec, "components.simulator"):
        params = {**spec.params, "begins": _BEGINS[stage], "home_tilt_rad": 0.0}
        inputs = {"drive": spec.inputs["drive"], "aim": spec.inputs["aim"], "trial": f"{NAME}/trial"}
        return dataclasses.replace(spec, inputs=inputs, params=params)
    if _plays(spec, "components.head"):
        low = min(float(spec.params["tilt_low_rad"]), -_TILT_BELOW_RAD)
        inputs = {**spec.inputs, "aim": f"{NAME}/aim"}
        return dataclasses.replace(spec, inputs=inputs, params={**spec.params, "tilt_low_rad": low})
    if _plays(spec, "components.base"):
        inputs = {"pilot": f"{NAME}/drive", "device": spec.inputs["device"]}
        params = {**spec.params, "commanders": ("pilot",), "begins_with": (), "stop_when_gone": (*names, NAME)}
        return dataclasses.replace(spec, inputs=inputs, params=params)
    return spec


def _inspector(
    system: System, stage: str, vision: ComponentSpec, head: ComponentSpec, base: ComponentSpec
) -> ComponentSpec:
    inputs = {
        "view": vision.outputs["view"],
        "head": head.outputs["state"],
        "base": base.outputs["state"],
        "applied": base.outputs["applied"],
    }
    run = "components.inspector"
    params = dataclasses.asdict(ports_of(run).Params(stage=stage, **_in_force(system, vision, head, base)))
    outputs = {port: f"{NAME}/{port}" for port in ports_of(run).OUTPUTS}
    return ComponentSpec(NAME, run, base.host, "never", 0, {}, inputs, outputs, params, base.seed, tap=False)


def _in_force(system: System, vision: ComponentSpec, head: ComponentSpec, base: ComponentSpec) -> dict[str, Any]:
    """What the inspector compares with."""
    tracker = of_run(system, "components.tracker")
    known = {
        "width_px": vision.params["width_px"],
        "pan_rate_radps": head.params["pan_rate_radps"],
        "tilt_rate_radps": head.params["tilt_rate_radps"],
        "beams_swapped": base.params["beams_swapped"],
    }
    if tracker is not None:
        of_tracker = ("camera_latency_s", "encoder_latency_s", "head_lag_s", "frame_s")
        gains = ("pan_gain_p", "pan_gain_d", "tilt_gain_p", "tilt_gain_d")
        known |= {name: tracker.params[name] for name in (*of_tracker, *gains)}
    return known


Watch = Mapping[str, Callable[[Any, int], None]]
"""Key below the realm -> called with every message and its capture time."""


def run_stage(system: System, *, in_process: bool = False, watch: Watch | None = None) -> Result:
    """Run an inspected system to its end, or until Ctrl-C, a death or silence; the robot rests afterwards.

    Raises:
        ConfigurationError: the realm is busy.
    """
    result = Result()

    def frame(_message: Any, capture_ns: int) -> None:
        result.robot_s = max(result.robot_s, capture_ns * 1e-9)

    calls: dict[str, Callable[[Any, int], None]] = {
        **(watch or {}),
        f"{NAME}/trial": frame,
        f"{NAME}/finding": lambda message, _: result.findings.append(message),
    }
    result.reason = _in_process(system, calls) if in_process else _on_bus(system, calls)
    return result


def _in_process(system: System, calls: Watch) -> str:
    engine = Lockstep(system)
    for key, call in calls.items():
        engine.watch(key, call)
    try:
        with on_signal(lambda: engine.stop("interrupted")):
            reason = engine.run(LONGEST_S)
            return _TOO_SLOW if reason == "duration" else reason
    except ComponentError as error:
        return str(error)


def _on_bus(system: System, calls: Watch) -> str:
    waiting: deque[tuple[str, Any, int]] = deque()
    supervisor = Supervisor(system)
    for key in calls:
        supervisor.watch(key, partial(_keep, waiting, key))
    with on_signal(lambda: supervisor.stop_soon("interrupted")), supervisor:
        heard_s, newest_ns = time.monotonic(), 0
        while supervisor.poll(0.05):
            before_ns = newest_ns
            newest_ns = max(newest_ns, *(capture_ns for _, _, capture_ns in [*waiting, ("", None, 0)]))
            heard_s = time.monotonic() if newest_ns > before_ns else heard_s
            _hand_out(calls, waiting)
            if time.monotonic() - heard_s > SILENCE_S:
                supervisor.stop_soon(f"no frame for {SILENCE_S:g} s")
            if newest_ns > LONGEST_S * 1e9:
                supervisor.stop_soon(_TOO_SLOW)
        supervisor.stop()
    _hand_out(calls, waiting)
    return supervisor.end_reason


def _keep(waiting: deque[tuple[str, Any, int]], key: str, message: Any, capture_ns: int) -> None:
    waiting.append((key, message, capture_ns))


def _hand_out(calls: Watch, waiting: deque[tuple[str, Any, int]]) -> None:
    while waiting:
        key, message, capture_ns = waiting.popleft()
        calls[key](message, capture_ns)
