"""How well a model of the log predicts the log itself, and what it predicts of the policy learned. Nothing is driven.

Every figure is a prediction: the robot may know better.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.learner.methods.memory_sweep import MemorySweep
from components.learner.ports import Params
from components.learner.transition import Transition
from docking.policy import UNKNOWN, PolicyTable
from experiments.logged_trials import LoggedTrial

FOLDS = 5
_CONTROLLABLE = 0.5
"""A cell counts as controllable if the goal is reached from it with at least this probability."""
_ITERATIONS = 5000
_CONVERGED = 1e-9
Floats = NDArray[np.float64]


class Prediction(NamedTuple):
    """Figures of one set of parameters; NaN where nothing could be compared."""

    trials: int
    transitions: int
    """That counted."""
    known_percent: float
    """Held-out transitions whose cell and action the other trials knew."""
    one_step_error: float
    """Of those: mean probability that the model gave to other exits than the one taken."""
    outcome_error: float
    """Held-out trials: mean distance of the predicted probability to reach the goal from what happened (0 or 1)."""
    duration_error_s: float
    """Held-out trials that reached the goal: mean distance of the predicted duration."""
    controllable_percent: float
    """Cells from which the learned policy reaches the goal, in the model of the whole log."""
    agreement_percent: float
    """Recorded transitions whose action is the one that the learned policy takes in that cell."""


@dataclass
class _Model:
    """The model of some trials, and how long its transitions take."""

    method: MemorySweep
    periods: Floats
    """[pairs] mean duration, sampling periods."""


def predict(params: Params, trials: Sequence[LoggedTrial], policy: PolicyTable | None) -> Prediction:
    """All figures.

    Args:
        params: of the learner.
        trials: of the log, cut with these parameters.
        policy: learned from the log with these parameters.
    """
    whole = _model_of(params, trials)
    counted = [t for trial in trials for t in trial.transitions if whole.method.counts(t)]
    held_out = [_fold(params, trials, fold) for fold in range(FOLDS)]
    errors = np.concatenate([fold.one_step for fold in held_out])
    return Prediction(
        trials=len(trials),
        transitions=len(counted),
        known_percent=100.0 * len(errors) / len(counted) if counted else np.nan,
        one_step_error=_mean(errors),
        outcome_error=_mean(np.concatenate([fold.outcome for fold in held_out])),
        duration_error_s=_mean(np.concatenate([fold.duration_s for fold in held_out])),
        controllable_percent=_controllable(whole, policy) if policy is not None else np.nan,
        agreement_percent=_agreement(counted, policy) if policy is not None else np.nan,
    )


class _Errors(NamedTuple):
    one_step: Floats
    outcome: Floats
    duration_s: Floats


def _fold(params: Params, trials: Sequence[LoggedTrial], fold: int) -> _Errors:
    """Errors on every fifth trial of a model of the other ones."""
    model = _model_of(params, [trial for number, trial in enumerate(trials) if number % FOLDS != fold])
    held_out = [trial for number, trial in enumerate(trials) if number % FOLDS == fold]
    one_step = [_one_step(model, t) for trial in held_out for t in trial.transitions if model.method.counts(t)]
    behaviour = _behaviour(model)
    reach, duration = _absorbed(model, behaviour)
    outcome, durations = [], []
    goal, cells = model.method.grid.goal, behaviour.sum(axis=1)
    for trial in held_out:
        start, reached = trial.transitions[0].cell, trial.reached(goal)
        if reached is None or cells[start] == 0.0:
            continue
        outcome.append(abs(reach[start] - reached))
        if reached and reach[start] > 0.0:
            predicted = duration[start] / reach[start]
            durations.append(abs(predicted - trial.frames) * params.sampling_period_s)
    known = [error for error in one_step if error is not None]
    return _Errors(np.array(known), np.array(outcome), np.array(durations))


def _model_of(params: Params, trials: Sequence[LoggedTrial]) -> _Model:
    """Whatever the method, a model of the kind that the settings name."""
    method = MemorySweep(params.task, replace(params, method="memory-sweep"))
    pairs = method.q.size
    total, count = np.zeros(pairs), np.zeros(pairs)
    actions = len(method.actions)
    for transition in (t for trial in trials for t in trial.transitions):
        if not method.observe(transition):
            continue
        places = [transition.cell * actions + transition.action]
        if params.mirror:
            places.append(method.grid.mirrored(transition.cell) * actions + int(method.image[transition.action]))
        total[places] += transition.periods
        count[places] += 1
    return _Model(method, np.divide(total, count, out=np.zeros(pairs), where=count > 0))


def _one_step(model: _Model, transition: Transition) -> float | None:
    """Probability given to other cells than the one entered; None where the model knows nothing."""
    learned = model.method.model
    pair = transition.cell * learned.actions + transition.action
    degree = int(learned.degree[pair])
    if degree == 0:
        return None
    entered = transition.next_cell if transition.next_cell >= 0 else learned.grid.count
    here = learned.successor[pair, :degree] == entered
    return 1.0 - float(learned.weight[pair, :degree][here].sum())


def _behaviour(model: _Model) -> Floats:
    """[cells, actions] how often each action was taken in each cell; zeros where nothing is known."""
    learned = model.method.model
    visits = np.where(learned.degree > 0, learned.visits, 0).reshape(-1, learned.actions).astype(float)
    total = visits.sum(axis=1, keepdims=True)
    shares: Floats = np.divide(visits, total, out=np.zeros_like(visits), where=total > 0)
    return shares


def _absorbed(model: _Model, behaviour: Floats) -> tuple[Floats, Floats]:
    """Per cell: probability to reach the goal, and sampling periods times that probability.

    Where a trial may come to a cell that the model knows nothing about, it counts as not reaching the goal.
    """
    learned = model.method.model
    pairs, grid = learned.degree.size, learned.grid
    slots = np.arange(learned.slots)[None, :] < learned.degree[:, None]
    weight = np.where(slots, learned.weight, 0.0)
    successor = np.where(slots, learned.successor, grid.count).astype(np.intp)
    share = behaviour.reshape(pairs)
    reach, duration = np.zeros(grid.count + 1), np.zeros(grid.count + 1)
    reach[grid.goal] = 1.0
    for _ in range(_ITERATIONS):
        step = (weight * reach[successor]).sum(axis=1)
        longer = model.periods * step + (weight * duration[successor]).sum(axis=1)
        before = reach.copy(), duration.copy()
        reach[:-1] = (share * step).reshape(grid.count, -1).sum(axis=1)
        duration[:-1] = (share * longer).reshape(grid.count, -1).sum(axis=1)
        reach[grid.goal], duration[grid.goal] = 1.0, 0.0
        change = max(np.abs(reach - before[0]).max(), np.abs(duration - before[1]).max())
        if change < _CONVERGED:
            break
    return reach[:-1], duration[:-1]


def _controllable(model: _Model, policy: PolicyTable) -> float:
    greedy = np.zeros((policy.grid.count, len(policy.actions)))
    known = policy.action != UNKNOWN
    greedy[known, policy.action[known]] = 1.0
    reach, _ = _absorbed(model, greedy)
    return 100.0 * float((reach >= _CONTROLLABLE).mean())


def _agreement(transitions: Sequence[Transition], policy: PolicyTable) -> float:
    same = [policy.act_in(t.cell) == t.action for t in transitions if policy.act_in(t.cell) is not None]
    return 100.0 * sum(same) / len(same) if same else float("nan")


def _mean(values: Floats) -> float:
    return float(values.mean()) if values.size else float("nan")
