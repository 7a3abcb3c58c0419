"""Who our own learner is compared with at one speed: the paper's learner, the tuned linear law, the docking law."""

from __future__ import annotations

import time
from collections.abc import Sequence

from docking.linear import BEST_TUNED, Linear
from docking.task import Task
from experiments.campaign import Job, Options
from experiments.controller import docking_times
from experiments.docking_law import DockingLaw
from experiments.evaluation import World
from experiments.laws import docking, linear
from experiments.learners import LEARNERS, learned_rows
from experiments.problem import GRIPPER_M, Problem
from experiments.rows import Row
from experiments.scoring import Label, rows_of
from experiments.starts import protocol_starts
from experiments.training import Training

PAPER, LINEAR, DOCKING = "RL-LC", "LC, best-tuned", "docking law"
NAMES = (PAPER, LINEAR, DOCKING)
"""The paper's learner; the linear law of the best gains; the law of Park and Kuipers, which knows the metric pose."""
SEEDS = 5
_MINUTES = (1.0, 3.0, 10.0, 30.0, 60.0)


def jobs(options: Options) -> Sequence[Job]:
    """The laws, and the paper's learner where the goal is its own."""
    seeds = options.seeds_or(SEEDS)[:SEEDS] if options.goal == "cell" else ()
    learners: list[Job] = [{"method": PAPER, "goal": options.goal, "seed": seed} for seed in seeds]
    return learners + [{"method": name, "goal": options.goal} for name in (LINEAR, DOCKING)]


def run(job: Job) -> Sequence[Row]:
    """One of them, over the protocol's starts."""
    return _paper(job) if job["method"] == PAPER else _law(job)


def _paper(job: Job) -> list[Row]:
    learner, task, seed = LEARNERS[PAPER], Task(), int(job["seed"] or 0)
    training = Training(task, learner.settings, learner.protocol("geometric"), seed)
    world, starts = World(task, "geometric", 0.0, seed), protocol_starts()
    rows = []
    for checkpoint in training.checkpoints(_MINUTES):
        label = Label("minutes", "geometric", PAPER, seed, checkpoint.minutes)
        rows += learned_rows(label, learner.times_s(world, checkpoint.policy, starts), checkpoint)
    return rows


def _law(job: Job) -> list[Row]:
    task, problem = Task(), Problem(goal=str(job["goal"]))
    began = time.process_time()
    if job["method"] == LINEAR:
        controller = linear(Linear(*BEST_TUNED, task.turn_rate_radps), task.speed_mps)
    else:
        law = DockingLaw(speed_max_mps=task.speed_mps, turn_rate_max_radps=task.turn_rate_radps, constant_speed=True)
        controller = docking(law, GRIPPER_M if problem.goal == "dock" else 0.0)
    times = docking_times(controller, protocol_starts(), problem)
    return rows_of(Label("minutes", problem.plant, str(job["method"])), times, time.process_time() - began)
