"""The robot's protocol against packets of an independent client, and against its own definition."""

import random
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.fuzz_pioneer import run
from components.base.pioneer.aux_pac import answer_of, asked
from components.base.pioneer.command import SYNC0, SYNC1, SYNC2, Command, Spoken, heard, integer, plain, text, wheels
from components.base.pioneer.config_pac import config_of, names_of
from components.base.pioneer.frame import Frames, framed
from components.base.pioneer.gripper_flags import flags_of
from components.base.pioneer.gripper_pac import gripper_of
from components.base.pioneer.model import Model
from components.base.pioneer.odometry import Odometry
from components.base.pioneer.sip import sip_of

PACKETS = {
    # Recorded from the packet sender of a client that was written elsewhere.
    "fa fb 03 00 00 00": plain(Command.PULSE),
    "fa fb 03 02 00 02": SYNC2,
    "fa fb 06 04 3b 01 00 05 3b": integer(Command.ENABLE, 1),
    "fa fb 06 05 3b 2c 01 31 3c": integer(Command.SETA, 300),
    "fa fb 06 06 3b f4 01 fa 3c": integer(Command.SETV, 500),
    "fa fb 06 08 1b fa 00 02 1b": integer(Command.MOVE, -250),
    "fa fb 06 0a 3b 3c 00 46 3b": integer(Command.SETRV, 60),
    "fa fb 06 0b 1b c8 00 d3 1b": integer(Command.VEL, -200),
    "fa fb 06 0d 1b 2d 00 3a 1b": integer(Command.DHEAD, -45),
    "fa fb 06 13 3b 02 00 15 3b": integer(Command.ENCODER, 2),
    "fa fb 06 15 1b 1e 00 33 1b": integer(Command.RVEL, -30),
    "fa fb 06 1c 3b 01 00 1d 3b": integer(Command.SONAR, 1),
    "fa fb 03 1d 00 1d": plain(Command.STOP),
    "fa fb 06 21 3b 02 00 23 3b": integer(Command.GRIPPER, 2),
    "fa fb 06 21 3b 05 00 26 3b": integer(Command.GRIPPER, 5),
    "fa fb 06 21 3b 11 00 32 3b": integer(Command.GRIPPER, 17),
    "fa fb 06 25 3b 02 00 27 3b": integer(Command.GRIPREQUEST, 2),
    "fa fb 06 2b 3b 00 00 2b 3b": integer(Command.GETAUX, 0),
    "fa fb 06 2c 3b 03 00 2f 3b": integer(Command.BUMPSTALL, 3),
    "fa fb 03 37 00 37": plain(Command.E_STOP),
    "fa fb 06 20 3b 0a 0a 2a 45": wheels(10, 10),
    "fa fb 06 20 1b f6 09 16 24": wheels(-10, 10),
    "fa fb 06 20 3b 00 00 20 3b": wheels(0, 0),
    "fa fb 14 2a 2b 0f 81 01 06 02 18 14 00 03 07 00 00 01 02 0c ff 61 d2": text(
        Command.TTY2, bytes.fromhex("81 01 06 02 18 14 00 03 07 00 00 01 02 0c ff")
    ),
}


@pytest.mark.parametrize(("recorded", "ours"), PACKETS.items())
def test_packets_are_those_of_an_independent_client(recorded, ours):
    assert ours == bytes.fromhex(recorded)


def test_the_handshake_is_that_of_the_manual():
    assert [step.hex() for step in (SYNC0, SYNC1, SYNC2)] == ["fafb03000000", "fafb03010001", "fafb03020002"]


def test_a_number_that_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="at most 65535"):
        integer(Command.VEL, 65536)
    with pytest.raises(ValueError, match="1 to 198 bytes"):
        framed(b"")


def slow_checksum(payload):
    total, at = 0, 0
    while len(payload) - at > 1:
        total = (total + (payload[at] << 8) + payload[at + 1]) % 65536
        at += 2
    return total ^ payload[at] if at < len(payload) else total


@given(st.binary(min_size=1, max_size=198))
def test_a_packet_is_header_count_payload_and_checksum(payload):
    packet = framed(payload)
    assert packet == b"\xfa\xfb" + bytes((len(payload) + 2,)) + payload + slow_checksum(payload).to_bytes(2, "big")
    assert Frames().feed(packet) == [payload]


@given(st.integers(0, 255), st.integers(-65535, 65535))
def test_a_robot_hears_what_a_client_says(command, value):
    assert heard(Frames().feed(integer(command, value))[0]) == Spoken(command, value)


def test_a_robot_takes_negative_wheel_speeds_in_both_forms():
    assert heard(bytes.fromhex("20 1b f6 09")).value & 0xFFFF == heard(bytes.fromhex("20 3b 0a f6")).value == 0xF60A


@given(st.lists(st.binary(min_size=1, max_size=30), max_size=6), st.integers(1, 7))
def test_packets_come_out_however_they_are_cut(payloads, size):
    data, frames, read = b"".join(map(framed, payloads)), Frames(), []
    for at in range(0, len(data), size):
        read += frames.feed(data[at : at + size])
    assert read == payloads
    assert frames.waiting == 0


def test_no_whole_packet_is_lost_in_spoiled_streams():
    crashes, sent, missing, held = run(1000, 7)
    assert (crashes, missing) == (0, 0)
    assert sent > 2000
    assert held <= 260


def test_a_packet_behind_a_false_length_comes_out_when_the_line_falls_silent():
    frames = Frames()
    assert frames.feed(b"\xfa\xfb\xff" + SYNC1) == []
    assert frames.settle() == [b"\x01"]


def test_a_packet_that_is_only_split_survives_the_silence():
    frames = Frames()
    packet = integer(Command.VEL, 100)
    assert frames.feed(packet[:5]) == frames.settle() == []
    assert frames.feed(packet[5:]) == [packet[3:-2]]


SIP = struct.pack("<BHHhhhBHhHBB", 0x33, 0x7FFE, 3, -512, 90, 110, 127, 0x0203, 0, 0x0021, 0, 1) + struct.pack(
    "<BHHBBB", 4, 1500, 0x1200, 1, 2, 3
)


def test_a_sip_is_read_at_the_offsets_of_the_manual():
    sip = sip_of(SIP)
    assert (sip.moving, sip.x, sip.y, sip.heading, sip.left, sip.right) == (True, 0x7FFE, 3, -512, 90, 110)
    assert (sip.battery_dv, sip.sonar, sip.gripper) == (127, {4: 1500}, 0x12)
    assert (sip.stalled, sip.front_bumper, sip.rear_bumper) == (True, True, True)
    assert (sip.motors_on, sip.stop_button) == (True, True)
    assert (sip.digital_in, sip.digital_out) == (2, 3)


def test_sonar_readings_that_are_announced_and_not_sent_are_none():
    assert sip_of(SIP[:19] + bytes((24,))).sonar == {}
    assert sip_of(SIP[:19] + bytes((24, 0, 0, 0, 0, 0))).sonar == {}, "what follows is no reading"


@given(st.integers(0, len(SIP)))
def test_a_short_sip_is_none_or_what_is_there(size):
    sip = sip_of(SIP[:size])
    assert (sip is None) == (size < 20)


def config(watchdog=2000, speed_top=1500, turn_max=100, speed_max=750):
    head = b"\x20Pioneer\0peoplebot-sh\0KF1234\0" + struct.pack("<B5H", 0, 360, speed_top, 300, 2000, 500) + b"Robbie\0"
    return (
        head
        + struct.pack("<BBBHHBHHH", 100, 0, 0, 1, 1, 1, 110, 16570, watchdog)
        + struct.pack("<BHHHHHH", 0, 200, 200, 400, 50, turn_max, speed_max)
    )


def test_a_configuration_tells_watchdog_gripper_and_top_speeds():
    pac = config_of(config())
    assert (pac.subclass, pac.name, pac.cycle_ms, pac.has_gripper) == ("peoplebot-sh", "Robbie", 100, True)
    assert (pac.watchdog_ms, pac.fastest_mmps, pac.fastest_turn_degps) == (2000, 750, 100)


def test_a_top_speed_of_9999_is_none():
    assert config_of(config(speed_top=9999, speed_max=9999)).fastest_mmps is None


def test_a_configuration_cut_after_its_watchdog_is_enough():
    whole = config()
    assert config_of(whole[:-13]).speed_max is None
    assert config_of(whole[:-14]) is None


def test_the_names_come_with_the_last_echo():
    assert names_of(b"\x02Robbie\0Pioneer\0PeopleBot-SH\0") == ("Robbie", "Pioneer", "PeopleBot-SH")
    assert names_of(b"\x02Rob") == ("Rob", "", "")


def test_the_gripper_s_switches_are_low_when_they_hold():
    assert not gripper_of(b"\xe0\x01\xff").open
    pac = gripper_of(bytes((0xE0, 2, 0b01011010)))
    assert (pac.open, pac.lift_at_end, pac.outer_beam, pac.inner_beam) == (True, False, False, True)
    assert (pac.grasping, pac.lift_moves, pac.fingers_move) == (True, True, False)


def standard(gripper, digital_in):
    return sip_of(SIP[:19] + bytes((0, 0x55, gripper, 0, digital_in, 0)))


def test_the_standard_packet_s_gripper_byte_is_read_as_the_gripper_s_manual_has_it():
    flags = flags_of(standard(0b01100110, 0b0100))
    assert (flags.fingers_closed, flags.fingers_move) == (True, True)
    assert (flags.lift_up, flags.lift_down, flags.lift_moves) == (False, True, True)
    assert (flags.outer_beam, flags.inner_beam) == (True, False)


def test_of_two_opposites_that_both_hold_nothing_is_known():
    flags = flags_of(standard(0b00110011, 0))
    assert (flags.fingers_closed, flags.lift_up, flags.lift_down) == (False, False, False)
    assert flags_of(sip_of(SIP[:20])) is None


def test_the_auxiliary_port_is_asked_before_it_is_told_and_answers_in_its_own_packet():
    flush, ask, tell = (heard(Frames().feed(packet)[0]) for packet in asked(b"\x81\xff", 3))
    assert (flush.value, ask.value, tell.content) == (0, 3, b"\x81\xff")
    assert answer_of(b"\xb0\x90\x41\xff") == b"\x90\x41\xff"
    assert answer_of(b"\xb8\x90") is None


def wheel(x, y, heading=0):
    return sip_of(struct.pack("<BHHhhhBHhHBB", 0x33, x, y, heading, 0, 0, 127, 0, 0, 1, 0, 0))


def test_odometry_goes_on_where_fifteen_bits_wrap():
    odometry, rng, x = Odometry(Model(distance_mm=0.485)), random.Random(3), 30000
    odometry.add(wheel(x, 0), 0)
    way = 0
    for number in range(1, 400):
        step = rng.randrange(-80, 120)
        x, way = x + step, way + step
        odometry.add(wheel(x % 0x8000 | (rng.randrange(2) << 15), 0), number * 100_000_000)
    assert abs(way) > 3000
    assert odometry.x_m == pytest.approx(way * 0.485e-3)


def test_a_robot_that_begins_anew_does_not_jump_and_drives_on_in_our_axes():
    odometry = Odometry(Model())
    odometry.add(wheel(0, 0, 1024), 0)
    odometry.add(wheel(0, 100, 1024), 10**9)
    assert (odometry.x_m, odometry.y_m, odometry.heading_rad) == pytest.approx((0.1, 0.0, 0.0))
    odometry.add(wheel(0, 100, 2048), 2 * 10**9)
    odometry.forget()
    odometry.add(wheel(0, 0, 0), 3 * 10**9)
    assert (odometry.x_m, odometry.y_m) == pytest.approx((0.1, 0.0))
    odometry.add(wheel(50, 0, 0), 4 * 10**9)
    assert (odometry.x_m, odometry.y_m) == pytest.approx((0.1, 0.05)), "it was turned to the left before"


def test_a_counter_that_is_set_to_another_value_is_no_way():
    odometry = Odometry(Model())
    odometry.add(wheel(0, 0), 0)
    odometry.add(wheel(4000, 0), 100_000_000)
    assert (odometry.x_m, odometry.jumps) == (0.0, 1)
