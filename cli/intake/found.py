"""What a bag or a folder gives, in its own order."""

from __future__ import annotations

from typing import NamedTuple

from cli.intake.picture import Raw


class Picture(NamedTuple):
    """One image, not yet looked at."""

    stamp_ns: int
    """Since 1970, of its exposure as far as is known."""
    data: bytes | Raw


class Pose(NamedTuple):
    """One reading of the wheels."""

    stamp_ns: int
    x_m: float
    y_m: float
    heading_rad: float
    v_mps: float
    omega_radps: float


class Useless(NamedTuple):
    """Something that was there and can not be used."""

    why: str


Found = Picture | Pose | Useless
