"""The robot's auxiliary port as a socket for another process of the same user."""

import socket
import stat
from collections import deque

import pytest

from components.base.devices.aux_socket import AuxSocket
from runtime.contract import DeviceError


class Client:
    def __init__(self):
        self.answers = deque()
        self.asked = []

    def ask(self, content, answer_bytes):
        self.asked.append((content, answer_bytes))


@pytest.fixture
def path(tmp_path):
    return tmp_path / "aux"


def guest_of(path):
    guest = socket.socket(socket.AF_UNIX)
    guest.settimeout(30.0)
    guest.connect(str(path))
    return guest


def test_requests_go_to_the_robot_however_they_are_cut_and_answers_come_back(path):
    aux, client = AuxSocket(str(path)), Client()
    with guest_of(path) as guest:
        for part in (b"\x06", b"\x03abc\x0e\x01", b"d"):
            guest.sendall(part)
            aux.exchange(client)
        assert client.asked == [(b"abc", 6), (b"d", 14)]
        client.answers.append(b"yes")
        aux.exchange(client)
        assert guest.recv(16) == b"yes"
    aux.exchange(client)
    with guest_of(path) as second:
        second.sendall(b"\x00\x01e")
        aux.exchange(client)
        aux.exchange(client)
        assert client.asked[-1] == (b"e", 0)
    aux.close()
    assert not path.exists()


def test_only_its_user_may_open_it(path):
    aux = AuxSocket(str(path))
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    aux.close()


def test_one_that_was_left_behind_is_replaced_and_a_file_never_is(path):
    AuxSocket(str(path))
    AuxSocket(str(path)).close()
    path.write_text("mine")
    with pytest.raises(DeviceError, match="can not be made"):
        AuxSocket(str(path))
    assert path.read_text() == "mine"
