"""The whole system docks and picks up through a ROS 2 base's messages, in lockstep, in both bridges' formats."""

import pytest

from benchmarks.pioneer import evaluate_in
from benchmarks.ros2 import WORLD

PICKED_DIRECTLY = 0
"""A start from which the linear law picks up in the simulation without messages between."""


@pytest.mark.parametrize("bridge", ["ros2dds", "rmw_zenoh"])
def test_through_ros_2_messages_it_docks_and_picks_up(bridge):
    settings = ("pilot.evaluation_controller=lc", f"simulator.bridge={bridge}")
    (trial,) = evaluate_in(WORLD, settings, PICKED_DIRECTLY, 1)
    assert trial.docked
    assert trial.picked
    assert not trial.collided
