"""What a player waits for that stands in for somebody in lockstep."""

import pytest

from runtime.answers import Answers, stands
from runtime.contract import ComponentError
from runtime.launch import load


@pytest.fixture
def table(tmp_path):
    def make(replaced):
        system = load("launch/sim.toml", recording=tmp_path / "x.mcap")
        specs = [spec for spec in system.components if spec.name in replaced]
        running = {key for spec in system.components if spec.name not in replaced for key in spec.outputs.values()}
        return stands(specs, running)

    return make


def test_the_worlds_next_frame_follows_all_answers_to_the_last_one(table):
    answers = Answers(table({"simulator"}))
    assert answers.keys == {"base/actuate", "head/actuate", "pilot/trial"}
    answers.hear_time(0)
    assert not answers.missing("camera/image", 0)
    answers.show("camera/image", 0)
    assert not answers.missing("simulator/head", 0)  # of the same frame
    for key in sorted(answers.keys):
        assert answers.missing("camera/image", 125)
        answers.hear(key, 0)
    assert not answers.missing("camera/image", 125)


def test_what_answers_a_frame_waits_for_that_frame(table):
    answers = Answers(table({"vision"}))
    assert answers.keys == {"camera/image"}
    assert answers.missing("vision/view", 0) == "camera/image"
    answers.hear("camera/image", 0)
    assert not answers.missing("vision/view", 0)
    assert answers.missing("vision/view", 125)


def test_nobody_waits_for_who_is_replaced_too(table):
    answers = Answers(table({"simulator", "base", "head", "pilot"}))
    answers.hear_time(0)
    answers.show("camera/image", 0)
    assert not answers.missing("camera/image", 10**9)


def test_an_output_waits_only_for_what_can_cause_it(table):
    answers = Answers(table({"head"}))
    assert answers.missing("head/state", 0) == "simulator/head"
    assert answers.missing("head/actuate", 0) == "tracker/aim"
    answers.hear("simulator/head", 0)
    assert not answers.missing("head/state", 0)  # the tracker aims by it


def test_the_first_frame_waits_until_the_systems_time_is_known_and_never_lies_before_it(table):
    answers = Answers(table({"simulator"}))
    assert answers.missing("camera/image", 125) == "*/status"
    answers.hear_time(0)
    assert not answers.missing("camera/image", 125)
    answers.hear_time(10**9)
    with pytest.raises(ComponentError, match=r"is at 1\.000 s and can not go back to 0\.000 s"):
        answers.missing("camera/image", 125)


def test_who_comes_too_late_for_a_frame_learns_of_it_from_a_status(table):
    answers = Answers(table({"vision"}), {"camera/image"})
    answers.hear_time(125)
    assert not answers.missing("vision/view", 125)
    assert answers.missing("vision/view", 250) == "camera/image"
