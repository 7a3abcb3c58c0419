"""PD control of one axis of the head."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Servo:
    """Memory of one axis.

    Each frame the aim moves by P e + D (e - e_before), e = the object's angle less the encoder's. For an object at rest
    e_next = (1 - P - D) e + D e_before: with P + D <= 1 no coefficient is negative, so the error never changes its
    sign, whatever the head's lag and slew limit take away from the motion. That is the paper's "without overshoot"
    (Martinez-Marin and Duckett 2005, section II).
    """

    error_rad: float = 0.0
    tracking: bool = False

    def correction_rad(self, error_rad: float, gain_p: float, gain_d: float) -> float:
        """How far to turn from the encoder's angle."""
        growth = error_rad - self.error_rad if self.tracking else 0.0
        self.error_rad, self.tracking = error_rad, True
        return gain_p * error_rad + gain_d * growth

    def forget(self) -> None:
        """The object is out of sight: its next error has no predecessor."""
        self.error_rad, self.tracking = 0.0, False
