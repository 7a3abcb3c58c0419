"""Pan-tilt unit driver: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from docking.angles import DEG
from runtime.contract import DeviceKind, Input, Kind, Port
from runtime.params import ConfigurationError, between, positive, ruled, scale
from schemas.head_pb2 import HeadCommand, HeadState


@dataclass(frozen=True)
class Params:
    """What the pan-tilt unit can do. Defaults: Canon VC-C4, the camera of ActivMedia's PeopleBot."""

    pan_limit_rad: float = between(100 * DEG, 0.01, 3.14)
    """Pan stays within +- this. VC-C4 manual: +-100 deg."""
    tilt_low_rad: float = between(0.0, -1.57, 1.57)
    """Smallest tilt. Martinez-Marin and Duckett 2005, section II: 0 deg."""
    tilt_high_rad: float = between(90 * DEG, -1.57, 1.5708)
    """Largest tilt, downwards. As above: 90 deg."""
    pan_rate_radps: float = positive(800 * 0.1125 * DEG)
    """Fastest pan. VC-C4: 800 pulses/s of 0.1125 deg."""
    tilt_rate_radps: float = positive(622 * 0.1125 * DEG)
    """Fastest tilt. VC-C4: 622 pulses/s of 0.1125 deg."""
    pan_scale: float = scale()
    """What the device is told for 1 rad to the left; -1 = it turns the other way. `berth check hardware` tells."""
    tilt_scale: float = scale()
    """What the device is told for 1 rad down."""
    pan_encoder_scale: float = scale()
    """Radians to the left for 1 of the device's encoder."""
    tilt_encoder_scale: float = scale()
    """Radians down for 1 of the device's encoder."""


@dataclass(frozen=True)
class PanTilt:
    """`device = { kind = "canon-vc-c4", port = "/dev/ttyS1" }` or `"sony-evi-d30"`: a pan-tilt camera."""

    port: str = ruled("/dev/ttyS1", "a path, tcp://HOST:PORT or unix:PATH", bool)
    """Serial port of its own; or `unix:PATH`, where PATH is `aux` of base's pioneer: the robot's auxiliary port."""
    baud: int = positive(9600)
    """Speed of the serial line."""
    inverted: bool = False
    """It hangs upside down, so that left and right, up and down are exchanged. A VC-C4 looks 30 deg down upright, and
    88 deg hanging; the pick-up wants 58."""
    answer_s: float = between(0.5, 0.05, 5.0)
    """Longest wait for an answer; three without one, and the camera is begun with anew. A VC-C4 may take 0.3 s."""
    lead_s: float = between(0.1, 0.0, 1.0)
    """An aim's rates are followed so far ahead: half a frame and the way to the camera."""
    pan_rate_radps: float = positive(90 * DEG)
    """Fastest pan that the camera is set to. VC-C4: 90 deg/s, EVI-D30: 80."""
    tilt_rate_radps: float = positive(70 * DEG)
    """Fastest tilt. VC-C4: 74 deg/s, EVI-D30: 50."""


_TILTS = {"canon-vc-c4": (-30.0, 88.0), "sony-evi-d30": (-25.0, 25.0)}
"""Degrees, downwards, of a camera that hangs: its own range upwards (`canon.TILT`, `visca.TILT`)."""
DEVICES: Mapping[str, DeviceKind | None] = {
    "simulator": None,
    "canon-vc-c4": DeviceKind("components.head.devices.pan_tilt:CanonVcC4", PanTilt),
    "sony-evi-d30": DeviceKind("components.head.devices.pan_tilt:SonyEviD30", PanTilt),
}


def check_device(device: Mapping[str, Any], params: Mapping[str, Any], task: Mapping[str, Any], where: str) -> None:
    """Refuse a camera that can not look where the task wants it to.

    Args:
        device: the launch file's table.
        params: of the component.
        task: of the system.
        where: begins the error.

    Raises:
        ConfigurationError: the object is below the camera's range at the pick-up, or above it at the starts.
    """
    if device["kind"] not in _TILTS:
        return
    low, high = _TILTS[device["kind"]]
    if not device.get("inverted", False):
        low, high = -high, -low
    low_rad, high_rad = max(low * DEG, params["tilt_low_rad"]), min(high * DEG, params["tilt_high_rad"])
    mount = "hanging" if device.get("inverted", False) else "upright"
    for name, is_reached in (
        ("goal_tilt_rad", task["goal_tilt_rad"] <= high_rad),
        ("start_tilt_min_rad", task["start_tilt_min_rad"] >= low_rad),
    ):
        if not is_reached:
            raise ConfigurationError(
                f"{where}.device must reach task.{name}, {task[name] / DEG:.1f} deg; {device['kind']}, {mount}, tilts "
                f"from {low_rad / DEG:.1f} to {high_rad / DEG:.1f}"
            )


INPUTS: Mapping[str, Input] = {
    "aim": Port(HeadCommand, Kind.COMMAND, hz=8, per_frame=True),
    "device": Port(HeadState, Kind.STATE, hz=8, per_frame=True),
}
OUTPUTS: Mapping[str, Port] = {
    "state": Port(HeadState, Kind.STATE, hz=8, per_frame=True, on=("device",)),
    "actuate": Port(HeadCommand, Kind.COMMAND, hz=8, per_frame=True, on=("aim",)),
    "device": Port(HeadState, Kind.STATE, hz=10),
}
