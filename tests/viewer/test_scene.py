"""The pure core of `berth view`, on recorded sessions and on messages made by hand."""

import math
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest

from docking.plant import observe, pose
from docking.task import Task
from report.frames import Scoreboard
from runtime.recording import Logged, Recording
from schemas.drive_pb2 import Applied
from schemas.image_pb2 import CompressedImage
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import Status
from schemas.trial_pb2 import Trial
from schemas.truth_pb2 import Truth
from schemas.view_pb2 import View
from viewer.camera import Camera
from viewer.course import Course
from viewer.policy_map import LEFT_PX, SIDE_PX, PolicyMap, actions, place
from viewer.processes import Processes
from viewer.rate import Rate
from viewer.room import Room
from viewer.scene import Scene
from viewer.shown import Dots, Lines, Number, Page, Picture, Shown, Word
from viewer.wiring import SCHEMAS, Wiring

RECORDINGS = Path(__file__).parents[2] / "recordings"
FRAME_NS = 125_000_000


def shown_of(file, picture_ns=1):
    recording = Recording(file)
    scene = Scene(recording.launch(), picture_ns=picture_ns)
    return scene, [each for logged in recording.messages() for each in scene.take(logged, logged.capture_ns)]


@pytest.fixture(scope="module")
def docking():
    return shown_of(RECORDINGS / "docking.mcap")


@pytest.fixture(scope="module")
def cut():
    return shown_of(RECORDINGS / "cut.mcap")


def of(shown, entity):
    return [each for each in shown if each.entity == entity]


def test_every_image_is_shown_with_what_vision_found_in_that_very_image(docking):
    messages = list(Recording(RECORDINGS / "docking.mcap").messages(("camera/image", "vision/view")))
    images = {row.capture_ns: row.decoded().data for row in messages if row.topic == "camera/image"}
    views = {row.capture_ns: row.decoded() for row in messages if row.topic == "vision/view"}
    assert {each.time_ns: each.what.data for each in of(docking[1], "camera/image")} == images
    rings = {each.time_ns: each.what.strips for each in of(docking[1], "camera/image/object")}
    assert rings.keys() == images.keys()
    for time_ns, strips in rings.items():
        assert bool(strips) == views[time_ns].object_visible
        if strips:
            u, v = np.mean(strips[0][:-1], axis=0)
            assert (u - 160, v - 120) == pytest.approx((views[time_ns].object_u_px, views[time_ns].object_v_px))


def test_the_edge_is_drawn_through_its_row_at_the_objects_column_with_its_slope():
    camera = Camera(1)
    data = cv2.imencode(".jpg", np.zeros((240, 320, 3), np.uint8))[1].tobytes()
    view = View(object_visible=True, object_u_px=20, edge_visible=True, edge_slope=0.25, edge_v_px=-10)
    camera.view(view, 7)  # heard before its image
    (left, right) = of(camera.image(CompressedImage(data=data), 7, 0), "camera/image/edge")[0].what.strips[0]
    assert (left[0], right[0]) == (0, 320)
    assert (right[1] - left[1]) / 320 == pytest.approx(0.25)
    assert left[1] + 0.25 * 180 == pytest.approx(110)


@pytest.mark.parametrize("slope", [-40.0, -1.5, 0.0, 1e-9, 0.9, 7.0])
@pytest.mark.parametrize("row", [-300, -20, 0, 90, 300])
def test_the_edge_ends_where_the_image_does(slope, row):
    camera = Camera(1)
    data = cv2.imencode(".jpg", np.zeros((240, 320, 3), np.uint8))[1].tobytes()
    camera.view(View(edge_visible=True, edge_slope=slope, edge_v_px=row), 7)
    strips = of(camera.image(CompressedImage(data=data), 7, 0), "camera/image/edge")[0].what.strips
    for u, v in (point for strip in strips for point in strip):
        assert -1e-6 <= u <= 320 + 1e-6
        assert -1e-6 <= v <= 240 + 1e-6
        assert v - 120 - row == pytest.approx(slope * (u - 160), abs=1e-3)
    assert strips or abs(row) == 300


def test_images_are_shown_at_a_bounded_rate_and_no_mark_without_its_image():
    _, shown = shown_of(RECORDINGS / "docking.mcap", picture_ns=8 * FRAME_NS)
    times = [each.time_ns for each in of(shown, "camera/image")]
    assert 20 <= len(times) <= 27  # 24.5 s, one a second
    assert [each.time_ns for each in of(shown, "camera/image/edge")] == times


@pytest.mark.parametrize("data", [b"", b"\xff\xd8", b"no picture at all", b"\xff\xd8" + b"\xff\xe0\0\x02" * 70])
def test_what_is_no_picture_is_not_shown(data):
    assert Camera(1).image(CompressedImage(data=data), 0, 0) == []


def test_the_robot_is_drawn_where_the_truth_says(docking):
    truths = {
        row.capture_ns: row.decoded() for row in Recording(RECORDINGS / "docking.mcap").messages(("simulator/truth",))
    }
    robots = of(docking[1], "plan/robot")
    assert len(robots) == len(truths)
    for each in robots:
        middle, nose = each.what.strips[1]
        truth = truths[each.time_ns]
        assert middle == (truth.x_m, truth.y_m)
        assert math.atan2(nose[1] - middle[1], nose[0] - middle[0]) == pytest.approx(truth.heading_rad)


def test_belief_is_near_the_truth_while_the_object_is_tracked(docking):
    robots = {each.time_ns: each.what.strips[1][0] for each in of(docking[1], "plan/robot")}
    beliefs = {each.time_ns: each.what.strips for each in of(docking[1], "plan/belief")}
    errors = [math.dist(strips[1][0], robots[time_ns]) for time_ns, strips in beliefs.items() if strips]
    assert len(errors) > 100
    assert np.median(errors) < 0.03


@pytest.mark.parametrize("at", [(0.5, -0.3, 1.2), (-0.9, 0.4, 0.7), (0.0, 0.0, 2.0)])
def test_belief_inverts_what_an_ideal_camera_sees(at):
    task = Task()
    room = Room(task, height=0.45, edge=0.05)
    beta_rad, alpha_rad, d_m = at
    x_m, y_m, heading_rad = pose(*at)
    assert observe(x_m, y_m, heading_rad) == pytest.approx(at)
    tilt_rad = math.atan2(0.45, d_m)
    percept = Percept(visible=True, slope=math.tan(beta_rad) * math.sin(tilt_rad), pan_rad=alpha_rad, tilt_rad=tilt_rad)
    assert room.believed(percept) == pytest.approx((x_m, y_m, heading_rad), abs=1e-9)


def test_the_goal_is_straight_ahead_at_the_pick_up():
    x_m, y_m, heading_rad = Room(Task(), height=0.45, edge=0.05).goal
    assert (y_m, heading_rad) == (0.0, 0.0)
    assert -x_m == pytest.approx(0.45 / math.tan(math.radians(57.5)))


@pytest.mark.parametrize(
    "bad", [{"visible": False}, {"slope": math.nan}, {"pan_rad": math.inf}, {"tilt_rad": -math.inf}]
)
def test_a_percept_that_says_nothing_places_nobody(bad):
    good = {"visible": True, "slope": 0.1, "pan_rad": 0.1, "tilt_rad": 0.5}
    assert Room(Task()).believed(Percept(**good)) is not None
    assert Room(Task()).believed(Percept(**good | bad)) is None


def test_a_trail_has_no_line_across_a_placement(docking):
    steps = [each.what.strips[0] for each in of(docking[1], "plan/robot_trail")]
    assert steps
    assert max(math.dist(*step) for step in steps) < 0.3


def test_a_trial_ends_with_its_way_its_mark_in_the_curve_and_a_line_in_the_log(docking):
    scene, shown = docking
    board = Scoreboard()
    for row in Recording(RECORDINGS / "docking.mcap").messages(("pilot/trial", "simulator/truth")):
        board.take(row.decoded(), row.capture_ns)
    (trial,) = board.scorer.trials
    (way,) = of(shown, "plan/trials/00")
    assert list(way.what.strips[0]) == trial.path
    (mark,) = of(shown, "learning/lc")
    assert mark.what == Number(100.0)
    (line,) = of(shown, "log/trials")
    assert "reached, docked, picked" in line.what.text
    assert "1: 1 reached, 1 docked, 1 picked" in scene.summary()


def trials(outcomes):
    """(Trial, capture time) of a pilot whose trials end so, two frames each."""
    for number, outcome in enumerate(outcomes):
        before = outcomes[number - 1] if number else Trial.NONE
        yield Trial(mode=Trial.APPROACH, controller="lc", number=number, ended=number, outcome=before), 2 * number
        yield (
            Trial(mode=Trial.REVERSE, controller="lc", number=number, ended=number + 1, outcome=outcome),
            2 * number + 1,
        )


def test_the_learning_curve_is_the_share_of_the_last_twenty_and_needs_no_truth():
    outcomes = [Trial.SINK] * 20 + [Trial.REACHED] * 30
    course, curve = Course(Room(Task())), []
    seen = Percept(visible=True, slope=0.1, pan_rad=0.1, tilt_rad=0.5)
    for message, frame in trials(outcomes):
        shown = course.said(message, frame * FRAME_NS) + course.percept(seen, frame * FRAME_NS)
        curve += [each.what.value for each in of(shown, "learning/lc")]
    assert curve[:20] == [0.0] * 20
    assert curve[20:40] == [5.0 * n for n in range(1, 21)]
    assert curve[40:] == [100.0] * 10
    assert course.counts == {"reached": 30, "docked": 0, "picked": 0}  # nobody can tell whether it has docked


def test_an_hour_of_trials_takes_no_more_memory_than_a_minute():
    course = Course(Room(Task()))
    slots = set()
    for message, frame in trials([Trial.REACHED] * 400):
        shown = course.said(message, frame * FRAME_NS) + course.truth(Truth(x_m=-1.0), frame * FRAME_NS)
        slots |= {each.entity for each in shown if each.entity.startswith("plan/trials/")}
    assert course._scorer.trials == []
    assert len(slots) == 40


def policy(**more):
    size = 9
    fields = {
        "version": 3, "beta_cells": 3, "alpha_cells": 3, "beta_range_rad": 1.0, "alpha_range_rad": 0.5,
        "action": bytes([0, 1, 255, 0, 1, 0, 1, 0, 1]), "value": [0.0] * size,
        "action_v_mps": [0.1, 0.1], "action_omega_radps": [0.2, -0.2],
    }  # fmt: skip
    return Policy(**fields | more)


def test_the_policys_picture_has_beta_upwards_and_alpha_to_the_right():
    shown = {each.entity: each.what for each in PolicyMap(1).policy(policy(), 5, 5)}
    image = cv2.imdecode(np.frombuffer(shown["policy/action"].data, np.uint8), cv2.IMREAD_COLOR)
    third = SIDE_PX // 3
    colours = [
        [tuple(int(level) for level in image[SIDE_PX - third // 2 - row * third, LEFT_PX + third // 2 + column * third])
         for column in range(3)] for row in range(3)
    ]  # fmt: skip
    left, right, unknown = colours[0]
    assert len({left, right, unknown}) == 3
    assert colours[1] == [left, right, left]
    assert colours[2] == [right, left, right]
    assert shown["policy_size/known_percent"].value == pytest.approx(800 / 9)


def test_the_robot_is_marked_in_the_cell_that_it_is_in():
    drawn = PolicyMap(1)
    assert drawn.here(0.0, 0.0, 1) == []  # there is no policy yet
    drawn.policy(policy(), 5, 5)
    (dot, _) = drawn.here(-0.9, 0.4, 9)
    ((column, row),) = dot.what.points
    assert (int((column - LEFT_PX) // (SIDE_PX / 3)), int(row // (SIDE_PX / 3))) == (2, 2)
    assert drawn.here(1.1, 0.0, 9)[0].what == Dots((), dot.what.colour, dot.what.radius_px)
    assert place(drawn._drawn, 0.0, 0.0) == (LEFT_PX + SIDE_PX / 2, SIDE_PX / 2)
    assert actions(drawn._drawn).shape == (3, 3, 3)


@pytest.mark.parametrize(
    "bad", [{"action": b"\x07" * 9}, {"value": [math.nan] * 9}, {"beta_cells": 4}, {"beta_cells": 1 << 31}]
)
def test_a_policy_that_the_pilot_would_refuse_is_not_drawn(bad):
    assert PolicyMap(1).policy(policy(**bad), 5, 5) == []


def test_a_process_that_falls_silent_is_called_so_and_a_restart_is_told():
    processes, words = Processes(), []
    for second in range(6):
        for number, name in enumerate(("base", "pilot", "head")):
            if name != "pilot" or second in {0, 5}:
                run = number + (100 if second == 5 and name == "pilot" else 0)
                words += [
                    (second, each) for each in processes.status(Status(component=name, handled=second), run, second)
                ]
    lanes = [(second, each.what.text) for second, each in words if each.entity == "processes/pilot"]
    assert lanes == [(0, "running"), (3, "silent"), (5, "running")]
    assert [each.what.text for _, each in words if each.entity == "log/processes"] == ["pilot was started again"]
    assert "| pilot | running | 2 | 5 |" in processes.table()


def test_holes_in_the_numbers_are_counted_for_each_topic_and_run():
    processes = Processes()
    for topic, run, sequence in [("a", 1, 5), ("a", 1, 6), ("a", 1, 9), ("b", 1, 0), ("a", 2, 0), ("b", 1, 4)]:
        processes.heard(topic, run, sequence, 0)
    assert processes.missing == 2 + 3


def test_latency_is_the_age_of_the_cause_and_lockstep_has_none(cut, docking):
    assert not [each for each in docking[1] if each.entity.startswith("latency_ms")]
    rows = {row.capture_ns: row for row in Recording(RECORDINGS / "cut.mcap").messages(("tracker/percept",))}
    ages = of(cut[1], "latency_ms/tracker_percept")
    assert len(ages) == len(rows)
    for each in ages:
        assert each.what.value == pytest.approx((rows[each.time_ns].time_ns - each.time_ns) / 1e6)


def test_each_process_of_a_live_session_is_in_the_table(cut):
    page = [each.what for each in of(cut[1], "processes")][-1]
    assert isinstance(page, Page)
    for name in ("simulator", "vision", "head", "tracker", "pilot", "learner", "grasper", "base", "recorder"):
        assert f"| {name} | running | 1 |" in page.text


def test_states_are_told_when_they_change(docking):
    modes = [each.what for each in of(docking[1], "pilot/mode")]
    assert all(isinstance(word, Word) for word in modes)
    assert all(one != next_one for one, next_one in pairwise(modes))
    assert {"approach", "servo", "grasp"} <= {word.text for word in modes}


def test_nothing_shown_is_not_a_number(docking, cut):
    for each in docking[1] + cut[1]:
        match each.what:
            case Number(value):
                assert math.isfinite(value)
            case Lines(strips):
                assert all(math.isfinite(x) for strip in strips for point in strip for x in point)
            case Picture(data):
                assert data


def test_numbers_that_are_none_are_left_out():
    scene = Scene({}, picture_ns=1)
    message = Applied(v_mps=math.nan, omega_radps=1.0)
    shown = scene.take(Logged("x/y", "berth.Applied", message.SerializeToString(), 1, 0, 0, 0), 0)
    assert of(shown, "drive/speed_cmps") == []
    assert of(shown, "drive/turn_degps") != []


def test_damaged_messages_and_launch_files_of_strangers_change_nothing():
    for launch in ({}, {"components": 3}, {"components": [3, {"inputs": 4}]}, {"task": [], "trial": 7, "clock": None}):
        scene = Scene(launch, picture_ns=1)
        for number, schema in enumerate([*SCHEMAS, "berth.Unknown", ""]):
            scene.take(Logged("a/b", schema, b"\xff\xff\xff", 1, number, 0, 0), 0)
        assert scene.malformed == len(SCHEMAS)
        assert scene.furniture()


def test_the_wired_topic_is_shown_where_two_have_one_schema(docking):
    wiring = Wiring({"components": [{"inputs": {"head": "head/state"}}], "trial": "pilot/trial"})
    assert not wiring.takes("simulator/head", "berth.HeadState")
    assert wiring.takes("head/state", "berth.HeadState")
    assert not wiring.takes("shadow/trial", "berth.Trial")
    assert wiring.takes("eyes/view", "berth.View")  # nothing is wired: the first one
    assert not wiring.takes("other/view", "berth.View")
    assert len(of(docking[1], "head/pan_deg")) == 197


def test_the_preview_is_shown_where_the_recorder_leaves_the_camera_out():
    specs = [{"inputs": {"image": "camera/image"}}, {"params": {"leave_out": ["camera/image"]}}, {"params": 3}]
    wiring = Wiring({"components": specs})
    assert not wiring.takes("camera/image", "foxglove.CompressedImage")
    assert wiring.takes("preview/image", "foxglove.CompressedImage")
    assert Wiring({"components": specs[:1]}).takes("camera/image", "foxglove.CompressedImage")


def test_a_rate_lets_one_pass_in_each_period_and_begins_anew_when_time_jumps_back():
    rate = Rate(10)
    assert [now for now in range(0, 40, 3) if rate.passes(now)] == [0, 12, 24, 36]
    assert rate.passes(2)
    assert not rate.passes(3)


def test_the_scene_is_a_fold(docking):
    again = shown_of(RECORDINGS / "docking.mcap")[1]
    assert again == docking[1]
    assert all(isinstance(each, Shown) for each in again)
