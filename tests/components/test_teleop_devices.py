"""Keyboard and gamepad as devices: a real pseudo-terminal, and a pipe in place of /dev/input/js0."""

import os
import pty
import termios
import time

import pytest

from components.teleop.devices.gamepad import Joystick
from components.teleop.devices.keyboard import Terminal
from components.teleop.ports import Gamepad, Keyboard
from runtime.contract import DeviceError
from schemas.teleop_pb2 import Hands
from tests.components.test_teleop_codecs import AXIS, HOLD, event

DEADLINE_S = 20.0


def next_reading(device):
    """What the device says next, or None after the deadline."""
    until_s = time.monotonic() + DEADLINE_S
    while time.monotonic() < until_s:
        if (hands := device.read(0.05)) is not None:
            return hands
    return None


@pytest.fixture
def terminal():
    """(master, slave's name) of a pseudo-terminal; a test that closes the master takes it out of the list."""
    master, slave = pty.openpty()
    masters = [master]
    yield masters, os.ttyname(slave)
    for descriptor in (slave, *masters):
        os.close(descriptor)


def test_keys_come_one_by_one_without_echo_and_the_terminal_is_given_back(terminal):
    (master,), name = terminal
    before = termios.tcgetattr(master)
    keyboard = Terminal(Keyboard(port=name))
    assert not termios.tcgetattr(master)[3] & (termios.ECHO | termios.ICANON)
    assert termios.tcgetattr(master)[3] & termios.ISIG, "Ctrl-C is still a signal"
    os.write(master, b"iu\x1b[B")
    arcs = [(hands.forward, hands.left) for hands in (next_reading(keyboard) for _ in range(3))]
    assert arcs == [(1.0, 0.0), (1.0, 1.0), (-1.0, 0.0)]
    assert keyboard.read(0.01) is None
    keyboard.close()
    assert termios.tcgetattr(master) == before
    keyboard.close()  # may be repeated


def test_a_closed_terminal_is_told_in_one_line(terminal):
    masters, name = terminal
    keyboard = Terminal(Keyboard(port=name))
    os.close(masters.pop())
    with pytest.raises(DeviceError, match=f"keyboard {name} (can not be read|was closed)"):
        next_reading(keyboard)
    keyboard.close()


@pytest.mark.parametrize(
    ("port", "words"), [("/nowhere", "can not be opened: No such file"), ("/dev/null", "must be a terminal")]
)
def test_what_is_no_terminal_is_refused_by_name(port, words):
    with pytest.raises(DeviceError, match=f"keyboard {port} {words}"):
        Terminal(Keyboard(port=port))


@pytest.fixture
def pad(tmp_path):
    """(writer, path) of a pipe that plays the joystick."""
    path = str(tmp_path / "js0")
    os.mkfifo(path)
    writer = os.open(path, os.O_RDWR)
    yield writer, path
    os.close(writer)


def until(device, condition):
    """The first reading that fulfils a condition."""
    until_s = time.monotonic() + DEADLINE_S
    while not condition(hands := device.read(0.01)):
        assert time.monotonic() < until_s
    return hands


def test_a_pad_is_read_event_by_event_and_says_its_state_while_nothing_happens(pad):
    writer, path = pad
    joystick = Joystick(Gamepad(port=path))
    assert joystick.read(0.0) == Hands(), "nothing is held at the beginning"
    os.write(writer, HOLD + event(-32767, AXIS, 1))
    held = until(joystick, lambda hands: hands.forward == 1.0)
    assert held.dead_man
    assert joystick.read(0.0) == held
    joystick.close()


def test_a_pad_that_says_nothing_for_its_time_is_not_held_any_more(pad):
    writer, path = pad
    joystick = Joystick(Gamepad(port=path, still_s=0.2))
    os.write(writer, HOLD)
    until(joystick, lambda hands: hands.dead_man)
    until(joystick, lambda hands: not hands.dead_man)
    os.write(writer, event(-32767, AXIS, 1))
    assert not until(joystick, lambda hands: hands.forward == 1.0).dead_man, "it must be pressed anew"
    joystick.close()


def test_an_unplugged_pad_is_told_in_one_line(tmp_path):
    path = str(tmp_path / "js0")
    os.mkfifo(path)
    joystick = Joystick(Gamepad(port=path))
    os.close(os.open(path, os.O_WRONLY))
    with pytest.raises(DeviceError, match=f"gamepad {path} was closed"):
        until(joystick, lambda _: False)
    with pytest.raises(DeviceError, match="gamepad /nowhere can not be opened: No such file"):
        Joystick(Gamepad(port="/nowhere"))
