"""Four robots, whole systems with cameras, and one learner on one bus: `launch/fleet.toml`."""

from pathlib import Path

from runtime.launch import load
from runtime.lockstep import Lockstep

LAUNCH = Path(__file__).parent.parent / "launch" / "fleet.toml"
ROBOTS = ("", "_2", "_3", "_4")


def test_what_four_robots_have_seen_in_twenty_seconds_all_of_them_drive_by():
    engine = Lockstep(load(LAUNCH))
    policies, versions, frames = [], dict.fromkeys(ROBOTS, 0), dict.fromkeys(ROBOTS, 0)
    engine.watch("learner/policy", lambda policy, _: policies.append(policy))
    for robot in ROBOTS:

        def take(trial, _, robot=robot):
            frames[robot] += 1
            versions[robot] = trial.policy_version

        engine.watch(f"pilot{robot}/trial", take)
    engine.run(20.0)
    assert len(set(frames.values())) == 1, "their worlds wait for one another"
    assert policies[0].transitions > 160, "more than one robot can have seen"
    assert set(versions.values()) == {policies[-1].version}
