"""What the pilot forecasts of a trial, in words."""

from __future__ import annotations

from schemas.trial_pb2 import Trial

_LIKELY = 0.5


def sentence(trial: Trial) -> str:
    """Such as "docks with 97 %, 14 s" or "hardly reachable from here (3 %), back off 0.4 m"; empty = none was made."""
    if trial.dock_share <= 0.0:
        return ""
    if trial.dock_share >= _LIKELY:
        return f"docks with {100.0 * trial.dock_share:.0f} %, {trial.dock_s:.0f} s"
    words = f"hardly reachable from here ({100.0 * trial.dock_share:.0f} %)"
    return f"{words}, back off {trial.back_off_m:.1f} m" if trial.back_off_m > 0.0 else words
