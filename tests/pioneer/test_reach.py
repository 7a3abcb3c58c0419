"""Where a camera can not look, the task can not be done: it is refused before anything starts, and never collides."""

import math

import pytest

from components.head import canon, visca
from components.head.ports import _TILTS
from runtime.launch import load
from runtime.lockstep import Lockstep
from runtime.params import ConfigurationError
from schemas.trial_pb2 import Trial
from tests.pioneer.session import LAUNCH
from tests.recorded_session import LAUNCH as SIMULATION


def launched(folder, *changes, overrides=()):
    text = LAUNCH.read_text(encoding="utf-8")
    for before, after in changes:
        assert before in text
        text = text.replace(before, after)
    file = folder / "robot.toml"
    file.write_text(text, encoding="utf-8")
    return load(file, overrides)


def test_the_ranges_are_those_of_the_protocols():
    for kind, scale in (("canon-vc-c4", canon.TILT), ("sony-evi-d30", visca.TILT)):
        ends = [math.degrees(scale.angle_rad(steps)) for steps in (scale.low, scale.high)]
        assert ends == pytest.approx(_TILTS[kind], abs=0.1)


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("canon-vc-c4", "sony-evi-d30", r"task\.goal_tilt_rad, 57\.5 deg; sony-evi-d30, hanging, .* to 25\.0$"),
        (", inverted = true", "", r"task\.goal_tilt_rad, 57\.5 deg; canon-vc-c4, upright, .* to 30\.0$"),
    ],
)
def test_a_camera_that_can_not_look_at_the_pick_up_is_refused(tmp_path, before, after, words):
    with pytest.raises(ConfigurationError, match=r"robot\.toml: head\.device must reach " + words):
        launched(tmp_path, (before, after))


def test_starts_above_its_range_are_refused_too(tmp_path):
    with pytest.raises(ConfigurationError, match=r"task\.start_tilt_min_rad, 5\.7 deg"):
        launched(tmp_path, overrides=["head.tilt_low_rad=0.2", "task.start_tilt_min_rad=0.1"])


def test_with_a_goal_within_its_range_it_is_taken(tmp_path):
    goal = ["task.goal_tilt_rad=0.40", "task.tilt_limit_rad=0.43"]
    system = launched(tmp_path, ("canon-vc-c4", "sony-evi-d30"), overrides=goal)
    assert system.component("head").device["kind"] == "sony-evi-d30"


def test_a_head_that_ends_at_25_deg_loses_the_object_and_the_robot_stands():
    settings = ["pilot.train_s=0", "pilot.evaluation_trials=1", "pilot.evaluation_controller=lc", "pilot.lost_s=4"]
    parts = ("simulator", "vision", "head", "tracker", "pilot", "grasper", "base")
    engine = Lockstep(load(SIMULATION, [*settings, "head.tilt_high_rad=0.436"], only=parts))
    outcomes, truths = set(), []
    engine.watch("pilot/trial", lambda trial, _: outcomes.add(trial.outcome))
    engine.watch("simulator/truth", lambda truth, _: truths.append(truth))
    assert engine.run(60.0) == "finished"
    assert outcomes == {Trial.NONE, Trial.LOST}
    assert not any(truth.collided for truth in truths)
    assert truths[-1].v_mps == 0.0
    assert truths[-1].d_axle_m > 0.4
