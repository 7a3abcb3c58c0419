"""The world as a component: when it steps, where it places the robot, and what it tells."""

import math

import cv2
import numpy as np
import pytest

from components.simulator.component import Simulator
from components.simulator.params import Params
from docking import plant
from docking.starts import start
from docking.task import Task
from runtime.contract import STALL, STOP, TICK, ComponentError, Event
from schemas.drive_pb2 import GRIPPER_CLOSE, GRIPPER_LIFT, GRIPPER_LOWER, BaseCommand
from schemas.head_pb2 import HeadCommand
from schemas.session_pb2 import RecorderAck
from schemas.trial_pb2 import Trial

BEGIN_NS, FRAME_NS, TICK_NS = 1_000_000_007, 125_000_000, 15_625_000
PORTS = ["image", "head", "base", "truth"]


def begun(seed=1, **params):
    simulator = Simulator(Params(**params), seed)
    return simulator, simulator.handle(Event(BEGIN_NS, TICK))


def answer(simulator, capture_ns, drive=None, aim=None, trial=None):
    """Answer a frame on all ports; the outputs of the last answer."""
    simulator.handle(Event(capture_ns, "drive", drive or BaseCommand(), capture_ns))
    simulator.handle(Event(capture_ns, "aim", aim or HeadCommand(tilt_rad=0.3), capture_ns))
    return simulator.handle(Event(capture_ns, "trial", trial or Trial(), capture_ns))


def frames(simulator, first, count, **answers):
    """Answer `count` frames alike; all their outputs, the first frame's included."""
    history = [first]
    for _ in range(count):
        history.append(answer(simulator, history[-1][0].capture_ns, **answers))
    return history


def message(outputs, port):
    return next(output.message for output in outputs if output.port == port)


def pose(outputs):
    truth = message(outputs, "truth")
    return truth.x_m, truth.y_m, truth.heading_rad


def test_nothing_happens_before_the_first_tick():
    simulator = Simulator(Params(), 1)
    assert answer(simulator, 0) == ()
    assert simulator.handle(Event(0, STALL)) == ()
    assert simulator.handle(Event(0, STOP)) == ()


def test_the_first_tick_takes_frame_0():
    _, outputs = begun()
    assert [output.port for output in outputs] == PORTS
    assert {output.capture_ns for output in outputs} == {BEGIN_NS}


@pytest.mark.parametrize("order", [("drive", "aim", "trial"), ("trial", "drive", "aim"), ("aim", "trial", "drive")])
def test_lockstep_takes_a_frame_when_all_have_answered(order):
    simulator, _ = begun()
    messages = {"drive": BaseCommand(), "aim": HeadCommand(), "trial": Trial()}
    events = [Event(BEGIN_NS, port, messages[port], BEGIN_NS) for port in order]
    assert [simulator.handle(event) for event in (*events[:2], *events[:2])] == [()] * 4
    outputs = simulator.handle(events[2])
    assert [output.port for output in outputs] == PORTS
    assert {output.capture_ns for output in outputs} == {BEGIN_NS + FRAME_NS}
    assert message(outputs, "image").timestamp.ToNanoseconds() == BEGIN_NS + FRAME_NS


@pytest.mark.parametrize("other_ns", [0, BEGIN_NS - FRAME_NS, BEGIN_NS + FRAME_NS, 2**62, -5])
def test_answers_to_other_frames_do_not_count(other_ns):
    simulator, _ = begun()
    assert answer(simulator, other_ns) == ()
    assert answer(simulator, BEGIN_NS) != ()


def test_ticks_do_not_step_lockstep():
    simulator, _ = begun()
    assert [simulator.handle(Event(BEGIN_NS + k * TICK_NS, TICK)) for k in range(1, 30)] == [()] * 29


def test_lockstep_waits_for_the_recorder_once_there_is_one():
    simulator, first = begun()
    simulator.handle(Event(BEGIN_NS, "ack", RecorderAck(), BEGIN_NS))
    history = frames(simulator, first, 16)
    newest_ns = history[-1][0].capture_ns
    assert newest_ns == BEGIN_NS + 16 * FRAME_NS
    ahead = answer(simulator, newest_ns)
    assert ahead[0].capture_ns == BEGIN_NS + 17 * FRAME_NS
    assert answer(simulator, BEGIN_NS + 17 * FRAME_NS) == ()
    outputs = simulator.handle(Event(newest_ns, "ack", RecorderAck(), BEGIN_NS + FRAME_NS))
    assert outputs[0].capture_ns == BEGIN_NS + 18 * FRAME_NS


def test_without_a_recorder_lockstep_does_not_wait_for_one():
    simulator, first = begun()
    assert len(frames(simulator, first, 40)[-1]) == 4


def test_an_acknowledgement_from_the_future_is_worth_no_more_than_the_newest_frame():
    simulator, first = begun()
    simulator.handle(Event(BEGIN_NS, "ack", RecorderAck(), 2**62))
    newest = frames(simulator, first, 17)[-1]
    assert answer(simulator, newest[0].capture_ns) == ()


def test_a_stall_steps_without_the_missing_commands_and_the_third_names_them():
    simulator, _ = begun()
    simulator.handle(Event(BEGIN_NS, "aim", HeadCommand(), BEGIN_NS))
    for stall in (1, 2):
        outputs = simulator.handle(Event(BEGIN_NS, STALL))
        assert {output.capture_ns for output in outputs} == {BEGIN_NS + stall * FRAME_NS}
    with pytest.raises(ComponentError, match=r"3 stalls in a row.*drive, aim, trial"):
        simulator.handle(Event(BEGIN_NS, STALL))


def test_an_answered_frame_ends_a_row_of_stalls():
    simulator, _ = begun()
    for _ in range(5):
        outputs = simulator.handle(Event(BEGIN_NS, STALL))
        outputs = simulator.handle(Event(BEGIN_NS, STALL))
        assert answer(simulator, outputs[0].capture_ns) != ()


def test_a_moving_robot_brakes_by_itself_through_stalls():
    simulator, first = begun(watchdog_s=0.15)
    moving = frames(simulator, first, 8, drive=BaseCommand(v_mps=0.02))[-1]
    assert message(moving, "truth").v_mps == pytest.approx(0.02)
    simulator.handle(Event(BEGIN_NS, STALL))
    assert message(simulator.handle(Event(BEGIN_NS, STALL)), "truth").v_mps == 0.0


def test_only_base_moves_the_robot():
    simulator, first = begun()
    aim = HeadCommand(pan_rad=1.0, tilt_rad=1.0, pan_rate_radps=1.0)
    history = frames(simulator, first, 20, aim=aim, trial=Trial(mode=1, number=4, start=3))
    assert {pose(outputs) for outputs in history} == {pose(first)}


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e300])
def test_nonsense_on_any_port_moves_nothing_and_breaks_nothing(value):
    simulator, first = begun()
    drive = BaseCommand(v_mps=value, omega_radps=value, gripper=4711)
    aim = HeadCommand(pan_rad=value, tilt_rad=value, pan_rate_radps=value, tilt_rate_radps=value)
    trial = Trial(phase=99, number=2**32 - 1, start=2**32 - 1, action=-(2**31), began_ns=2**63 - 1)
    last = frames(simulator, first, 10, drive=drive, aim=aim, trial=trial)[-1]
    assert pose(last) == pose(first)
    head = message(last, "head")
    assert math.isfinite(head.pan_rad)
    assert math.isfinite(head.tilt_rad)


def test_the_first_start_is_start_0_of_the_seed():
    _, first = begun(seed=5)
    assert pose(first) == pytest.approx(plant.pose(*start("demo", 5, 0, Task())))


@pytest.mark.parametrize("kind", ["demo", "full"])
def test_a_trial_places_the_robot_at_its_start_once(kind):
    simulator, first = begun(starts=kind, starts_seed=77)
    drive, trial = BaseCommand(v_mps=0.3, omega_radps=0.5), Trial(phase=1, number=2, place=True, start=9)
    placed, after = frames(simulator, first, 2, drive=drive, trial=trial)[1:]
    expected = start(kind, 77, 9, Task())
    truth = message(placed, "truth")
    assert (truth.beta_rad, truth.alpha_rad, truth.d_axle_m) == pytest.approx(expected)
    assert (truth.placed, truth.start, truth.v_mps, truth.omega_radps) == (True, 9, 0.0, 0.0)
    assert (truth.object_u_px, truth.object_v_px) == pytest.approx((0, 0), abs=1e-6)
    assert not message(after, "truth").placed
    assert message(after, "truth").start == 9
    assert pose(after) != pose(placed)


def test_a_placed_robot_forgets_the_commands_from_before():
    simulator, first = begun(command_latency_s=0.5)
    driving = frames(simulator, first, 3, drive=BaseCommand(v_mps=0.3))[-1]
    placed = answer(simulator, driving[0].capture_ns, BaseCommand(v_mps=0.3), trial=Trial(place=True))
    assert {pose(outputs) for outputs in frames(simulator, placed, 10)} == {pose(placed)}


def test_the_next_trial_places_it_again():
    simulator, first = begun()
    places = [Trial(phase=1, number=number, place=True, start=number) for number in range(3)]
    captures_ns = [BEGIN_NS + k * FRAME_NS for k in range(3)]
    numbers = [message(answer(simulator, t, trial=p), "truth").start for t, p in zip(captures_ns, places, strict=True)]
    assert numbers == [0, 1, 2]
    assert pose(first) != ()


def test_placing_resets_the_gripper_and_puts_the_object_back():
    simulator, first = begun()
    low = frames(simulator, first, 20, drive=BaseCommand(gripper=GRIPPER_LOWER))[-1]
    assert message(low, "base").lift_down
    placed = answer(simulator, low[0].capture_ns, trial=Trial(place=True))
    assert message(placed, "base").lift_up


def at_the_object(simulator):
    simulator._world.base.pose.x_m, simulator._world.base.pose.y_m = -0.28, 0.0
    simulator._world.base.pose.heading_rad = 0.0


def test_the_robot_picks_up_the_object_and_carries_it():
    simulator, first = begun()
    at_the_object(simulator)
    low = frames(simulator, first, 14, drive=BaseCommand(gripper=GRIPPER_LOWER))[-1]
    base = message(low, "base")
    assert (base.lift_down, base.inner_beam, base.outer_beam) == (True, True, True)
    closed = frames(simulator, low, 10, drive=BaseCommand(gripper=GRIPPER_CLOSE))[-1]
    assert message(closed, "base").fingers_closed
    assert not message(closed, "truth").holding
    lifted = frames(simulator, closed, 14, drive=BaseCommand(gripper=GRIPPER_LIFT, v_mps=-0.1))[-1]
    assert message(lifted, "truth").holding
    x_m, _, z_m = simulator._world.object_m
    assert x_m == pytest.approx(message(lifted, "truth").x_m + 0.28)
    assert z_m == pytest.approx(0.1)


def test_truth_tells_the_gripper_point_from_its_pose_for_picking():
    simulator, _ = begun()
    at_the_object(simulator)
    simulator._world.base.pose.x_m -= 0.03
    simulator._world.base.pose.y_m += 0.01
    truth = message(answer(simulator, BEGIN_NS), "truth")
    assert truth.gripper_longitudinal_m == pytest.approx(-0.03)
    assert truth.gripper_lateral_m == pytest.approx(0.01)


def test_collision_is_told_by_bumper_and_truth_while_it_lasts():
    simulator, first = begun()
    at_the_object(simulator)
    history = frames(simulator, first, 16, drive=BaseCommand(v_mps=0.2))
    assert message(history[-1], "truth").collided
    assert message(history[-1], "base").bumper
    free = frames(simulator, history[-1], 8, drive=BaseCommand(v_mps=-0.2))[-1]
    assert not message(free, "truth").collided
    assert not message(free, "base").bumper


def test_encoders_are_quantised_and_near_the_truth():
    simulator, first = begun()
    history = frames(simulator, first, 40, aim=HeadCommand(pan_rad=0.5, tilt_rad=0.5))
    for outputs in history:
        head, truth = message(outputs, "head"), message(outputs, "truth")
        step = math.radians(0.1125)
        assert head.pan_rad / step == pytest.approx(round(head.pan_rad / step), abs=1e-6)
        assert head.pan_rad == pytest.approx(truth.pan_rad, abs=4 * math.radians(0.03) + step)
        assert head.tilt_rad == pytest.approx(truth.tilt_rad, abs=4 * math.radians(0.03) + step)


def test_odometry_follows_the_drive_but_for_its_scale():
    simulator, first = begun(odometry_scale=0.0)
    last = frames(simulator, first, 40, drive=BaseCommand(v_mps=-0.1, omega_radps=0.1))[-1]
    base, truth = message(last, "base"), message(last, "truth")
    x, y, heading = pose(first)
    ahead = (truth.x_m - x) * math.cos(heading) + (truth.y_m - y) * math.sin(heading)
    assert base.odometry_x_m == pytest.approx(ahead, abs=1e-6)
    assert base.odometry_heading_rad == pytest.approx(math.remainder(truth.heading_rad - heading, math.tau), abs=1e-6)


def records(seed, **params):
    simulator, first = begun(seed, **params)
    drive = BaseCommand(v_mps=0.1, omega_radps=0.1)
    history = frames(simulator, first, 12, drive=drive, aim=HeadCommand(pan_rad=0.2, tilt_rad=0.3))
    return [output.message.SerializeToString(deterministic=True) for outputs in history for output in outputs]


def test_same_seed_same_bytes():
    assert records(3) == records(3)


def test_another_seed_gives_another_world():
    assert not set(records(3)[::4]) & set(records(4)[::4])  # the images


def test_chance_differs_from_seed_to_seed_and_from_frame_to_frame():
    pans = set()
    for seed in (3, 4):
        simulator, first = begun(seed, encoder_step_rad=0.0)
        pans |= {message(outputs, "head").pan_rad for outputs in frames(simulator, first, 5)}
    assert len(pans) == 12


def test_the_image_is_a_jpeg_of_its_size():
    for width in (320, 640):
        _, first = begun(width_px=width)
        image = message(first, "image")
        assert (image.format, image.frame_id) == ("jpeg", "camera")
        assert cv2.imdecode(np.frombuffer(image.data, np.uint8), cv2.IMREAD_COLOR).shape == (width * 3 // 4, width, 3)


def ticks(simulator, times_ns):
    return [simulator.handle(Event(BEGIN_NS + time_ns, TICK)) for time_ns in times_ns]


def captures(outputs):
    return [frame[0].capture_ns - BEGIN_NS for frame in outputs if frame]


def test_in_real_time_a_frame_is_taken_every_eighth_of_a_second():
    simulator, _ = begun(clock="real")
    outputs = ticks(simulator, [k * TICK_NS for k in range(1, 65)])
    assert captures(outputs) == [k * FRAME_NS for k in range(1, 9)]


def test_ticks_that_come_when_they_like_give_the_same_frames():
    simulator, _ = begun(clock="real")
    times_ns = np.sort(np.random.default_rng(1).integers(0, 10**9, 300)).tolist()
    outputs = ticks(simulator, times_ns)
    assert captures(outputs) == [k * FRAME_NS for k in range(1, 8)]
    shown = [(time_ns, frame) for time_ns, frame in zip(times_ns, outputs, strict=True) if frame]
    assert all(frame[0].capture_ns <= BEGIN_NS + time_ns for time_ns, frame in shown)


def test_a_late_tick_takes_the_newest_frame_only():
    simulator, _ = begun(clock="real")
    assert captures(ticks(simulator, [4 * FRAME_NS + 3, 5 * FRAME_NS])) == [4 * FRAME_NS, 5 * FRAME_NS]


def test_a_suspended_machine_does_not_drive_on():
    simulator, first = begun(clock="real")
    simulator.handle(Event(BEGIN_NS, "drive", BaseCommand(v_mps=0.5), BEGIN_NS))
    outputs = ticks(simulator, [3600 * 10**9 + k * FRAME_NS for k in range(20)])
    assert pose(next(frame for frame in reversed(outputs) if frame)) == pose(first)


def test_commands_in_real_time_act_when_they_come():
    simulator, first = begun(clock="real")
    ticks(simulator, [k * TICK_NS for k in range(1, 4)])
    simulator.handle(Event(BEGIN_NS + 3 * TICK_NS, "drive", BaseCommand(v_mps=0.1), BEGIN_NS))
    outputs = ticks(simulator, [k * TICK_NS for k in range(4, 9)])
    assert message(outputs[-1], "truth").v_mps == pytest.approx(0.3 * 3 * TICK_NS * 1e-9)
    assert pose(outputs[-1]) != pose(first)
