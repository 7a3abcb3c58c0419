"""Our own learner in minutes: the paper's task at one speed. The robot drives back by itself and is never put anywhere.

Two methods, apart: the kinematic form is given and its numbers are not, or nothing is given. Rows named `ceiling` are
what the best controller reaches on that robot; `on common starts` compares mean times where both arrive; `mirror` says
100 where the learner took left to mirror right, else 0.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from components.learner.perceptual import Planning
from docking.task import Task
from experiments import minutes_comparison as comparison
from experiments import minutes_picture as pictures
from experiments.campaign import Job, Options
from experiments.ceiling import problem_of as ceiling_problem
from experiments.minutes_picture import CEILING, COMMON, MIRROR
from experiments.minutes_scoring import drives, grid_policy_times
from experiments.minutes_training import Lesson, Trainee
from experiments.problem import GRIPPER_M, Problem, action_set
from experiments.reach_avoid import solve
from experiments.robot import ROBOTS
from experiments.rows import Row
from experiments.scoring import Label, rows_of
from experiments.starts import protocol_starts

NAME = "minutes"
SEEDS = 20
GIVEN, LEARNED = "structure-given", "structure-learned"
Case = tuple[str, str, str, tuple[float, ...]]
"""Action set, robot, method, robot minutes at which is looked."""
CASES: Sequence[Case] = (
    ("one-speed", "as built", GIVEN, (0.25, 0.5, 1.0, 2.0, 3.0)),
    ("one-speed", "as built", LEARNED, (0.5, 1.0, 2.0, 3.0)),
    ("one-speed", "noisy percepts", GIVEN, (0.25, 0.5, 1.0, 2.0, 3.0)),
    ("one-speed", "noisy percepts", LEARNED, (0.5, 1.0, 2.0, 3.0)),
)
CHANGED = " in mid-session"
"""Ends the name of a robot that is as built for the first `MINUTES_BEFORE`."""
MINUTES_BEFORE = 5.0
_D_SHARE, _D_SHARE_REVERSE = 0.0535, 0.107
"""Spacing of the plan's nodes in d, as a share of the goal's: 1.5 and 3 cm. Finer ones drive faster (1.02 instead of
1.05 of the least time at two speeds), but where a robot can drive backwards it shuttles on them."""
Times = NDArray[np.float64]


def jobs(options: Options) -> Sequence[Job]:
    """One for each case and seed, and who is compared."""
    return [*jobs_of(CASES, options), *comparison.jobs(options)]


def jobs_of(cases: Sequence[Case], options: Options) -> Sequence[Job]:
    """The jobs of some cases."""
    return [
        {
            "actions": actions,
            "robot": robot,
            "method": method,
            "minutes": ",".join(f"{m:g}" for m in ((options.minutes,) if options.minutes else minutes)),
            "goal": options.goal,
            "seed": seed,
            "policies": options.policies,
        }
        for seed in options.seeds_or(SEEDS)
        for actions, robot, method, minutes in cases
    ]


def run(job: Job) -> Sequence[Row]:
    """Train, then drive from all starts, beside the best that this robot can do."""
    return comparison.run(job) if job["method"] in comparison.NAMES else list(_lessons(job))


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """The table of shares, the curves beside those who are compared, and each seed."""
    worst = pictures.worst_seed(rows, f"{LEARNED}: one-speed, noisy percepts, cell", 1.0)
    shown = [] if worst is None else [_failure(worst, folder)]
    return [*pictures.draw(rows, folder), pictures.curves(rows, folder), *shown]


def _failure(seed: int, folder: Path) -> Path:
    """Where the least sure of all lessons fails: one minute, no form, noise; of the seeds the worst."""
    (job,) = jobs_of([("one-speed", "noisy percepts", LEARNED, (1.0,))], Options(seeds=(seed,)))
    robot, problem, rng = ROBOTS[str(job["robot"])], problem_of(job), np.random.default_rng([seed, 7])
    (lesson,) = trainee_of(job).lessons((1.0,))
    driven = drives(lesson.policy, robot, problem, protocol_starts(), rng)
    reachable = np.isfinite(ceiling_times("one-speed", "noisy percepts", "cell"))
    return pictures.failure(list(driven), reachable, folder)


def _lessons(job: Job) -> Iterator[Row]:
    actions, goal, seed = str(job["actions"]), str(job["goal"]), int(job["seed"] or 0)
    name = str(job["robot"]).removesuffix(CHANGED)
    best = ceiling_times(actions, name, goal)
    began = time.process_time()
    for lesson in trainee_of(job).lessons(_minutes(job)):
        core_s = time.process_time() - began
        times = lesson_times(job, lesson)
        yield from _rows(job, lesson, times, best, 60.0 * lesson.minutes / max(core_s, 1e-9))
    _export(job, lesson, seed)


def problem_of(job: Job) -> Problem:
    """What is to be learned."""
    task = Task()
    return Problem(actions=action_set(str(job["actions"]), task.speed_mps, task.turn_rate_radps), goal=str(job["goal"]))


def trainee_of(job: Job) -> Trainee:
    """The robot of a job, from its first minute on, or changed after its first minutes."""
    name, seed = str(job["robot"]), int(job["seed"] or 0)
    d_share = _D_SHARE_REVERSE if job["actions"] == "reverse" else _D_SHARE
    planning = Planning(method=str(job["method"]), d_share=d_share)
    if not name.endswith(CHANGED):
        return Trainee(ROBOTS[name], problem_of(job), planning, seed)
    trainee = Trainee(ROBOTS["as built"], problem_of(job), planning, seed)
    for _ in trainee.lessons((MINUTES_BEFORE,)):
        trainee.change(ROBOTS[name.removesuffix(CHANGED)])
    return trainee


def lesson_times(job: Job, lesson: Lesson) -> Times:
    """Docking times over the protocol's starts."""
    robot = ROBOTS[str(job["robot"]).removesuffix(CHANGED)]
    rng = np.random.default_rng([int(job["seed"] or 0), 7])
    return grid_policy_times(lesson.policy, robot, problem_of(job), protocol_starts(), rng)


def job_name(job: Job) -> str:
    """The experiment that a job belongs to."""
    if str(job["robot"]).endswith(CHANGED):
        return "minutes-mid-session"
    if job["robot"] not in ("as built", "noisy percepts"):
        return "minutes-changed"
    return {"two-speeds": "minutes-two-speeds", "reverse": "minutes-reverse"}.get(str(job["actions"]), NAME)


@cache
def ceiling_times(actions: str, robot: str, goal: str) -> Times:
    """Docking times of the best controller on a robot, over the protocol's starts, the delay of commands included."""
    task = Task()
    job: Job = {
        "plant": "geometric",
        "actions": actions,
        "goal": goal,
        "gripper_m": GRIPPER_M,
        "speed_mps": task.speed_mps,
        "turn_rate_radps": task.turn_rate_radps * ROBOTS[robot].turn_gain,
        "delay_samples": 0,
    }
    commanded = action_set(actions, task.speed_mps, task.turn_rate_radps)
    starts, problem = protocol_starts(), ceiling_problem(job)
    ceiling = solve(replace(problem, actions=ROBOTS[robot].actions(commanded)))
    times = ceiling.time_s(starts.beta_rad, starts.alpha_rad, starts.d_m)
    return times + ROBOTS[robot].delay_samples * problem.sampling_s


def _minutes(job: Job) -> tuple[float, ...]:
    before = MINUTES_BEFORE if str(job["robot"]).endswith(CHANGED) else 0.0
    return tuple(before + float(minutes) for minutes in str(job["minutes"]).split(","))


def _rows(job: Job, lesson: Lesson, times: Times, best: Times, speed: float) -> Iterator[Row]:
    """The learner's rows, the ceiling's, their times on common starts, and whether left mirrors right."""
    what = f"{job['actions']}, {job['robot']}, {job['goal']}"
    learned = Label(job_name(job), "geometric", f"{job['method']}: {what}", int(job["seed"] or 0), lesson.minutes)
    for row in rows_of(learned, times, 0.0):
        yield replace(row, robot_seconds_per_core_second=speed)
    ceiling = replace(learned, controller=f"{CEILING}: {what}")
    yield from rows_of(ceiling, best, 0.0)
    both = np.isfinite(times) & np.isfinite(best)
    for controller, measured in (
        (learned.controller, times),
        (learned.controller.replace(":", f" {CEILING}:", 1), best),
    ):
        masked = np.where(both, measured, np.inf)
        yield rows_of(replace(learned, controller=controller + COMMON), masked, 0.0)[0]
    mirrored = np.zeros(5) if "not mirrored" not in lesson.structure else np.full(5, np.inf)
    mirror = rows_of(replace(learned, controller=learned.controller + MIRROR), mirrored, 0.0)[0]
    yield replace(mirror, docking_time_s=None)


def _export(job: Job, lesson: Lesson, seed: int) -> None:
    if job["policies"] is None:
        return
    folder = Path(str(job["policies"]))
    folder.mkdir(parents=True, exist_ok=True)
    words = [job_name(job), *(str(job[key]) for key in ("method", "actions", "robot", "goal")), str(seed)]
    (folder / f"{'-'.join(words).replace(' ', '_')}.policy").write_bytes(lesson.policy.to_bytes())
