"""The reach-avoid set against an independent solver, `hj-reachability` (optional: pip install hj-reachability)."""

from __future__ import annotations

import numpy as np
import pytest

from docking.angles import DEG
from docking.levels import goal_level, sink_level
from docking.task import Task
from experiments.problem import Problem
from experiments.reach_avoid import solve

hj = pytest.importorskip("hj_reachability", reason="optional cross-check: pip install hj-reachability")
jnp = pytest.importorskip("jax.numpy")


class Docking(hj.ControlAndDisturbanceAffineDynamics if hj else object):
    """beta' = (v/d) sin(alpha), alpha' = (v/d) sin(alpha) - omega, d' = -v cos(alpha)."""

    def __init__(self) -> None:
        turn_rate = 10 * DEG
        super().__init__("min", "max", hj.sets.Box(jnp.array([-turn_rate]), jnp.array([turn_rate])),
                         hj.sets.Box(jnp.array([0.0]), jnp.array([0.0])))  # fmt: skip

    def open_loop_dynamics(self, state, time):
        _, alpha, d = state
        sight = 0.1 / d * jnp.sin(alpha)
        return jnp.array([sight, sight, -0.1 * jnp.cos(alpha)])

    def control_jacobian(self, state, time):
        return jnp.array([[0.0], [-1.0], [0.0]])

    def disturbance_jacobian(self, state, time):
        return jnp.zeros((3, 1))


def test_an_independent_solver_finds_the_same_set():
    wide = Task(beta_cells=7, alpha_cells=7)  # a goal that coarse nodes resolve
    problem = Problem(task=wide, angle_step_rad=2.5 * DEG, distance_step_m=0.04, backup_samples=2)
    ceiling = solve(problem, levels=True)
    beta, alpha, d = problem.nodes
    grid = hj.Grid.from_lattice_parameters_and_boundary_conditions(
        hj.sets.Box(np.array([beta[0], alpha[0], d[0]]), np.array([beta[-1], alpha[-1], d[-1]])),
        (len(beta), len(alpha), len(d)),
    )
    nodes = np.asarray(grid.states).reshape(-1, 3)
    shape = grid.shape
    goal = jnp.array([goal_level(problem.limits, *node) for node in nodes]).reshape(shape)
    sink = jnp.array([sink_level(problem.limits, *node) for node in nodes]).reshape(shape)
    settings = hj.SolverSettings.with_accuracy(
        "high",
        hamiltonian_postprocessor=hj.solver.backwards_reachable_tube,
        value_postprocessor=lambda _time, value: jnp.maximum(value, sink),
    )
    value = hj.step(settings, Docking(), grid, 0.0, jnp.maximum(goal, sink), -20.0, progress_bar=False)
    theirs = np.asarray(value).transpose(2, 1, 0) <= 0
    ours = ceiling.levels <= 0
    inside = np.s_[2:, 2:-2, 2:-2]  # they extrapolate at the edge of the ranges
    assert (theirs != ours)[inside].mean() < 0.03
    assert theirs[inside].mean() == pytest.approx(ours[inside].mean(), abs=0.015)
