"""Pan-tilt cameras: their bytes against the manuals, and the driver against emulated ones, in emulated time."""

import math
import random
import time

import numpy as np
import pytest

from components.head import canon, visca
from components.head.camera import Camera
from components.head.devices.pan_tilt import CanonVcC4
from components.head.ports import PanTilt
from components.head.reply import Kind, Reply
from components.simulator.params import Params
from docking.starts import Start
from schemas.head_pb2 import HeadCommand
from tests.pioneer import cameras
from tests.pioneer.body import Body
from tests.pioneer.served import Serial, Served

NS = 1_000_000_000
STEP_NS = NS // 64
CAMERAS = {"canon": (canon.Canon, cameras.Canon), "sony": (visca.Visca, cameras.Sony)}


def test_a_canon_is_told_90_right_and_30_down_as_in_its_manual():
    assert canon.Canon().move(800, -267).content == b"\xff\x30\x30\x00\x6283207EF5\xef"


def test_a_canon_s_position_is_read_from_its_answer():
    assert canon.Canon().feed(b"\xfe\x30\x30\x30\x3083207EF5\xef") == [Reply(Kind.POSITION, 800, -267)]


def test_a_canon_s_errors_are_told_apart():
    kinds = [canon.Canon().feed(b"\xfe\x30\x30" + bytes((e,)) + b"\x30\xef")[0].kind for e in (0x30, 0x31, 0x35, 0x39)]
    assert kinds == [Kind.DONE, Kind.BUSY, Kind.REFUSED, Kind.UNREADY]


def test_a_sony_is_told_its_ends_as_in_its_manual():
    content = visca.Visca().move(880, 300).content
    assert content == bytes.fromhex("81 01 06 02 18 14 00 03 07 00 00 01 02 0c ff")


def test_a_sony_s_position_is_read_from_its_answer():
    assert visca.Visca().feed(bytes.fromhex("90 50 0f 0c 09 00 00 01 02 0c ff")) == [Reply(Kind.POSITION, -880, 300)]


def test_a_sony_s_replies_are_told_apart():
    replies = visca.Visca().feed(bytes.fromhex("90 41 ff 90 51 ff 90 60 03 ff 90 61 41 ff 90 60 02 ff"))
    assert [r.kind for r in replies] == [Kind.DONE, Kind.NEWS, Kind.BUSY, Kind.BUSY, Kind.REFUSED]


@pytest.mark.parametrize("make", [canon.Canon, visca.Visca])
def test_no_bytes_crash_a_reader_or_fill_it_and_a_whole_answer_behind_them_is_read(make):
    rng, whole = random.Random(9), {canon.Canon: b"\xfe\x30\x30\x30\x30\xef", visca.Visca: b"\xff\x90\x41\xff"}[make]
    for _ in range(500):
        speech = make()
        for _ in range(3):
            speech.feed(rng.randbytes(rng.randrange(40)))
            assert len(speech._buffer) < 64
        assert Reply(Kind.DONE) in speech.feed(whole)


class Rig:
    """A camera and its driver at one clock."""

    def __init__(self, name, inverted=True, **camera):
        speech, emulated = CAMERAS[name]
        self.body = Body(Params(head_lag_s=0.0), Start(0.0, 0.0, 50.0), 0)
        self.emulated = emulated(lambda: self.body.head, inverted=inverted, **camera)
        self.driver = Camera(speech(), PanTilt(inverted=inverted), 0)
        self.now_ns = 0
        self.readings = []
        self.cable = True

    def run(self, seconds):
        end_ns = self.now_ns + round(seconds * NS)
        while self.now_ns < end_ns:
            self.now_ns += STEP_NS
            request = self.driver.request(self.now_ns)
            if request is not None and self.cable:
                self.emulated.hear(request.content, self.now_ns)
            said = self.emulated.speak(self.now_ns)
            if said and self.cable:
                self.driver.take(said, self.now_ns)
            self.readings += self.driver.readings
            self.driver.readings.clear()
            self.body.step()
        return self


@pytest.mark.parametrize("name", CAMERAS)
@pytest.mark.parametrize("inverted", [True, False])
def test_it_looks_left_and_says_so(name, inverted):
    rig = Rig(name, inverted).run(3.0)
    down = math.radians(20)
    rig.driver.aim(0.5, down, 0.0, 0.0)
    rig.run(2.0)
    assert rig.body.head.angles_rad == pytest.approx((0.5, down), abs=2e-3)
    assert rig.readings[-1][:2] == pytest.approx((0.5, down), abs=4e-3)


def test_a_hanging_canon_looks_down_to_the_pick_up_and_an_upright_one_as_far_as_it_can():
    for inverted, reached in ((True, 58.0), (False, 30.0)):
        rig = Rig("canon", inverted).run(3.0)
        rig.driver.aim(0.0, math.radians(58), 0.0, 0.0)
        rig.run(2.0)
        assert math.degrees(rig.readings[-1].tilt_rad) == pytest.approx(reached, abs=0.1)


@pytest.mark.parametrize("name", CAMERAS)
def test_a_position_counts_for_when_it_was_asked_for_however_late_the_answer(name):
    rig = Rig(name, answer_s=0.3).run(5.0)
    rig.driver.aim(0.0, 0.1, 0.0, 0.0)
    rig.run(3.0)
    rig.readings.clear()
    truth = {}
    for _ in range(240):
        rig.driver.aim(0.8 * math.sin(rig.now_ns / NS), 0.1, 0.0, 0.0)
        truth[rig.now_ns // STEP_NS] = rig.body.head.angles_rad[0]
        rig.run(1 / 64)
    assert len(rig.readings) >= 5
    for reading in rig.readings[1:]:
        assert reading.pan_rad == pytest.approx(truth[reading.time_ns // STEP_NS], abs=0.03)


def stepping(name, answer_s):
    """(truth, as read) of the tilt at each moment: 3 deg every 2 s, then 1 deg, which a slow camera lets be."""
    rig = Rig(name, answer_s=answer_s).run(3.0)
    rig.driver.aim(0.0, math.radians(5), 0.0, 0.0)
    rig.run(4.0)
    rig.readings.clear()
    times, truth = [], []
    for tilt_deg in (8, 11, 14, 11, 8, 9):
        rig.driver.aim(0.0, math.radians(tilt_deg), 0.0, 0.0)
        for _ in range(128):
            times.append(rig.now_ns)
            truth.append(math.degrees(rig.body.head.angles_rad[1]))
            rig.run(1 / 64)
    read = np.array([(reading.time_ns, math.degrees(reading.tilt_rad)) for reading in rig.readings])
    known = (np.array(times) > read[0, 0]) & (np.array(times) < read[-1, 0])
    return np.array(truth)[known], np.interp(np.array(times)[known], *read.T), np.diff(read[:, 0]) / NS


@pytest.mark.parametrize("name", CAMERAS)
def test_where_a_slow_camera_was_is_known_at_every_moment_of_a_step(name):
    truth, read, _ = stepping(name, 0.3)
    assert np.mean(np.abs(truth - read) < 0.15) > 0.95, "it moves for 0.3 s of 12"


def test_a_slow_camera_that_stands_is_known_at_once_and_is_not_moved_for_little():
    slow, quick = stepping("canon", 0.3), stepping("canon", 0.03)
    assert slow[0][-1] == pytest.approx(8.0, abs=0.1)
    assert quick[0][-1] == pytest.approx(9.0, abs=0.1)
    assert np.median(slow[2]) < 0.1
    assert np.max(slow[2]) < 0.7, "while it moves: one answer to the move, one to the question"
    assert np.max(slow[2][len(slow[2]) // 2 :]) < 0.25, "once it has done as told three times in a row"


def test_a_camera_that_somebody_turns_is_seen_to_be_elsewhere():
    rig = Rig("canon", answer_s=0.3).run(3.0)
    rig.driver.aim(0.0, 0.2, 0.0, 0.0)
    rig.run(3.0)
    rig.body.head.look(0.1, 0.2)
    rig.run(1.0)
    assert rig.readings[-1].pan_rad == pytest.approx(0.1, abs=4e-3)


@pytest.mark.parametrize("name", CAMERAS)
def test_a_busy_camera_is_asked_again(name):
    rig = Rig(name).run(3.0)
    rig.emulated.busy_until_ns = rig.now_ns + NS
    rig.driver.aim(0.4, 0.1, 0.0, 0.0)
    rig.run(3.0)
    assert rig.body.head.angles_rad[0] == pytest.approx(0.4, abs=2e-3)


@pytest.mark.parametrize("name", CAMERAS)
def test_a_camera_that_falls_silent_is_unknown_and_comes_back(name):
    rig = Rig(name).run(3.0)
    rig.cable = False
    rig.run(4.0)
    assert math.isnan(rig.readings[-1].pan_rad)
    rig.cable = True
    rig.driver.aim(0.3, 0.1, 0.0, 0.0)
    rig.run(5.0)
    assert rig.readings[-1].pan_rad == pytest.approx(0.3, abs=4e-3)
    assert list(rig.driver.words)[-2:] == [
        "the camera does not answer; asking again and again",
        "the camera answers",
    ]


def test_a_canon_that_was_switched_off_is_set_up_again():
    rig = Rig("canon").run(3.0)
    rig.emulated.power, rig.emulated.tilts = False, (-267, 267)
    rig.driver.aim(0.0, math.radians(58), 0.0, 0.0)
    rig.run(5.0)
    assert math.degrees(rig.readings[-1].tilt_rad) == pytest.approx(58.0, abs=0.1)


def test_a_camera_at_a_serial_port_of_its_own_is_read_and_moved():
    camera = cameras.Canon(lambda: None, inverted=True)
    with Served(Serial()) as served:
        camera.head = lambda: served.body.head
        served.robot = camera
        device = CanonVcC4(PanTilt(port=served.end.port, inverted=True))
        end_s = time.monotonic() + 30.0
        pan_rad = math.nan
        while not abs(pan_rad - 0.3) < 0.004:
            assert time.monotonic() < end_s
            device.write(HeadCommand(pan_rad=0.3, tilt_rad=0.2))
            late = device.read(0.05)
            if late is not None:
                pan_rad = late.message.pan_rad
                assert 0.0 <= late.age_s < 5.0
        device.close()
