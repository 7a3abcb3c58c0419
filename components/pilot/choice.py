"""Who chooses the action in a cell, and how long it is held."""

from __future__ import annotations

from dataclasses import replace

from components.pilot.fine import is_there, leads, steer_fine
from components.pilot.progress import Held, Phase, Progress, Step, Wish
from components.pilot.rules import Rules
from components.pilot.sight import Sight
from docking.cells import SINK, Grid
from docking.grid_policy import GridPolicy
from docking.linear import teacher_action
from docking.policy import PolicyTable

Actions = tuple[tuple[float, float], ...]
_TRAINERS = {"rl": ("random", "random"), "lc": ("lc", "lc"), "rl-lc": ("lc", "random"), "greedy": ("greedy", "greedy")}
"""Controllers of the even and the odd trials."""


def controller_of(rules: Rules, progress: Progress) -> str:
    """Who drives this trial: lc, random or greedy."""
    if rules.is_rivals(progress):
        return rules.params.rival_controller
    if progress.phase == Phase.EVALUATE:
        return rules.params.evaluation_controller
    return _TRAINERS[rules.params.controller][progress.number % 2]


def table_of(rules: Rules, table: PolicyTable | None, progress: Progress) -> PolicyTable | None:
    """The policy of this trial: the given one, or in a comparison's other trials the rival's."""
    return rules.rival if rules.is_rivals(progress) else table


def steer(rules: Rules, table: PolicyTable | None, progress: Progress, sight: Sight) -> Step:
    """Drive as the trial's controller says: the held action, or a new one in a new cell."""
    controller, table = controller_of(rules, progress), table_of(rules, table, progress)
    if controller == "lc" and progress.phase == Phase.EVALUATE:
        omega = rules.teacher.omega_radps(sight.beta_rad, sight.alpha_rad)
        progress = replace(progress, held=Held(controller="lc"))
        return progress, Wish(rules.task.speed_mps, omega, "lc")
    fine = fine_of(rules, table, progress)
    if fine is not None:
        return steer_fine(rules, fine, progress, sight)
    grid, cell = _cell(rules, table if controller == "greedy" else None, sight)
    if cell != progress.held.cell or rules.params.hold == "sample":
        progress = _choose(rules, table, progress, controller, grid, cell)
    held = progress.held
    return progress, Wish(held.v_mps, held.omega_radps, held.controller, held.action)


def is_at_goal(rules: Rules, table: PolicyTable | None, progress: Progress, sight: Sight) -> bool:
    """Whether the approach is over: in the goal cell, or before the pick-up if the policy leads there itself."""
    fine = landing_policy(rules, table, progress)
    if fine is not None and (leads(fine, sight) or is_there(rules, fine, progress, sight)):
        return is_there(rules, fine, progress, sight)
    return rules.grid.cell(sight.beta_rad, sight.alpha_rad) == rules.grid.goal


def fine_of(rules: Rules, table: PolicyTable | None, progress: Progress) -> GridPolicy | None:
    """The policy that knows the distance, where it drives this trial; `table` is the trial's (`table_of`)."""
    greedy = controller_of(rules, progress) == "greedy"
    return table.fine if greedy and table is not None else None


def landing_policy(rules: Rules, table: PolicyTable | None, progress: Progress) -> GridPolicy | None:
    """As above, where it leads to the pick-up itself; in training a trial ends at the goal cell."""
    fine = fine_of(rules, table_of(rules, table, progress), progress)
    return fine if fine is not None and fine.docking and progress.phase == Phase.EVALUATE else None


def is_off_limits(rules: Rules, table: PolicyTable | None, progress: Progress, sight: Sight) -> bool:
    """Whether nothing is known of such angles: outside the cells, or of what the policy was planned for."""
    fine = fine_of(rules, table_of(rules, table, progress), progress)
    if fine is not None:
        return not fine.axes.spans(sight.beta_rad, sight.alpha_rad)
    return rules.grid.cell(sight.beta_rad, sight.alpha_rad) == SINK


def _cell(rules: Rules, table: PolicyTable | None, sight: Sight) -> tuple[Grid, int]:
    """Cell of the policy's own grid if it has one there, else of the task's."""
    if table is not None:
        cell = table.grid.cell(sight.beta_rad, sight.alpha_rad)
        if cell != SINK:
            return table.grid, cell
    return rules.grid, rules.grid.cell(sight.beta_rad, sight.alpha_rad)


def _choose(
    rules: Rules, table: PolicyTable | None, progress: Progress, controller: str, grid: Grid, cell: int
) -> Progress:
    actions: Actions = rules.task.actions
    action: int | None = None
    if controller == "greedy":
        if table is not None and grid == table.grid:
            actions, action = table.actions, table.act_in(cell)
        controller = "greedy" if action is not None else rules.params.unknown_cells
    if controller == "random":
        action = int(rules.generator(progress).integers(len(actions)))
        progress = replace(progress, draws=progress.draws + 1)
    elif action is None:
        action = teacher_action(rules.teacher, grid, cell, actions)
    v, omega = actions[action]
    return replace(progress, held=Held(cell, action, v, omega, controller))
