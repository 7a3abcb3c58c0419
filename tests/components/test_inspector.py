"""The inspector finds what is wired wrongly, moves little, and what it proposes puts it right."""

import dataclasses
import math

import pytest

from cli.inspection import inspected
from components.inspector.component import Inspector
from components.inspector.ports import Params
from runtime.contract import Event
from runtime.launch import load
from schemas.drive_pb2 import Applied, BaseState
from schemas.head_pb2 import HeadState
from schemas.view_pb2 import View
from tests.components.inspecting_world import inspect, robot
from tests.recorded_session import LAUNCH

FRAME_NS = 125_000_000
HEAD_AND_WHEELS = {
    "tilt=-1": {"tilt motor"},
    "pan_encoder=-1, tilt_encoder=-57.3, odometry=-1000, heading=-1": {
        "pan encoder",
        "tilt encoder",
        "odometry",
        "heading",
    },
    "pan=-1, pan_encoder=-1, tilt=-1, tilt_encoder=-1, forward=-1, odometry=-1, turn=-1, heading=-1": {
        "pan motor",
        "pan encoder",
        "tilt motor",
        "tilt encoder",
        "drive",
        "odometry",
        "turn",
        "heading",
    },
}
GRIPPER = {
    "lift_reversed=true": {"lift"},
    "fingers_reversed=true": {"fingers"},
    "beams_swapped=true": {"beams' order"},
    "inner_beam_inverted=true": {"inner beam"},
    "lift_reversed=true, fingers_reversed=true, beams_swapped=true, outer_beam_inverted=true": {
        "lift",
        "fingers",
        "beams' order",
        "outer beam",
    },
}


def found_and_put_right(wiring, stage, things):
    found = inspect(robot(wiring, seed=5), stage)
    assert found.result.reason == "finished"
    assert found.wrong == things
    assert found.result.robot_s < 60.0
    assert found.moved_m < 0.05
    assert found.turned_deg < 10.0
    again = inspect(found.right, stage)
    assert (again.result.reason, again.wrong) == ("finished", set())


@pytest.mark.parametrize("wiring", HEAD_AND_WHEELS)
def test_a_fault_of_head_or_wheels_is_found_and_its_correction_passes(wiring):
    found_and_put_right(wiring, "facing", HEAD_AND_WHEELS[wiring])


@pytest.mark.parametrize("wiring", GRIPPER)
def test_a_fault_of_the_gripper_is_found_and_its_correction_passes(wiring):
    found_and_put_right(wiring, "fingertips", GRIPPER[wiring])


def test_nothing_is_wrong_with_a_right_gripper():
    """Every correction above is checked again, so a right head and right wheels are, too."""
    found = inspect(robot(seed=11), "fingertips")
    assert (found.result.reason, found.wrong) == ("finished", set())


def test_unknown_latencies_are_no_fault_of_the_wiring():
    found = inspect(robot("camera_latency_s=0.1, encoder_latency_s=0.1", seed=2), "facing")
    assert (found.result.reason, found.wrong) == ("finished", set())


def test_tuning_finds_latencies_and_pixels_per_degree_and_its_correction_passes():
    camera_s, encoder_s = 0.1, 0.03
    found = inspect(robot(f"camera_latency_s={camera_s}, encoder_latency_s={encoder_s}", seed=3), "head")
    assert found.measured["camera latency"] == pytest.approx(camera_s, abs=0.01)
    assert found.measured["encoder latency"] == pytest.approx(encoder_s, abs=0.01)
    assert found.measured["pixels per degree"] == pytest.approx(math.radians(364.0), rel=0.02)
    assert found.result.robot_s < 60.0
    assert found.turned_deg < 10.0
    assert {"camera latency", "encoder latency"} & inspect(found.right, "head").wrong == set()


def test_tuning_refuses_a_head_that_turns_the_wrong_way():
    found = inspect(robot("pan=-1"), "head")
    assert found.wrong == {"head"}
    assert "check hardware" in found.result.findings[0].words


def test_motors_that_do_not_move_are_not_called_reversed():
    found = inspect(robot("pan=0.001, forward=0.001"), "facing")
    assert found.wrong == {"pan motor", "pan encoder", "drive", "odometry"}
    assert found.right == found.system


@pytest.mark.parametrize("wiring", ["forward=10", "forward=-10, odometry=10", "turn=10"])
def test_a_unit_that_is_wrong_tenfold_ends_the_check_within_millimetres_or_degrees(wiring):
    found = inspect(robot(wiring), "facing")
    assert found.result.findings == []
    assert f"base.{'turn' if 'turn' in wiring else 'speed'}_scale" in found.result.reason
    assert found.moved_m < 0.02
    assert found.turned_deg < 6.0


def changed(system, run, **params):
    return dataclasses.replace(
        system,
        components=tuple(
            dataclasses.replace(spec, params={**spec.params, **params}) if spec.run == run else spec
            for spec in system.components
        ),
    )


def test_without_the_object_the_check_ends_with_one_line():
    found = inspect(changed(robot(), "components.vision", object_pixels_min=100_000), "facing")
    assert found.result.reason == "the object is not in the image (rest)"
    assert found.moved_m == 0.0


def test_a_base_that_does_not_obey_ends_the_check_and_says_why():
    found = inspect(changed(robot(), "components.base", dead_man="always"), "facing")
    assert found.result.reason.startswith("base does not obey: dead-man")
    assert found.moved_m == 0.0


@pytest.fixture
def inspector():
    """(view, head, base, applied) -> the last word of the inspector, or None if it goes on; fed frame by frame."""
    component = Inspector(Params(), 0)
    frames = iter(range(10_000))

    def hand(view=None, head=None, base=None, applied=None):
        now_ns = next(frames) * FRAME_NS
        messages = {"head": head, "base": base, "applied": applied, "view": view}
        said = [
            output
            for port, message in messages.items()
            if message is not None
            for output in component.handle(Event(now_ns, port, message, now_ns))
        ]
        return {output.port: output.message for output in said}

    return hand


def until_the_end(hand, frames=130, **messages):
    said = [hand(**messages) for _ in range(frames)]
    assert all({"aim", "drive", "trial"} <= set(answer) for answer in said), "every view is answered"
    ends = [answer["end"].reason for answer in said if "end" in answer]
    assert len(ends) == 1
    assert (said[-1]["drive"].v_mps, said[-1]["drive"].omega_radps) == (0.0, 0.0)
    return ends[0]


SEEN = View(object_visible=True, object_u_px=5.0, object_v_px=70.0)
OBEYED = Applied(commander="pilot")


def test_encoders_that_can_not_be_read_end_the_check(inspector):
    head = HeadState(pan_rad=math.nan, tilt_rad=math.nan)
    assert "encoders" in until_the_end(inspector, view=SEEN, head=head, base=BaseState(), applied=OBEYED)


@pytest.mark.parametrize(("missing", "word"), [("head", "head says nothing"), ("base", "base says nothing")])
def test_a_silent_head_or_base_ends_the_check(inspector, missing, word):
    messages = {"view": SEEN, "head": HeadState(), "base": BaseState(), "applied": OBEYED}
    assert until_the_end(inspector, **{**messages, missing: None}) == word


def test_the_bumper_ends_the_check(inspector):
    reason = until_the_end(inspector, view=SEEN, head=HeadState(), base=BaseState(bumper=True), applied=OBEYED)
    assert "bumper" in reason


def test_a_head_that_is_not_at_its_zero_is_not_moved(inspector):
    head = HeadState(tilt_rad=0.3)
    assert "at its zero" in until_the_end(inspector, view=SEEN, head=head, base=BaseState(), applied=OBEYED)


@pytest.mark.parametrize(
    ("base", "word"), [(BaseState(lift_up=True), "lift"), (BaseState(lift_down=True, fingers_closed=True), "fingers")]
)
def test_a_gripper_that_is_not_prepared_is_not_moved(base, word):
    component = Inspector(Params(stage="fingertips"), 0)
    component.handle(Event(0, "base", base, 0))
    component.handle(Event(0, "head", HeadState(), 0))
    said = [o for k in range(20) for o in component.handle(Event(k * FRAME_NS, "view", View(), k * FRAME_NS))]
    (end,) = (output.message.reason for output in said if output.port == "end")
    assert word in end
    assert {output.message.v_mps for output in said if output.port == "drive"} == {0.0}
    assert {output.message.gripper for output in said if output.port == "drive"} == {0}


def test_a_view_is_answered_once(inspector):
    component = Inspector(Params(), 0)
    assert component.handle(Event(5, "view", SEEN, 5))
    assert component.handle(Event(6, "view", SEEN, 5)) == ()


@pytest.mark.parametrize("name", ["sim2", "teleop"])
def test_systems_of_two_hosts_and_with_a_person_are_checked_as_well(name):
    """Here, all that the check needs."""
    found = inspect(load(LAUNCH.with_name(f"{name}.toml"), clock="lockstep"), "fingertips")
    assert (found.result.reason, found.wrong) == ("finished", set())


def test_base_and_head_are_the_launch_files_own():
    """What is checked is what will run: only the commander is another one."""
    system = robot()
    made = inspected(system, "facing")
    for name in ("vision", "head", "base"):
        before, after = system.component(name).params, made.component(name).params
        assert {key for key in before if before[key] != after[key]} <= {
            "tilt_low_rad",
            "commanders",
            "begins_with",
            "stop_when_gone",
        }
