"""From the goal cell to the pick-up: a visual servo on bearing and slope, slower at the end."""

from __future__ import annotations

from components.pilot.progress import Wish
from components.pilot.rules import Rules
from components.pilot.sight import Sight


def has_arrived(rules: Rules, sight: Sight) -> bool:
    """Whether the object is as far down in view as at the pick-up."""
    return abs(rules.task.arrival_tilt_rad - sight.tilt_rad) <= rules.params.servo_tolerance_rad


def servo(rules: Rules, sight: Sight) -> Wish:
    """Steer until the tilt is the goal's; a step too far is taken back straight.

    Driving straight on docks few: a fast approach enters the goal cell at its corner, half a metre out. Some enter it
    within a sample of the pick-up, too fast to stop there.
    """
    params, task = rules.params, rules.task
    ahead = task.arrival_tilt_rad - sight.tilt_rad
    if ahead < 0.0:
        return Wish(-params.servo_slowest * task.speed_mps, 0.0, "servo")
    share = ahead / params.servo_slow_tilt_rad if params.servo_slow_tilt_rad > 0.0 else 1.0
    share = min(max(share, params.servo_slowest), 1.0)
    return Wish(share * task.speed_mps, rules.servo.omega_radps(sight.beta_rad, sight.alpha_rad), "servo")
