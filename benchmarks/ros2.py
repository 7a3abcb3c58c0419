"""The learned policy through the messages of a ROS 2 base beside the direct simulation, from the same starts.

The emulated robot of the tests stands between base and the simulated wheels, in lockstep: Twist, Odometry, bumper and
battery as CDR, coded on its side by Cyclone DDS's codec. The gripper is the simulator's.
"""

from __future__ import annotations

from benchmarks.evaluation import TRAIN_S, learned_policy
from benchmarks.figure import Figure
from benchmarks.pioneer import compared, evaluate_in
from benchmarks.trials import evaluate

STARTS = 50
WORLD = "tests.ros2.ros_world"


def figures() -> list[Figure]:
    """Train directly, then evaluate the frozen policy directly and through both bridges."""
    settings = (f"pilot.policy={learned_policy(TRAIN_S)}",)
    bridged = {
        f"over {bridge}": evaluate_in(WORLD, (*settings, f"simulator.bridge={bridge}"), 0, STARTS)
        for bridge in ("ros2dds", "rmw_zenoh")
    }
    return compared(evaluate(settings, 0, STARTS), bridged)
