"""A kinematic robot on a bus of plain messages: what the learner hears of a random-action session."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from docking import plant
from docking.cells import SINK, Grid
from docking.task import Task
from runtime.contract import Event
from schemas.drive_pb2 import Applied
from schemas.percept_pb2 import Percept
from schemas.trial_pb2 import Trial

PERIOD_NS = 125_000_000
CAMERA_HEIGHT_M = 0.45


def session(
    task: Task, trials: int, seed: int = 0, noise_rad: float = 0.0, delay: int = 0, resting: int = 3
) -> Iterator[tuple[Event, Event, Event]]:
    """Per frame: percept, trial and applied event. Trials end at the goal cell, outside the ranges or at the limit.

    Args:
        task: the task.
        trials: number of them.
        seed: of starts, actions and noise.
        noise_rad: standard deviation of perceived beta and alpha.
        delay: frames until a command moves the robot.
        resting: frames of reverse between two trials.
    """
    rng = np.random.default_rng([seed, 1])
    k = 0
    for number in range(trials):
        for frame in _trial(task, rng, noise_rad, delay):
            yield _events(task, k, number, Trial.APPROACH, *frame)
            k += 1
        for _ in range(resting):
            yield _events(task, k, number, Trial.REVERSE, 0.1, 0.1, 1.0, (-0.2, 0.0))
            k += 1


def _trial(task: Task, rng: np.random.Generator, noise_rad: float, delay: int) -> Iterator[tuple]:
    grid = Grid.of(task)
    low, high = (-task.beta_range_rad, -task.alpha_range_rad, 1.0), (task.beta_range_rad, task.alpha_range_rad, 2.0)
    beta, alpha, d = rng.uniform(low, high)
    x, y, heading = plant.pose(beta, alpha, d)
    held, action, commands = -1, (0.0, 0.0), [(0.0, 0.0)] * delay
    while True:
        beta, alpha, d = plant.observe(x, y, heading)
        seen_beta, seen_alpha = np.array([beta, alpha]) + noise_rad * rng.standard_normal(2)
        cell = grid.cell(seen_beta, seen_alpha)
        over = cell in (SINK, grid.goal) or math.atan2(CAMERA_HEIGHT_M, d) > task.tilt_limit_rad
        if over:
            action = (0.0, 0.0)
        elif cell != held:
            held, action = cell, task.actions[rng.integers(len(task.actions))]
        yield seen_beta, seen_alpha, d, action
        if over:
            return
        commands.append(action)
        x, y, heading = plant.advance(x, y, heading, *commands.pop(0), PERIOD_NS * 1e-9)


def _events(
    task: Task, k: int, number: int, mode: int, beta: float, alpha: float, d: float, action: tuple[float, float]
) -> tuple[Event, Event, Event]:
    time_ns = k * PERIOD_NS
    tilt = math.atan2(CAMERA_HEIGHT_M, d)
    percept = Percept(visible=True, slope=math.tan(beta) * math.sin(tilt), pan_rad=alpha, tilt_rad=tilt)
    trial = Trial(phase=Trial.TRAIN, mode=mode, number=number, ended=number, began_ns=number + 1)
    applied = Applied(v_mps=action[0], omega_radps=action[1], commander="pilot")
    messages = {"percept": percept, "trial": trial, "applied": applied}
    percept_event, trial_event, applied_event = (
        Event(time_ns, port, message, time_ns, 1, k) for port, message in messages.items()
    )
    return percept_event, trial_event, applied_event
