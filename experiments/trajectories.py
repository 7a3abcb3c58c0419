"""Fig. 6 of the paper: trajectories of the linear law, of what was learned, and of the optimum, side by side.

Also maps of their actions and docking times over (beta, alpha).
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from docking.angles import DEG
from docking.cells import Grid
from docking.levels import judge
from docking.linear import Linear, teacher_table
from docking.policy import UNKNOWN
from experiments.campaign import Job, Options
from experiments.controller import Controller, docking_times, trace
from experiments.laws import linear, tabled
from experiments.learners import BEST, LEARNERS, TEACHER
from experiments.picture import picture
from experiments.problem import Floats, Problem
from experiments.reach_avoid import solve
from experiments.rows import Row
from experiments.scoring import Label, rows_of
from experiments.starts import Starts, protocol_starts
from experiments.training import Training

NAME = "trajectories"
LEARNER, OPTIMUM = "RL-LC", "optimum"
_MINUTES = 60.0
_SHOWN_M = 1.5
_SHOWN_DEG = ((-50, -10), (-35, 25), (-20, -40), (0, 35), (15, -5), (30, 45), (40, -20), (55, 20))
"""(beta, alpha) of the starts that are drawn."""
_LATEST_S = 20.0
"""End of the colour scale."""


def jobs(options: Options) -> Sequence[Job]:
    """One for each seed; the first is drawn."""
    minutes = _MINUTES if options.minutes is None else options.minutes
    return [
        {"plant": "geometric", "seed": seed, "minutes": minutes, "noise": options.plant_noise}
        for seed in options.seeds_or(1)
    ]


def run(job: Job) -> Sequence[Row]:
    """Shares and docking times of what is drawn, over the protocol's starts."""
    began = time.process_time()
    seed, minutes = int(job["seed"] or 0), float(job["minutes"] or 0.0)
    problem = Problem(plant=str(job["plant"]))
    shown = controllers(problem, seed, minutes, float(job["noise"] or 0.0))
    rows = []
    for name, controller in shown.items():
        times = docking_times(controller, protocol_starts(), problem)
        learned = (seed, minutes) if name == LEARNER else (None, None)
        rows += rows_of(Label(NAME, problem.plant, name, *learned), times, time.process_time() - began)
    return rows


def controllers(problem: Problem, seed: int, minutes: float, plant_noise: float = 0.0) -> Mapping[str, Controller]:
    """The best-tuned linear law, the learner after so many robot minutes, the optimum."""
    task, learner = problem.task, LEARNERS[LEARNER]
    training = Training(task, learner.settings, learner.protocol(problem.plant, plant_noise), seed)
    (checkpoint,) = training.checkpoints((minutes,))
    teacher = teacher_table(Linear(*TEACHER[problem.plant], task.turn_rate_radps), Grid.of(task), task.actions)
    learned = checkpoint.policy.action
    return {
        "LC, best-tuned": linear(Linear(*BEST[problem.plant], task.turn_rate_radps), task.speed_mps),
        LEARNER: tabled(np.where(learned == UNKNOWN, teacher, learned).astype(np.int8), task),
        OPTIMUM: solve(problem).act,
    }


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """Trajectories and maps of the first seed."""
    learned = next(row for row in rows if row.controller == LEARNER)
    problem = Problem(plant=learned.plant)
    shown = controllers(problem, learned.seed or 0, learned.robot_minutes or 0.0)
    beta, alpha = DEG * np.array(_SHOWN_DEG, dtype=np.float64).T
    starts = Starts(beta, alpha, np.full_like(beta, _SHOWN_M))

    def paint_paths(axes: list[Axes]) -> None:
        for i, (name, controller) in enumerate(shown.items()):
            paths = trace(controller, starts, problem)
            reached = [bool(judge(problem.limits, path[-1:])[0] == 1) for path in paths]
            _plan(axes[i], paths, reached)
            _plane(axes[i + len(shown)], paths, reached, problem)
            axes[i].set_title(f"{name}: {sum(reached)} of {len(paths)}")

    def paint_maps(axes: list[Axes]) -> None:
        for i, (name, controller) in enumerate(shown.items()):
            _maps(axes[i], axes[i + len(shown)], controller, problem, only_reached=name == OPTIMUM)
            axes[i].set_title(f"{name}: left (violet), right")
            axes[i + len(shown)].set_title(f"time from {_SHOWN_M:g} m")

    return [
        picture(folder / "trajectories.png", paint_paths, rows=2, columns=len(shown), heights_in=(2.4, 3.6)),
        picture(folder / "maps.png", paint_maps, rows=2, columns=len(shown), heights_in=(3.2, 3.2)),
    ]


def _plan(axes: Axes, paths: Sequence[Floats], reached: Sequence[bool]) -> None:
    """Plan view in metres: the object on top, the table's normal upwards."""
    for path, good in zip(paths, reached, strict=True):
        beta, _, d = path.T
        right, up = d * np.sin(beta), -d * np.cos(beta)
        (line,) = axes.plot(right, up, alpha=1.0 if good else 0.45)
        axes.plot(right[0], up[0], "o", markersize=4, color=line.get_color())
        axes.plot(right[-1], up[-1], "." if good else "x", color=line.get_color())
    axes.axhline(-0.06, color="tab:orange", linewidth=3)
    axes.plot(0, 0, "o", color="tab:green", markersize=7)
    axes.set(
        xlabel="along the table, m", ylabel="from the object, m", aspect="equal", xlim=(-1.5, 1.5), ylim=(-1.6, 0.1)
    )


def _plane(axes: Axes, paths: Sequence[Floats], reached: Sequence[bool], problem: Problem) -> None:
    """The same over (beta, alpha), with cells and goal."""
    task, limits = problem.task, problem.limits
    for path, good in zip(paths, reached, strict=True):
        (line,) = axes.plot(path[:, 0] / DEG, path[:, 1] / DEG, alpha=1.0 if good else 0.45)
        axes.plot(path[0, 0] / DEG, path[0, 1] / DEG, "o", markersize=4, color=line.get_color())
        axes.plot(path[-1, 0] / DEG, path[-1, 1] / DEG, "." if good else "x", color=line.get_color())
    half = (limits.beta_goal_rad / DEG, limits.alpha_goal_rad / DEG)
    axes.add_patch(Rectangle((-half[0], -half[1]), 2 * half[0], 2 * half[1], facecolor="tab:green", zorder=3))
    ranges = (task.beta_range_rad / DEG, task.alpha_range_rad / DEG)
    axes.set_xticks(np.linspace(-ranges[0], ranges[0], task.beta_cells + 1), minor=True)
    axes.set_yticks(np.linspace(-ranges[1], ranges[1], task.alpha_cells + 1), minor=True)
    axes.grid(visible=True, which="minor", linewidth=0.3, alpha=0.4)
    axes.grid(visible=False, which="major")
    axes.set(xlabel="beta, deg", ylabel="alpha, deg", xlim=(-ranges[0], ranges[0]), ylim=(-ranges[1], ranges[1]))


def _maps(actions: Axes, times: Axes, controller: Controller, problem: Problem, *, only_reached: bool) -> None:
    """What a controller does at each cell's centre, and how long it takes from there; white: it does not arrive.

    Where the optimum does not arrive it has no best action either: `only_reached`.
    """
    task = problem.task
    starts = protocol_starts(task, (_SHOWN_M,))
    shape = (task.beta_cells, task.alpha_cells)
    _, omega = controller(starts.beta_rad, starts.alpha_rad, starts.d_m)
    duration = docking_times(controller, starts, problem)
    lost = ~np.isfinite(duration)
    duration[lost] = np.nan
    omega = np.where(lost, np.nan, omega) if only_reached else omega
    extent = (
        -task.beta_range_rad / DEG,
        task.beta_range_rad / DEG,
        -task.alpha_range_rad / DEG,
        task.alpha_range_rad / DEG,
    )
    turn = task.turn_rate_radps
    actions.imshow(
        omega.reshape(shape).T, origin="lower", extent=extent, aspect="auto", cmap="PuOr", vmin=-turn, vmax=turn
    )
    image = times.imshow(
        duration.reshape(shape).T, origin="lower", extent=extent, aspect="auto", cmap="viridis", vmin=0, vmax=_LATEST_S
    )
    times.figure.colorbar(image, ax=times, label="s")
    for axes in (actions, times):
        axes.grid(visible=False)
        axes.set(xlabel="beta, deg", ylabel="alpha, deg")
