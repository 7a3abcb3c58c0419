"""The whole system docks and picks up through the robot's protocol, in lockstep."""

import pytest

from benchmarks.pioneer import evaluate_serially

PICKED_DIRECTLY = (0, 2)
"""Starts from which the linear law picks up in the simulation without a line; from 1 and 3 it does not."""


@pytest.mark.parametrize("start", PICKED_DIRECTLY)
def test_through_the_serial_protocol_it_docks_and_picks_up(start):
    (trial,) = evaluate_serially(("pilot.evaluation_controller=lc",), start, 1)
    assert trial.docked
    assert trial.picked
    assert not trial.collided
