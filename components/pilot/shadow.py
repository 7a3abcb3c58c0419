"""A pilot that nobody obeys: it says what it would do wherever it sees the object, whatever the robot does."""

from __future__ import annotations

from dataclasses import replace

from components.pilot.choice import steer
from components.pilot.progress import Held, Mode, Phase, Progress, Step, Wish
from components.pilot.rules import Rules
from components.pilot.servo import servo
from components.pilot.sight import Sight
from docking.cells import SINK
from docking.policy import PolicyTable


def advise(rules: Rules, progress: Progress, sight: Sight, table: PolicyTable | None, time_ns: int) -> Step:
    """What the policy would do with this frame. Never engaged, so that it drives nothing even where it is wired."""
    progress = replace(progress, phase=int(Phase.EVALUATE), answered_ns=time_ns)
    cell = rules.grid.cell(sight.beta_rad, sight.alpha_rad) if sight.visible else SINK
    if cell == SINK:
        return replace(progress, mode=int(Mode.WAIT), held=Held()), Wish(engaged=False)
    if cell == rules.grid.goal:
        progress = replace(progress, mode=int(Mode.SERVO), held=Held())
        return progress, servo(rules, sight)._replace(engaged=False)
    progress, wish = steer(rules, table, replace(progress, mode=int(Mode.APPROACH)), sight)
    return progress, wish._replace(engaged=False)
