"""Driving by a policy that knows the distance: looked up where the robot will be when the command is in force."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from components.pilot.forecast import forecast
from components.pilot.progress import Held, Phase, Progress, Step, Wish
from components.pilot.rules import Rules
from components.pilot.sight import Sight
from docking.grid_policy import LONGEST_HOLD, UNKNOWN, GridPolicy
from docking.linear import lawful_action
from docking.percept_filter import predicted

_NEAR_RAD = math.radians(5.0)
"""So much before the tilt at the pick-up, 5 cm, the landing may take over ..."""
_BEFORE_RAD, _FACING_RAD = math.radians(3.5), math.radians(20.0)
"""... within so much of beta and of the bearing; it can hardly move beta any more ..."""
_ASIDE_RAD, _ASKEW_RAD = math.radians(15.0), math.radians(30.0)
"""... and within so much, where the policy has no better way."""


def steer_fine(rules: Rules, policy: GridPolicy, progress: Progress, sight: Sight) -> Step:
    """The policy's action, held for some frames; the law's where it knows none, or base refuses its way back."""
    held = progress.held
    back = held.v_mps < 0.0
    frames = policy.back_samples if back and policy.back_samples else rules.params.fine_hold_samples
    if 0 < _held_frames(progress) < frames and not (back and progress.hindered):
        wish = Wish(held.v_mps, held.omega_radps, held.controller, held.action)
        return remembered(progress, held.v_mps, held.omega_radps), wish
    ahead = _ahead(rules, policy, progress, sight)
    if progress.forecast.share == 0.0 and not progress.sent:
        progress = replace(progress, forecast=forecast(rules, policy, _state(sight)))
    action = int(policy.act(ahead, exploring=progress.phase == Phase.TRAIN)[0])
    controller, cell = "greedy", rules.grid.cell(sight.beta_rad, sight.alpha_rad)
    if action == UNKNOWN or (progress.hindered and policy.actions[action][0] < 0.0):
        controller, action = "lc", lawful_action(rules.teacher, sight.beta_rad, sight.alpha_rad, policy.actions)
    v, omega = policy.actions[action]
    progress = replace(progress, held=Held(cell, action, v, omega, controller))
    return remembered(progress, v, omega), Wish(v, omega, controller, action)


def _held_frames(progress: Progress) -> int:
    """For how many frames the held action has been sent; 0 = none is held."""
    held, pairs = progress.held, list(zip(progress.sent[0::2], progress.sent[1::2], strict=True))
    frames = 0
    while frames < len(pairs) and pairs[-1 - frames] == (held.v_mps, held.omega_radps):
        frames += 1
    return frames if held.action >= 0 else 0


def leads(policy: GridPolicy, sight: Sight) -> bool:
    """Whether the policy itself leads to the pick-up from here."""
    return policy.docking and int(policy.act(_state(sight))[0]) != UNKNOWN


def is_there(rules: Rules, policy: GridPolicy, progress: Progress, sight: Sight) -> bool:
    """Whether a policy that leads to the pick-up has brought the robot so near that the landing can take over."""
    if sight.tilt_rad < rules.task.arrival_tilt_rad - _NEAR_RAD:
        return False
    beta, alpha = abs(sight.beta_rad), abs(sight.alpha_rad)
    if beta < _BEFORE_RAD and alpha < _FACING_RAD:
        return True
    stuck = int(policy.act(_ahead(rules, policy, progress, sight))[0]) == UNKNOWN
    return stuck and beta < _ASIDE_RAD and alpha < _ASKEW_RAD


def remembered(progress: Progress, v_mps: float, omega_radps: float) -> Progress:
    """With the command of this frame."""
    return replace(progress, sent=(*progress.sent, v_mps, omega_radps)[-2 * LONGEST_HOLD :])


def _ahead(rules: Rules, policy: GridPolicy, progress: Progress, sight: Sight) -> NDArray[np.float64]:
    """State `[1, 3]` in which this frame's command comes into force."""
    return predicted(policy.model, _state(sight), _sent(policy, progress), rules.params.sampling_period_s)


def _state(sight: Sight) -> NDArray[np.float64]:
    """(beta, alpha, ln d) `[1, 3]`; d = cot(tilt), in camera heights."""
    return np.array([[sight.beta_rad, sight.alpha_rad, -math.log(math.tan(sight.tilt_rad))]])


def _sent(policy: GridPolicy, progress: Progress) -> list[NDArray[np.float64]]:
    """Commands `[1, 2]` that may still be on their way; the robot stood before the first."""
    needed = int(policy.model.delay_samples) + 1
    pairs = [(0.0, 0.0)] * needed + list(zip(progress.sent[0::2], progress.sent[1::2], strict=True))
    return [np.array([pair]) for pair in pairs[-needed:]]
