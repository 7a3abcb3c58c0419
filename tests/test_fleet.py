"""Four robots, whole systems with cameras, and one learner on one bus: `launch/fleet.toml`."""

from pathlib import Path

import numpy as np
import pytest

from components.pilot.messages import table_of
from experiments.fleet_training import drawn
from runtime.launch import load
from runtime.lockstep import Lockstep

LAUNCH = Path(__file__).parent.parent / "launch" / "fleet.toml"
ROBOTS = ("", "_2", "_3", "_4")


@pytest.fixture(scope="module")
def session():
    """Newest policy, its version as the pilot has it, and frames: of each robot, after twenty seconds.

    At one speed: with reverse a plan takes longer.
    """
    engine = Lockstep(load(LAUNCH, ["task.action_set=one-speed"]))
    policies, versions, frames = {}, dict.fromkeys(ROBOTS, 0), dict.fromkeys(ROBOTS, 0)
    for robot in ROBOTS:

        def keep(policy, _, robot=robot):
            policies[robot] = policy

        def take(trial, _, robot=robot):
            frames[robot] += 1
            versions[robot] = trial.policy_version

        engine.watch(f"learner/policy{robot}", keep)
        engine.watch(f"pilot{robot}/trial", take)
    engine.run(20.0)
    return policies, versions, frames


def test_their_worlds_wait_for_one_another(session):
    _, _, frames = session
    assert len(set(frames.values())) == 1


def test_each_drives_by_a_policy_of_its_own(session):
    policies, versions, _ = session
    assert versions == {robot: policies[robot].version for robot in ROBOTS}
    assert len(set(versions.values())) == len(ROBOTS)


def test_each_policy_knows_by_how_much_its_robot_turns_faster_or_slower(session):
    policies, _, _ = session
    far, turn = np.array([[0.0, 0.0, 1.5]]), np.array([[0.0, 1.0]])
    found = [-table_of(policies[robot]).fine.model.rates(far, turn)[0, 1] for robot in ROBOTS]
    assert found == pytest.approx([build.turn for build in drawn()], rel=0.05)
