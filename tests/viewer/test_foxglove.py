"""The WebSocket for Foxglove, heard by a client of its protocol that is not ours to bend."""

import base64
import json
import os
import re
import signal
import socket
import struct
import time
from pathlib import Path

import pytest

from tests.cli.running import berth, finish

pytest.importorskip("foxglove", reason="the Foxglove SDK is not installed: make setup-view")

from viewer.foxglove_layout import layout
from viewer.foxglove_sink import _translated
from viewer.shown import Lines, Number, Shown

pytestmark = pytest.mark.xdist_group("live")
DOCKING = Path(__file__).parents[2] / "recordings" / "docking.mcap"
DEADLINE_S = 120.0
FRAMES, TEXT, BINARY = 197, 1, 2
MESSAGE, TIME = 1, 2


class Client:
    """Enough of RFC 6455 and of Foxglove's protocol to hear a server."""

    def __init__(self, url):
        host, port = re.fullmatch(r"ws://(.+):(\d+)", url).groups()
        self._socket = socket.create_connection((host, int(port)), timeout=DEADLINE_S)
        key = base64.b64encode(os.urandom(16)).decode()
        self._socket.sendall(
            f"GET / HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n".encode()
        )
        self._stream = self._socket.makefile("rb")
        assert b"101" in self._stream.readline()
        while self._stream.readline().strip():
            pass
        self.channels, self.info, self.states = {}, {}, []

    def tell(self, payload, opcode=TEXT):
        data = payload if isinstance(payload, bytes) else json.dumps(payload).encode()
        mask = os.urandom(4)
        length = bytes([0x80 | len(data)]) if len(data) < 126 else bytes([0xFE]) + struct.pack(">H", len(data))
        self._socket.sendall(
            bytes([0x80 | opcode]) + length + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data))
        )

    def hear(self):
        """(topic, log time, payload) of the next message; what else comes is noted."""
        until_s = time.monotonic() + DEADLINE_S
        while time.monotonic() < until_s:
            first, second = self._stream.read(2)
            length = second & 0x7F
            if length >= 126:
                length = int.from_bytes(self._stream.read(2 if length == 126 else 8), "big")
            data = self._stream.read(length)
            if first & 0x0F == TEXT:
                self._note(json.loads(data))
            elif first & 0x0F == BINARY and data[0] == MESSAGE:
                number, log_ns = struct.unpack_from("<IQ", data, 1)
                return self.subscribed[number], log_ns, data[13:]
            elif first & 0x0F == BINARY:
                self.states.append(data)
        raise AssertionError("silence")

    def _note(self, words):
        if words["op"] == "serverInfo":
            self.info = words
        for channel in words.get("channels", []) if words["op"] == "advertise" else []:
            self.channels[channel["topic"]] = channel
            number = len(self.channels)
            self.subscribed = {**getattr(self, "subscribed", {}), number: channel["topic"]}
            self.tell({"op": "subscribe", "subscriptions": [{"id": number, "channelId": channel["id"]}]})

    def control(self, *, plays, speed, seek_ns=None, name="a"):
        seek = struct.pack("<BQ", seek_ns is not None, seek_ns or 0)
        words = name.encode()
        self.tell(
            struct.pack("<BBf", 3, 0 if plays else 1, speed) + seek + struct.pack("<I", len(words)) + words, BINARY
        )

    def until(self, condition):
        while not condition(heard := self.hear()):
            pass
        return heard


@pytest.fixture
def client():
    serving = berth("view", DOCKING, "--foxglove", "--port", "0")
    try:
        yield Client(re.search(r"ws://\S+", serving.stderr.readline())[0])
    finally:
        serving.send_signal(signal.SIGINT)
    assert finish(serving)[0] == 0


def test_a_recording_is_played_paused_and_sought_by_the_clients_controls(client):
    client.control(plays=True, speed=50.0)
    _, first_ns, image = client.until(lambda heard: heard[0] == "/camera/image")
    assert b"\xff\xd8" in image
    start_ns = int(client.info["dataStartTime"]["sec"]) * 10**9 + int(client.info["dataStartTime"]["nsec"])
    assert "playbackControl" in client.info["capabilities"]
    assert first_ns >= start_ns
    client.control(plays=True, speed=50.0, seek_ns=start_ns + 20 * 10**9)
    _, _, text = client.until(lambda heard: heard[0] == "/session/page" and heard[1] > start_ns + 20 * 10**9)
    assert "robot minutes" in json.loads(text)["text"]
    client.control(plays=True, speed=50.0, seek_ns=start_ns)
    client.until(lambda heard: heard[0] == "/head/pan_deg" and heard[1] < start_ns + 2 * 10**9)
    assert {"/plan", "/camera/image/object", "/pilot/mode"} <= set(client.channels)


def test_every_topic_of_the_layout_that_a_docking_has_is_a_topic_of_the_socket(client):
    client.control(plays=True, speed=100.0)
    client.until(lambda heard: heard[0] == "/learning/lc")
    named = set(re.findall(r'"(/[a-z_/]+?)(?:\.[a-z]+)?"', layout().to_json()))
    missing = {topic for topic in named if topic not in client.channels}
    assert {
        topic for topic in missing if not topic.startswith(("/policy", "/latency_ms", "/lost", "/learning"))
    } == set()


def test_the_layout_is_written_once(tmp_path):
    file = tmp_path / "berth.json"
    from viewer.foxglove_layout import write  # noqa: PLC0415

    write(file)
    assert "/camera/image" in json.dumps(json.loads(file.read_text()))


def test_a_number_is_json_and_a_line_of_the_plan_an_entity_of_the_scene():
    from foxglove.messages import Timestamp  # noqa: PLC0415

    stamp = Timestamp(sec=1, nsec=0)
    topic, _, message = _translated(Shown("head/pan_deg", 5, Number(1.5)), stamp)
    assert (topic, message) == ("/head/pan_deg", {"value": 1.5})
    topic, _, update = _translated(Shown("plan/robot", 5, Lines((((0.0, 1.0), (2.0, 3.0)),), (255, 0, 0, 255))), stamp)
    assert topic == "/plan"
    assert b"plan/robot" in update.encode()
