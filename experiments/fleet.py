"""Four robots that differ by 10 % and learn in common, beside one of them alone: by all robots' minutes together.

Rows named `ceiling` are the mean of what the best controller of each of these robots reaches. A robot alone is one of
the fleet, by the seed.
"""

from __future__ import annotations

import csv
import statistics
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from components.learner.perceptual import Planning
from docking.grid_policy import GridPolicy
from experiments.campaign import Job, Options
from experiments.files import write_atomically
from experiments.fleet_training import ROBOTS, Fleet, drawn
from experiments.minutes_scoring import grid_policy_times
from experiments.picture import picture
from experiments.problem import Problem
from experiments.reach_avoid import solve
from experiments.robot import ROBOTS as KNOWN
from experiments.robot import Robot
from experiments.rows import Row, select
from experiments.starts import Starts, protocol_starts

NAME = "fleet"
SEEDS = 8
ALONE, TOGETHER = "one robot", "four robots"
CEILING = "ceiling"
CASES = (
    ("structure-learned", "noisy percepts"),
    ("structure-learned", "as built"),
    ("structure-given", "noisy percepts"),
)
"""Method, and the robot whose noise it has."""
MINUTES = (0.25, 0.375, 0.5, 0.625, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0)
"""Of all robots together."""
SHARES = (0.9, 0.95)
"""Of the ceiling that are asked for."""
HEADER = ("case", "share", "seeds", "one_robot_minutes", "four_robots_minutes", "ratio", "worst_four_robots_minutes")
_EVERY = 19
"""Of the protocol's starts, one in so many is driven: 253."""
Times = NDArray[np.float64]


def jobs(options: Options) -> Sequence[Job]:
    """One for each case, seed, and who trains."""
    return [
        {"who": who, "method": method, "percepts": percepts, "goal": options.goal, "seed": seed}
        for seed in options.seeds_or(SEEDS)
        for method, percepts in CASES
        for who in (ALONE, TOGETHER)
    ]


def run(job: Job) -> Sequence[Row]:
    """Train, and at each time drive every robot that trained from all starts, beside the best that it can do."""
    return list(_rows(job))


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """When each reached the share of its ceiling, as a table; shares against robot-minutes, as a picture."""
    path = folder / "fleet-minutes.csv"
    with write_atomically(path) as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows([f"{x:.3g}" if isinstance(x, float) else x for x in line] for line in table(rows))

    def paint(axes: list[Axes]) -> None:
        for panel, case in zip(axes, cases(rows), strict=True):
            for number, who in enumerate((ALONE, TOGETHER)):
                _curve(panel, rows, f"{who}: {case}", f"C{number}")
            panel.axhline(100.0 * SHARES[0], color="k", lw=1.0, ls=":")
            panel.set(
                xlabel="minutes of all robots together", ylabel="share of the ceiling, %", title=case, ylim=(0.0, 100.0)
            )
            panel.legend()

    return [path, picture(folder / "fleet.png", paint, columns=max(1, len(cases(rows))))]


def table(rows: Sequence[Row]) -> Iterator[tuple[str | int | float, ...]]:
    """One line for each case and share, as `HEADER` says: medians of the seeds; inf where it was not reached."""
    for case, share in product(cases(rows), SHARES):
        alone, together = (list(reached(rows, f"{who}: {case}", share).values()) for who in (ALONE, TOGETHER))
        one, four = statistics.median(alone), statistics.median(together)
        yield case, share, len(together), one, four, four / one, max(together)


def reached(rows: Sequence[Row], controller: str, asked: float) -> dict[int, float]:
    """By seed: the first robot-minutes at which this share of the ceiling was reached, and kept from then on."""
    found: dict[int, float] = {}
    for seed in sorted({row.seed or 0 for row in select(rows, controller=controller)}):
        found[seed] = float("inf")
        for minutes, share in reversed(shares(rows, controller, seed)):
            if share < asked:
                break
            found[seed] = minutes
    return found


def shares(rows: Sequence[Row], controller: str, seed: int) -> list[tuple[float, float]]:
    """(robot-minutes, share of the ceiling) in order of time."""
    mine = [row for row in select(rows, controller=controller) if row.seed == seed]
    best = {row.robot_minutes: row for row in select(rows, controller=f"{CEILING}, {controller}") if row.seed == seed}
    pairs = [(row.robot_minutes or 0.0, best[row.robot_minutes].controllable_percent, row) for row in mine]
    return sorted((minutes, row.controllable_percent / ceiling) for minutes, ceiling, row in pairs)


def cases(rows: Sequence[Row]) -> list[str]:
    """Names of the cases, in order."""
    return list(dict.fromkeys(row.controller.partition(": ")[2] for row in rows))


def robots_of(job: Job) -> tuple[Robot, ...]:
    """Who trains."""
    noise = KNOWN[str(job["percepts"])].noise
    fleet = tuple(build.robot(noise) for build in drawn())
    return fleet if job["who"] == TOGETHER else (fleet[int(job["seed"] or 0) % ROBOTS],)


def some_starts() -> Starts:
    """Of all of the protocol's distances."""
    starts = protocol_starts()
    return Starts(starts.beta_rad[::_EVERY], starts.alpha_rad[::_EVERY], starts.d_m[::_EVERY])


@cache
def ceiling_times(robot: Robot, goal: str) -> Times:
    """Docking times of the best controller on a robot without noise, nodes in d twice as coarse as there."""
    problem = Problem(goal=goal, distance_step_m=0.02)
    starts = some_starts()
    best = solve(replace(problem, actions=robot.actions(problem.actions)))
    return best.time_s(starts.beta_rad, starts.alpha_rad, starts.d_m)


def _rows(job: Job) -> Iterator[Row]:
    robots, problem, seed = robots_of(job), Problem(goal=str(job["goal"])), int(job["seed"] or 0)
    fleet = Fleet(robots, problem, Planning(method=str(job["method"])), seed)
    name, starts = f"{job['who']}: {job['method']}, {job['percepts']}, {job['goal']}", some_starts()
    best = np.concatenate([ceiling_times(replace(robot, noise=(0.0, 0.0, 0.0)), problem.goal) for robot in robots])
    began = time.process_time()
    for minutes, policies in fleet.policies(MINUTES):
        speed = 60.0 * minutes / max(time.process_time() - began, 1e-9)
        times = _times(policies, robots, problem, starts, seed)
        yield _row(name, seed, minutes, times, speed)
        yield _row(f"{CEILING}, {name}", seed, minutes, best, None)


def _times(
    policies: Sequence[GridPolicy | None], robots: Sequence[Robot], problem: Problem, starts: Starts, seed: int
) -> Times:
    rng = np.random.default_rng([seed, 7])
    driven = zip(policies, robots, strict=True)
    return np.concatenate([grid_policy_times(policy, robot, problem, starts, rng) for policy, robot in driven])


def _row(name: str, seed: int, minutes: float, times: Times, speed: float | None) -> Row:
    arrived = times[np.isfinite(times)]
    share, mean_s = 100.0 * len(arrived) / len(times), float(arrived.mean()) if len(arrived) else None
    return Row(NAME, "geometric", name, seed, minutes, None, share, mean_s, speed)


def _curve(panel: Axes, rows: Sequence[Row], controller: str, colour: str) -> None:
    seeds = sorted({row.seed or 0 for row in select(rows, controller=controller)})
    lines = [shares(rows, controller, seed) for seed in seeds]
    minutes = [minute for minute, _ in lines[0]]
    percent = 100.0 * np.array([[share for _, share in line] for line in lines])
    panel.plot(minutes, np.median(percent, axis=0), ".-", color=colour, label=controller.split(":", maxsplit=1)[0])
    panel.fill_between(minutes, percent.min(axis=0), percent.max(axis=0), color=colour, alpha=0.15, lw=0)
