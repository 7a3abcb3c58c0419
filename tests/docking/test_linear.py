from __future__ import annotations

import numpy as np
import pytest

from docking.angles import DEG
from docking.cells import Grid
from docking.linear import BEST_TUNED, HAND_TUNED, Linear, teacher_action, teacher_table
from docking.task import Task

TASK = Task()
GRID = Grid.of(TASK)
LAW = Linear(*BEST_TUNED, TASK.turn_rate_radps)


def test_the_law_is_the_weighted_sum_inside_its_limits():
    assert LAW.omega_radps(0.02, 0.03) == pytest.approx(2.25 * 0.02 + 1.5 * 0.03)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_the_law_saturates_at_the_turn_rate(sign):
    assert LAW.omega_radps(sign, sign) == sign * 10 * DEG


def test_the_teacher_answers_the_same_everywhere_in_a_cell_and_turns_as_the_law_does_at_its_centre():
    for cell in range(GRID.count):
        omega = TASK.actions[teacher_action(LAW, GRID, cell, TASK.actions)][1]
        if cell != GRID.goal:
            assert omega * LAW.omega_radps(*GRID.centre(cell)) > 0.0


@pytest.mark.parametrize("gains", [BEST_TUNED, HAND_TUNED, (-1.5, 1.0), (16.0, -13.0), (0.0, 1.0)])
def test_mirroring_a_cell_mirrors_the_teacher_even_where_it_is_undecided(gains):
    table = teacher_table(Linear(*gains, TASK.turn_rate_radps), GRID, TASK.actions)
    differs = table == table[::-1]
    differs[GRID.goal] = False
    assert not differs.any()


def test_of_several_speeds_and_rates_the_nearest_rate_and_then_the_faster_speed_is_taken():
    actions = tuple((v, omega) for v in (0.05, 0.1) for omega in (-0.2, 0.0, 0.2))
    assert actions[teacher_action(Linear(1.0, 1.0, 0.2), GRID, GRID.count - 1, actions)] == (0.1, 0.2)
    assert actions[teacher_action(Linear(0.0, 0.0, 0.2), GRID, 0, actions)] == (0.1, 0.0)


def test_the_table_holds_every_cell():
    table = teacher_table(LAW, GRID, TASK.actions)
    assert table.shape == (961,)
    assert table.dtype == np.int8
