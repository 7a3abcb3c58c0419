"""What may move a ROS 2 base and what may not, in emulated time."""

import math
import random
from itertools import pairwise
from types import SimpleNamespace

import pytest

from components.base.ports import Ros2
from components.base.ros2.client import FAREWELLS, Client
from components.base.ros2.codec import HAZARDS
from components.base.ros2.lateness import Lateness
from components.simulator.base import Pose
from runtime.params import ConfigurationError, build
from tests.ros2 import messages
from tests.ros2.robot import BOOTED_NS, NS, PERIODS_NS, Robot

PERIOD_NS = NS // 100
FRAME_NS = NS // 8


class Rig:
    """A client and a robot, and all that goes between them."""

    def __init__(self, robot=None, **params):
        base = SimpleNamespace(v_mps=0.0, omega_radps=0.0, bumper=False)
        self.body = SimpleNamespace(base=base, odometry=Pose(0.0, 0.0, 0.0))
        bridge = params.get("bridge", "ros2dds")
        self.robot = Robot(self.body, bridge, **(robot or {}))
        self.params = Ros2(**{"battery": "battery_state", "bumper": "hazard_detection", **params})
        self.client = Client(self.params, "ab12", 0)
        self.now_ns = 0
        self.wish = (0.0, 0.0)
        """What base says, eight times a second; None = it says nothing."""
        self.delay_ns = 0
        """Of what the robot says."""
        self.way = []
        self.readings = []

    def run(self, seconds):
        for _ in range(round(seconds * NS / PERIOD_NS)):
            self.now_ns += PERIOD_NS
            self._say()
            self.way += [(self.now_ns + self.delay_ns, said) for said in self.robot.speak(self.now_ns)]
            while self.way and self.way[0][0] <= self.now_ns:
                _, said = self.way.pop(0)
                self.client.take(said.key, said.payload, self.now_ns)
            while self.client.readings:
                self.readings.append(self.client.readings.popleft())
        return self

    def _say(self):
        if self.wish is not None and self.now_ns % FRAME_NS < PERIOD_NS:
            self.client.command(*self.wish, self.now_ns)
        self.client.advance(self.now_ns)
        sample = self.client.sample(self.now_ns, self.now_ns)
        if sample is not None:
            self.robot.hear(*sample, self.now_ns)

    def odometry(self, **changed):
        """One more odometry message, now, and changed."""
        said = self.robot.odometry(self.now_ns + 1)
        for name, value in changed.items():
            setattr(said.pose.pose.position if name in {"x", "y"} else said.twist.twist.linear, name[-1], value)
        return self.robot.said("odom", said)


def driving(**params):
    rig = Rig(**params).run(0.2)
    rig.wish = (0.1, -0.2)
    rig.run(0.5)
    assert rig.robot.obeyed == (0.1, -0.2)
    return rig


@pytest.mark.parametrize("bridge", ["ros2dds", "rmw_zenoh"])
def test_a_robot_is_driven_in_both_bridges_words(bridge):
    rig = driving(bridge=bridge)
    assert rig.robot.unheard == 0
    assert rig.robot.numbers == sorted(rig.robot.numbers)


def test_it_is_told_at_least_ten_times_a_second_between_the_words_of_base():
    times = [time_ns for time_ns, *_ in driving().run(1.0).robot.heard]
    assert max(b - a for a, b in pairwise(times)) <= NS // 10


def test_before_its_first_odometry_it_is_told_nothing_but_to_rest():
    rig = Rig({"mute": True})
    rig.wish = (0.1, 0.0)
    rig.run(1.0)
    assert {(v, omega) for _, v, omega in rig.robot.heard} == {(0.0, 0.0)}
    assert rig.readings[-1].fault == "no odometry on /odom"


def test_odometry_that_stops_stops_the_robot_is_told_and_begins_again_only_with_a_new_command():
    rig = driving()
    rig.robot.mute = True
    rig.run(rig.params.silent_s + 0.1)
    assert rig.robot.obeyed == (0.0, 0.0)
    assert rig.readings[-1].fault == "no odometry for 1 s"
    rig.robot.mute, rig.wish = False, None
    rig.run(0.3)
    assert rig.readings[-1].fault == ""
    assert rig.robot.obeyed == (0.0, 0.0)
    rig.wish = (0.1, 0.0)
    assert rig.run(0.3).robot.obeyed == (0.1, 0.0)
    assert [words for words in rig.client.words if "odometry" in words] == [
        "odometry comes", "no odometry for 1 s; the robot is told to rest", "odometry comes"]  # fmt: skip


def test_when_base_falls_silent_the_robot_rests():
    rig = driving()
    rig.wish = None
    assert rig.run(rig.params.guard_s + 0.15).robot.obeyed == (0.0, 0.0)


@pytest.mark.parametrize("wish", [(math.nan, 0.0), (0.1, math.inf), (-math.inf, math.nan)])
def test_a_wish_that_is_no_number_is_rest(wish):
    rig = driving()
    rig.wish = wish
    assert rig.run(0.2).robot.obeyed == (0.0, 0.0)


def test_speed_is_limited_also_by_the_way_that_it_may_drive_unattended():
    rig = driving()
    rig.wish = (-9.0, 9.0)
    assert rig.run(0.2).robot.obeyed == (-rig.params.max_speed_mps, rig.params.max_turn_rate_radps)
    slow = Rig(watchdog_s=2.0, unattended_m=0.2).run(0.2)
    slow.wish = (0.3, 0.0)
    assert slow.run(0.2).robot.obeyed == (0.1, 0.0)


def test_a_farewell_says_several_times_to_rest():
    rig = driving()
    for sample in rig.client.farewell(0):
        rig.robot.hear(*sample, rig.now_ns)
    assert [said[1:] for said in rig.robot.heard[-FAREWELLS:]] == [(0.0, 0.0)] * FAREWELLS


def test_clocks_that_disagree_by_years_make_nothing_late():
    rig = driving().run(5.0)
    assert not rig.client.refused
    assert rig.now_ns - rig.readings[-1].time_ns < 0.06 * NS


def test_odometry_that_was_held_up_is_known_to_be_old_and_too_old_counts_for_nothing():
    rig = driving()
    rig.delay_ns = round(0.3 * NS)
    rig.run(1.0)
    assert rig.readings[-1].fault == ""
    assert rig.now_ns - rig.readings[-1].time_ns == pytest.approx(0.3 * NS, abs=0.06 * NS)
    rig.delay_ns = round(0.8 * NS)
    rig.run(0.9 + rig.params.silent_s)
    assert rig.client.refused["/odom"] > 0
    assert rig.readings[-1].fault
    assert rig.robot.obeyed == (0.0, 0.0)


@pytest.mark.parametrize("by_s", [-7200, 7200])
def test_a_robot_whose_clock_is_set_is_at_rest_and_goes_on_with_a_new_command(by_s, monkeypatch):
    rig = driving()
    monkeypatch.setattr("tests.ros2.robot.BOOTED_NS", BOOTED_NS + by_s * NS)
    rig.wish = None
    rig.run(rig.params.silent_s + 0.2)
    assert rig.robot.obeyed == (0.0, 0.0)
    rig.wish = (0.1, 0.0)
    assert rig.run(0.3).robot.obeyed == (0.1, 0.0)
    assert rig.readings[-1].fault == ""


def test_a_burst_of_old_odometry_after_a_cut_does_not_keep_the_robot_driving():
    rig = driving()
    rig.run(1.0)
    old = [rig.robot.said("odom", rig.robot.odometry(rig.now_ns + k * NS // 20)) for k in range(1, 20)]
    rig.robot.mute = True
    rig.run(3.0)
    assert rig.readings[-1].fault
    known = len(rig.readings)
    for said in old:
        rig.client.take(said.key, said.payload, rig.now_ns)
    rig.run(0.3)
    assert len(rig.readings) > known
    assert all(reading.fault for reading in rig.readings[known:])
    assert rig.robot.obeyed == (0.0, 0.0)


def test_the_same_odometry_again_and_an_older_one_after_it_are_no_sign_of_life():
    rig = driving()
    said = rig.odometry()
    rig.robot.mute = True
    for _ in range(20):
        rig.run(0.1)
        rig.client.take(said.key, said.payload, rig.now_ns)
    assert rig.readings[-1].fault
    assert rig.robot.obeyed == (0.0, 0.0)


@pytest.mark.parametrize("absurd", [{"x": math.nan}, {"y": 1e12}, {"twist_x": math.inf}, {"twist_x": -80.0}])
def test_absurd_odometry_is_no_sign_of_life_and_reaches_nobody(absurd):
    rig = driving()
    rig.robot.mute = True
    for _ in range(20):
        rig.run(0.1)
        said = rig.odometry(**absurd)
        rig.client.take(said.key, said.payload, rig.now_ns)
    assert rig.client.refused["/odom"] == 20
    assert rig.robot.obeyed == (0.0, 0.0)
    assert all(math.hypot(*r.odometry[:5]) < 1.0 for r in rig.readings)


def test_no_spoiled_message_moves_a_robot_that_shall_rest_or_is_counted_as_a_sign_of_life():
    rig, rng = Rig().run(0.3), random.Random(3)
    keys = list(rig.client.keys)
    whole = [rig.odometry().payload, rig.robot._hazards(0).serialize(), rig.robot._battery(0).serialize()]
    rig.robot.mute = True
    for _ in range(3000):
        data = bytearray(rng.choice(whole))
        for _ in range(rng.randrange(1, 5)):
            data[rng.randrange(min(12, len(data)))] = rng.randrange(256)
        rig.client.take(rng.choice(keys), bytes(data[: rng.choice((len(data), rng.randrange(len(data))))]), rig.now_ns)
    rig.run(0.5)
    assert {(v, omega) for _, v, omega in rig.robot.heard} == {(0.0, 0.0)}
    assert len(rig.client.words) <= 5


def test_a_bumper_is_told_at_once_and_a_hanging_wheel_stops_the_robot():
    rig = driving()
    rig.body.base.bumper = True
    assert rig.run(0.12).readings[-1].contact.front
    header = rig.robot.header(rig.now_ns, "wheel_drop_left")
    fallen = messages.HazardDetectionVector(header, [messages.HazardDetection(header, 4)])
    rig.robot.mute = True
    said = rig.robot.said("hazard_detection", fallen)
    assert rig.params.bumper_type == HAZARDS
    rig.client.take(said.key, said.payload, rig.now_ns)
    rig.run(0.05)
    assert rig.readings[-1].fault == "a wheel hangs in the air"
    assert rig.robot.obeyed == (0.0, 0.0)


def test_the_battery_is_told_and_one_of_no_volts_is_not():
    rig = driving()
    assert rig.readings[-1].battery_v == 12.5
    empty = rig.robot._battery(rig.now_ns)
    empty.voltage = math.nan
    said = rig.robot.said("battery_state", empty)
    rig.client.take(said.key, said.payload, rig.now_ns)
    assert rig.run(0.2).readings[-1].battery_v == 12.5


def test_two_hundred_readings_a_second_are_thinned(monkeypatch):
    monkeypatch.setitem(PERIODS_NS, "odom", NS // 200)
    rig = Rig().run(2.0)
    assert 30 <= len(rig.readings) <= 55


def test_lateness_is_what_a_message_took_longer_than_the_quickest():
    lateness = Lateness()
    assert lateness.late_s(5 * NS, 10 * NS) == 0.0
    assert lateness.late_s(6 * NS, round(11.2 * NS)) == pytest.approx(0.2, abs=0.001)
    assert lateness.late_s(6 * NS, 12 * NS) is None
    assert lateness.late_s(0, 12 * NS) == 0.0
    assert lateness.late_s(7 * NS, round(11.9 * NS)) == 0.0


def test_a_clock_that_runs_slow_is_not_late_for_ever():
    lateness = Lateness()
    late = [lateness.late_s(round(k * NS * (1 - 100e-6)) + 1, k * NS) for k in range(1, 20_000, 10)]
    assert max(late) < 0.01


@pytest.mark.parametrize(
    ("table", "words"),
    [({"endpoint": "robot"}, "tcp/HOST:PORT"), ({"cmd_vel": "cmd vel"}, "a topic's name"), ({"odom": "**"}, "a topic"),
     ({"namespace": "a/*"}, "a ROS name"), ({"domain": 300}, "between 0 and 232"),
     ({"bridge": "dds"}, "one of ros2dds"),
     ({"bumper_type": "std_msgs/msg/Int8"}, "one of"), ({"node": "a/b"}, "a ROS name")],
)  # fmt: skip
def test_a_device_that_can_not_be_meant_is_refused_in_one_line(table, words):
    with pytest.raises(ConfigurationError, match=words.replace("*", r"\*")):
        build(Ros2, table, "base.device")
