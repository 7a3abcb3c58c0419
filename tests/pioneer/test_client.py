"""The client against the emulated robot, in emulated time: what it does when all is well, and when nothing is."""

import math
import random

import pytest

from components.base.pioneer.client import Client, Wish
from components.base.pioneer.command import Command
from components.base.pioneer.gripper import Switches
from components.base.ports import Pioneer
from components.simulator.params import Params
from docking.starts import Start
from tests.pioneer.body import Body
from tests.pioneer.robot import Robot

NS = 1_000_000_000
STEP_NS = NS // 64
BAUD = 9600
FAR = Start(0.0, 0.0, 50.0)
AT_FINGERS = Start(0.0, 0.0, 0.28)
"""The object is between the fingers."""


class Rig:
    """Robot and client on one line, both at one clock."""

    def __init__(self, params=None, **robot):
        self.body = Body(Params(odometry_scale=0.0), FAR, 0)
        self.robot = Robot(self.body, **robot)
        self.body.twist = self.robot.twist
        self.client = Client(params or Pioneer(unattended_m=1.0), 0)
        self.now_ns = 0
        self.wish = Wish()
        self.commands = True
        self.spoils = lambda data: data
        self.readings = []

    def run(self, seconds, until=None):
        end_ns = self.now_ns + round(seconds * NS)
        while self.now_ns < end_ns and not (until and until()):
            self._step()
        return self

    def _step(self):
        self.now_ns += STEP_NS
        client, now = self.client, self.now_ns
        if self.commands and self.now_ns // STEP_NS % 8 == 0:
            client.command(self.wish, now)
        client.advance(now)
        self.robot.hear(self.spoils(client.packet(now, BAUD)), now)
        said = self.spoils(self.robot.speak(now))
        if said:
            client.take(said, now)
        if client.failed:
            client.begin(now)
        self.readings += client.readings
        client.readings.clear()
        self.body.step()

    def connected(self):
        self.run(5.0, lambda: self.client.config is not None and self.robot.motors)
        assert self.client.config is not None
        self.run(0.5)
        return self

    @property
    def v_mps(self):
        return self.body.base.v_mps

    def heard(self, *commands):
        return [(command, value) for _, command, value in self.robot.received if command in commands]


def test_it_connects_and_drives_as_told():
    rig = Rig().connected()
    rig.wish = Wish(0.1, math.radians(10))
    rig.run(3.0)
    assert rig.v_mps == pytest.approx(0.1, abs=1e-3)
    assert rig.body.base.omega_radps == pytest.approx(math.radians(10), abs=1e-3)
    last = rig.readings[-1]
    assert (last.fault, last.v_mps, last.battery_v) == ("", pytest.approx(0.1, abs=2e-3), pytest.approx(12.4))
    assert last.omega_radps == pytest.approx(math.radians(10), abs=0.01)


def test_over_a_network_it_says_nothing_but_the_handshake_to_a_server_that_knows_nothing_else():
    Rig(Pioneer(port="tcp://robot:8101"), strict=True).connected()


def test_over_a_network_too_a_robot_that_was_left_driving_is_stopped_before_anything_else():
    params = Pioneer(port="tcp://robot:8101")
    rig = Rig(params).connected()
    rig.wish = Wish(0.1)
    rig.run(2.0)
    rig.client, rig.wish = Client(params, rig.now_ns), Wish()
    rig.robot.received.clear()
    rig.connected()
    assert rig.heard(*range(256))[:3] == [(Command.VEL, 0), (Command.RVEL, 0), (Command.CLOSE, None)]


@pytest.mark.parametrize("port", ["/dev/ttyUSB0", "tcp://robot:8101"])
def test_a_robot_that_hears_and_is_not_heard_is_not_kept_driving(port):
    rig = Rig(Pioneer(port=port)).connected()
    rig.wish = Wish(0.1)
    rig.run(2.0)
    rig.client.take = lambda *_: None
    rig.run(3.0)
    assert rig.v_mps == 0.0


def test_motors_are_enabled_only_after_a_zero_speed():
    commands = [command for command, _ in Rig().connected().heard(*range(256))]
    assert commands.index(Command.VEL) < commands.index(Command.PULSE) < commands.index(Command.ENABLE)


@pytest.mark.parametrize("factor", [1.0, 0.485, 0.424])
def test_odometry_is_that_of_the_body_whatever_the_model_counts(factor):
    name = {1.0: "peoplebot-sh", 0.485: "perfpb", 0.424: "p2pb"}[factor]
    rig = Rig(subclass=name, distance_mm=factor).connected()
    x0, y0, heading0 = rig.body.odometry.triple
    rig.wish = Wish(0.3, 0.1)
    rig.run(30.0)
    rig.wish = Wish()
    rig.run(2.0)
    x, y, heading = rig.body.odometry.triple
    last = rig.readings[-1]
    assert heading > 2.0
    assert (last.x_m, last.y_m, last.heading_rad) == pytest.approx((x - x0, y - y0, heading - heading0), abs=3e-3)


def test_turn_rates_between_whole_degrees_are_right_in_the_mean():
    rig = Rig().connected()
    rig.wish = Wish(0.0, math.radians(3.4))
    rig.run(1.0)
    before = rig.body.odometry.heading_rad
    rig.run(10.0)
    assert math.degrees(rig.body.odometry.heading_rad - before) == pytest.approx(34.0, abs=0.7)


def test_a_wish_that_is_no_number_is_rest():
    rig = Rig().connected()
    rig.wish = Wish(math.nan, math.inf)
    rig.run(1.0)
    assert rig.v_mps == 0.0


def test_the_robot_stops_when_nobody_commands_it_any_more_and_says_so():
    rig = Rig().connected()
    rig.wish = Wish(0.1)
    rig.run(2.0)
    rig.commands = False
    rig.run(1.2)
    assert rig.v_mps == 0.0
    assert rig.readings[-1].fault == "no command"
    rig.commands, rig.wish = True, Wish()
    rig.run(0.5)
    assert rig.readings[-1].fault == ""


def test_a_silence_of_ours_ends_with_rest_before_anything_else():
    rig = Rig().connected()
    rig.wish = Wish(0.1)
    rig.run(2.0)
    client, rig.client = rig.client, Client(Pioneer(), rig.now_ns)
    rig.client.packet = lambda *_: b""
    rig.run(4.0)
    assert rig.v_mps == 0.0, "its own watchdog"
    rig.robot.received.clear()
    rig.client, rig.commands = client, False
    rig.run(0.5)
    assert rig.heard(*range(256))[:2] == [(Command.VEL, 0), (Command.RVEL, 0)]
    assert rig.v_mps == 0.0


def test_after_a_pause_of_ours_rest_comes_first_though_a_new_command_has_come():
    rig = Rig(watchdog_ms=400).connected()
    rig.wish = Wish(0.1)
    rig.run(2.0)
    for _ in range(38):  # 0.6 s, in which nobody looks at the line
        rig.now_ns += STEP_NS
        rig.body.step()
    assert rig.v_mps < 0.09, "its own watchdog"
    rig.robot.received.clear()
    rig.client.command(Wish(0.1), rig.now_ns)
    rig.run(0.1)
    assert rig.heard(*range(256))[:2] == [(Command.VEL, 0), (Command.RVEL, 0)]


def test_a_robot_that_was_left_driving_is_stopped_closed_and_opened():
    rig = Rig().connected()
    rig.wish = Wish(0.1)
    rig.run(2.0)
    rig.client, rig.wish = Client(Pioneer(), rig.now_ns), Wish()
    rig.robot.received.clear()
    rig.connected()
    commands = rig.heard(*range(256))
    assert commands[0] == (Command.VEL, 0)
    assert (Command.CLOSE, None) in commands
    assert (Command.ENABLE, 1) in commands


def test_a_silent_robot_is_told_and_greeted_again_without_motion():
    rig = Rig().connected()
    rig.wish = Wish(0.1)
    rig.run(2.0)
    rig.robot.deaf = True
    rig.run(3.0)
    assert rig.readings[-1].fault == "not connected"
    assert rig.v_mps == 0.0
    rig.robot.deaf, rig.wish = False, Wish()
    pose = rig.readings[-1][:2]
    rig.run(4.0)
    assert rig.readings[-1].fault == ""
    assert rig.readings[-1][:2] == pytest.approx(pose, abs=0.25), "odometry goes on"


def test_a_robot_that_was_reset_is_connected_to_anew():
    rig = Rig().connected()
    rig.robot.reset()
    rig.client.words.clear()
    rig.run(4.0)
    assert rig.robot.motors
    assert any("connecting anew" in words for words in rig.client.words)
    assert rig.readings[-1].fault == ""


def test_the_stop_button_holds_until_a_person_switches_the_motors_on():
    rig = Rig().connected()
    rig.wish = Wish(0.1)
    rig.run(2.0)
    rig.robot.stop_button, rig.robot.motors = True, False
    rig.run(2.0)
    assert (rig.v_mps, rig.readings[-1].fault) == (0.0, "stop button")
    rig.robot.stop_button = False
    rig.run(2.0)
    assert (rig.v_mps, rig.readings[-1].fault) == (0.0, "motors off")
    rig.robot.motors = True
    rig.run(2.0)
    assert rig.readings[-1].fault == ""


def test_a_slow_watchdog_is_told_and_limits_the_speed():
    rig = Rig(Pioneer(unattended_m=0.2)).connected()
    assert any("watchdog is 2000 ms" in words for words in rig.client.words)
    assert rig.readings[-1].watchdog_s == 2.0
    rig.wish = Wish(0.3)
    rig.run(2.0)
    assert rig.v_mps == pytest.approx(0.1, abs=1e-3)


def test_a_fast_watchdog_is_nothing_to_speak_of():
    rig = Rig(Pioneer(unattended_m=0.2), watchdog_ms=400).connected()
    assert not any("watchdog" in words for words in rig.client.words)
    assert rig.client.limits.speed_mps == pytest.approx(0.5)


def test_a_bumper_is_told():
    rig = Rig().connected()
    rig.body.base.bumper = True
    rig.body.base.rear_bumper = True
    rig.readings.clear()
    rig.client.readings.clear()
    rig.client.take(rig.robot.speak(rig.now_ns + NS), rig.now_ns)
    assert (rig.client.readings[-1].bumper, rig.client.readings[-1].rear_bumper) == (True, True)


def test_sonar_readings_that_never_come_and_motors_that_are_on_harm_nobody():
    params = Pioneer(rear_sonars=(10, 11), unattended_m=1.0)
    rig = Rig(params, motors_at_open=True, empty_sonar=True, obeys_watchdog=False).connected()
    rig.wish = Wish(0.1)
    rig.run(2.0)
    assert rig.v_mps == pytest.approx(0.1, abs=1e-3)
    assert rig.readings[-1].rear_range_m is None


@pytest.mark.parametrize(("pac", "byte"), [(True, True), (True, False), (False, True)])
def test_the_gripper_goes_through_a_pick_up(pac, byte):
    rig = Rig(Pioneer(), knows_gripper_pac=pac, tells_gripper=byte).connected().run(1.0)
    assert rig.readings[-1].switches.lift_up == byte, "GRIPPERpac alone does not tell at which end"
    rig.wish = Wish(gripper=1)
    rig.run(0.3)
    assert not rig.readings[-1].switches.lift_down, "it is still at the top"
    rig.run(3.0)
    assert rig.readings[-1].switches.lift_down
    assert not rig.readings[-1].switches.lift_up
    rig.wish = Wish(gripper=2)
    rig.run(0.2)
    assert not rig.readings[-1].switches.fingers_closed
    rig.run(2.0)
    assert rig.readings[-1].switches.fingers_closed
    rig.wish = Wish(gripper=3)
    rig.run(3.0)
    switches = rig.readings[-1].switches
    assert (switches.lift_up, switches.fingers_closed) == (True, True)
    rig.wish = Wish(gripper=4)
    rig.run(2.0)
    assert rig.body.gripper.fingers == 1.0
    assert not rig.readings[-1].switches.fingers_closed


def test_break_beams_are_told_by_old_firmware_too():
    rig = Rig(knows_gripper_pac=False).connected().run(1.0)
    assert not rig.readings[-1].switches.inner_beam
    rig.body.place(AT_FINGERS)
    rig.wish = Wish(gripper=1)
    rig.run(3.0)
    switches = rig.readings[-1].switches
    assert (switches.inner_beam, switches.outer_beam) == (True, True)


def test_a_robot_without_a_gripper_is_told_once_and_its_switches_say_nothing():
    rig = Rig(gripper_kind=0).connected()
    rig.body.place(AT_FINGERS)
    rig.wish = Wish(gripper=1)
    rig.run(3.0)
    assert sum("no gripper" in words for words in rig.client.words) == 1
    assert rig.readings[-1].switches == Switches()


def test_reversed_motors_get_the_opposite_commands():
    rig = Rig(Pioneer()).connected()
    rig.wish = Wish(gripper=3, lift_reversed=True, fingers_reversed=True)
    rig.run(1.0)
    assert rig.heard(Command.GRIPPER)[0] == (Command.GRIPPER, 5)


def test_on_a_line_that_spoils_every_hundredth_byte_no_garbage_moves_it_and_it_gets_through():
    rig, rng = Rig().connected(), random.Random(5)
    rig.spoils = lambda data: bytes(b ^ (rng.random() < 0.01) << rng.randrange(8) for b in data)
    rig.run(10.0)
    assert rig.v_mps == 0.0
    rig.wish = Wish(0.1)
    fastest = 0.0
    for _ in range(100):
        rig.run(0.1)
        fastest = max(fastest, abs(rig.v_mps))
    assert fastest == pytest.approx(0.1, abs=1e-3)


def test_garbage_alone_never_moves_a_robot_nor_stops_the_client():
    rng = random.Random(6)
    rig = Rig().connected()
    rig.robot.received.clear()
    for _ in range(300):
        rig.client.take(rng.randbytes(rng.randrange(200)), rig.now_ns)
        rig.run(0.02)
    assert all(value == 0 for _, value in rig.heard(Command.VEL, Command.RVEL))
    assert rig.v_mps == 0.0
