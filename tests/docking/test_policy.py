from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from docking.arrays import MAGIC, pack, unpack
from docking.cells import Grid
from docking.linear import BEST_TUNED, Linear, teacher_table
from docking.policy import UNKNOWN, PolicyTable, mirrored_actions
from docking.task import Task

TASK = Task()
GRID = Grid.of(TASK)


def teacher_policy() -> PolicyTable:
    action = teacher_table(Linear(*BEST_TUNED, TASK.turn_rate_radps), GRID, TASK.actions)
    action[3] = action[957] = UNKNOWN
    return PolicyTable(GRID, action, np.linspace(-1.0, 1.0, GRID.count), TASK.actions, 7, "lc", 12, b"\x01\xff")


def test_the_action_is_that_of_the_cell_the_state_is_in():
    table = teacher_policy()
    for cell in range(GRID.count):
        expected = None if table.action[cell] == UNKNOWN else int(table.action[cell])
        assert table.act(*GRID.centre(cell)) == expected


@pytest.mark.parametrize("state", [(2.0, 0.0), (0.0, -3.0), (math.nan, 0.0), (0.0, math.inf), (-1e308, 1e308)])
def test_outside_the_cells_there_is_no_action(state):
    assert teacher_policy().act(*state) is None


def test_a_mirrored_table_has_no_mirror_faults_and_one_changed_pair_has_two():
    table = teacher_policy()
    assert table.mirror_faults == 0
    action = table.action.copy()
    action[100] = 1 - action[100]
    assert dataclasses.replace(table, action=action).mirror_faults == 2
    assert table.known == GRID.count - 2


def test_mirroring_swaps_left_and_right_and_needs_both():
    assert mirrored_actions(((0.1, 0.2), (0.1, -0.2), (0.1, 0.0))) == (1, 0, 2)
    with pytest.raises(ValueError, match="mirror image"):
        mirrored_actions(((0.1, 0.2),))


def test_bytes_give_the_same_table_back_and_the_same_bytes():
    table = teacher_policy()
    again = PolicyTable.from_bytes(table.to_bytes())
    assert again.to_bytes() == table.to_bytes()
    np.testing.assert_array_equal(again.action, table.action)
    np.testing.assert_array_equal(again.value, table.value)
    assert (again.grid, again.actions, again.version, again.method) == (table.grid, table.actions, 7, "lc")
    assert (again.transitions, again.table_sha256) == (12, b"\x01\xff")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"action": np.zeros(5, dtype=np.int8)}, "961 entries"),
        ({"action": np.full(961, 2, dtype=np.int8)}, r"-1\.\.1"),
        ({"action": np.zeros(961, dtype=np.int64)}, "int8"),
        ({"value": np.full(961, np.nan)}, "finite"),
        ({"actions": ((math.nan, 0.0), (0.1, 0.1))}, "finite"),
        ({"actions": ()}, "actions"),
        ({"version": -1}, "version"),
        ({"grid": Grid(math.nan, 1.0, 31, 31)}, "ranges"),
        ({"grid": Grid(1.0, 1.0, 30, 31)}, "odd"),
        ({"grid": Grid(1.0, 1.0, 10**9 + 1, 31)}, "odd"),
    ],
)
def test_a_table_that_does_not_fit_together_is_refused_by_name(change, words):
    with pytest.raises(ValueError, match=words):
        dataclasses.replace(teacher_policy(), **change)


@pytest.mark.parametrize("header", [{}, {"beta_range_rad": "x"}, {"beta_range_rad": 1, "alpha_range_rad": [1]}])
def test_a_header_that_says_too_little_is_refused(header):
    with pytest.raises(ValueError, match=r"policy|could not convert"):
        PolicyTable.from_bytes(pack("policy", header, {"action": np.zeros(9, np.int8), "value": np.zeros(9)}))


@settings(max_examples=200, deadline=None)
@given(st.integers(0, 4000), st.integers(1, 255))
def test_a_flipped_byte_is_found(place, flip):
    data = bytearray(teacher_policy().to_bytes())
    data[place] ^= flip
    with pytest.raises(ValueError, match=r"Berth|damaged|at most"):
        PolicyTable.from_bytes(bytes(data))


@given(st.binary(max_size=300))
def test_other_bytes_are_refused(data):
    with pytest.raises(ValueError, match="policy"):
        PolicyTable.from_bytes(MAGIC + data)


def test_a_hostile_length_costs_nothing():
    good = pack("policy", {}, {"a": np.zeros(2)})
    with pytest.raises(ValueError, match="expected a snapshot"):
        unpack(good, "snapshot")
    import hashlib  # noqa: PLC0415

    text = b'{"kind": "policy", "header": {}, "arrays": [["a", "<f8", [1000000000000]]]}'
    body = MAGIC + len(text).to_bytes(4, "little") + text
    with pytest.raises(ValueError, match="longer than the data"):
        unpack(body + hashlib.sha256(body).digest(), "policy")
