"""Commands and pictures between two machines by the routers of the bus, without a robot: how old a command is.

The robot says its state and a camera's pictures; the laptop answers each state with a command and acknowledges each
picture. All ages are of the robot's clock, there and back.

    python -m benchmarks.probe robot ADDRESS    a Load per line on standard input, an Aged per line on standard output
    python -m benchmarks.probe laptop ADDRESS   until standard input ends
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable
from typing import NamedTuple

import cv2
import numpy as np
import zenoh

from benchmarks.machines import ROBOT_ADDRESS, Cable, Machine
from benchmarks.watched import START_S, wait_until
from components.preview.component import Preview
from components.preview.ports import Params
from runtime.bus import direct, free_endpoint, open_peer, open_router
from runtime.contract import Event, Kind
from runtime.link import Link
from runtime.qos import qos
from schemas.image_pb2 import CompressedImage

STATE, DRIVE, IMAGE, ACK = (f"probe/{name}" for name in ("state", "drive", "image", "ack"))
_STATE_HZ, _IMAGE_HZ = 25.0, 15.0
_STATE_BYTES = 48
_SETTLE_S = 2.0
"""After the last message; what has not come back by then is lost."""
_LAST_MS = 1e4


class Load(NamedTuple):
    """What crosses the link."""

    seconds: float
    pictures: str = "none"
    """`none`, `preview` or `all`: as they are."""


class Aged(NamedTuple):
    """What came back."""

    sent: int
    ages_ms: list[float]
    """Of each command, from the state that it answers."""
    pictures: int
    """Acknowledged."""
    picture_bytes: float
    """Mean of those sent."""
    picture_ms: float
    """Median, from sending to acknowledgement."""

    def percentile_ms(self, percent: float) -> float:
        """Age that so many commands do not exceed; those that never came back are older than all."""
        lost = [_LAST_MS] * (self.sent - len(self.ages_ms))
        return float(np.percentile([*self.ages_ms, *lost], percent, method="higher"))


class Probe:
    """Both ends, seen from outside."""

    def __init__(self, cable: Cable) -> None:
        """Start both and wait until the first command has come back."""
        self._robot, self._laptop = (_started(machine) for machine in (cable.robot, cable.laptop))
        deadline_s = time.monotonic() + START_S
        while not self.aged(Load(0.2)).ages_ms:
            assert time.monotonic() < deadline_s, "the link does not come up"

    def aged(self, load: Load) -> Aged:
        """Send for a while."""
        assert self._robot.stdin is not None
        assert self._robot.stdout is not None
        self._robot.stdin.write(json.dumps(load._asdict()) + "\n")
        self._robot.stdin.flush()
        line = self._robot.stdout.readline()
        assert line, self._robot.communicate()
        return Aged(**json.loads(line))


def _started(machine: Machine) -> subprocess.Popen[str]:
    return machine.run(sys.executable, "-m", "benchmarks.probe", machine.host, ROBOT_ADDRESS)


class Robot:
    """Speaks, and notes what comes back."""

    def __init__(self, session: zenoh.Session) -> None:
        """Declare everything."""
        self._state, self._image = (_publisher(session, *what) for what in ((STATE, Kind.STATE), (IMAGE, Kind.IMAGE)))
        self._ages_ms: list[float] = []
        self._acks: list[tuple[int, int]] = []
        session.declare_subscriber(DRIVE, direct(lambda sample: self._ages_ms.append(_age_ms(sample))))
        session.declare_subscriber(ACK, direct(self._acknowledged))
        self._picture = CompressedImage(format="jpeg", data=photograph())
        self._preview = Preview(Params(), 0)

    def _acknowledged(self, sample: zenoh.Sample) -> None:
        self._acks.append((_stamp(sample), time.monotonic_ns()))

    def speak(self, load: Load) -> Aged:
        """Send for a while, then wait for what is still under way."""
        self._ages_ms.clear()
        self._acks.clear()
        began_s, states, sizes, acked = time.monotonic(), 0, list[int](), 0
        frames = 0
        while (now_s := time.monotonic() - began_s) < load.seconds:
            while acked < len(self._acks):
                capture_ns, at_ns = self._acks[acked]
                self._preview.handle(Event(at_ns, "ack", None, capture_ns))
                acked += 1
            if now_s * _STATE_HZ >= states:
                self._state.put(_now().ljust(_STATE_BYTES, b"\0"))
                states += 1
            if load.pictures != "none" and now_s * _IMAGE_HZ >= frames:
                frames += 1
                sizes += self._show(adapted=load.pictures == "preview")
            time.sleep(0.002)
        wait_until(lambda: len(self._ages_ms) >= states, _SETTLE_S)
        picture_ms = [(at_ns - sent_ns) / 1e6 for sent_ns, at_ns in list(self._acks)] or [0.0]
        mean_bytes = float(np.mean(sizes)) if sizes else 0.0
        return Aged(states, list(self._ages_ms), len(self._acks), mean_bytes, float(np.median(picture_ms)))

    def _show(self, *, adapted: bool) -> list[int]:
        """Sizes of what was sent."""
        now_ns = time.monotonic_ns()
        if not adapted:
            self._image.put(now_ns.to_bytes(8, "little") + self._picture.data)
            return [len(self._picture.data)]
        said = self._preview.handle(Event(now_ns, "image", self._picture, now_ns))
        for output in said:
            self._image.put(now_ns.to_bytes(8, "little") + output.message.data)
        return [len(output.message.data) for output in said]


def photograph() -> bytes:
    """A JPEG of 640 x 480 px, 40 kB: soft noise, from a fixed seed."""
    noise = np.random.default_rng(1).integers(0, 255, (480, 640, 3), np.uint8)
    done, data = cv2.imencode(".jpg", cv2.GaussianBlur(noise, (0, 0), 4.0), [cv2.IMWRITE_JPEG_QUALITY, 95])
    assert done
    return bytes(data.tobytes())


def _publisher(session: zenoh.Session, key: str, kind: Kind) -> zenoh.Publisher:
    how = qos(kind, "real")
    return session.declare_publisher(key, priority=how.priority, congestion_control=how.congestion)


def _now() -> bytes:
    return time.monotonic_ns().to_bytes(8, "little")


def _stamp(sample: zenoh.Sample) -> int:
    return int.from_bytes(sample.payload.to_bytes()[:8], "little")


def _age_ms(sample: zenoh.Sample) -> float:
    return (time.monotonic_ns() - _stamp(sample)) / 1e6


def _answering(publisher: zenoh.Publisher) -> Callable[[zenoh.Sample], None]:
    return lambda sample: publisher.put(sample.payload.to_bytes()[:_STATE_BYTES])


def _answer(session: zenoh.Session) -> None:
    """The laptop: until standard input ends."""
    session.declare_subscriber(STATE, direct(_answering(_publisher(session, DRIVE, Kind.COMMAND))))
    session.declare_subscriber(IMAGE, direct(_answering(_publisher(session, ACK, Kind.EVENT))))
    sys.stdin.read()


def main() -> None:
    """Be one end."""
    role, address = sys.argv[1:3]
    endpoint, there = free_endpoint(), f"tcp/{address}:7447"
    link = Link(there) if role == "robot" else Link("", there)
    with open_router(endpoint, link, "real"), open_peer(endpoint) as session:
        if role == "laptop":
            _answer(session)
            return
        robot = Robot(session)
        for line in sys.stdin:
            print(json.dumps(robot.speak(Load(**json.loads(line)))._asdict()), flush=True)


if __name__ == "__main__":
    main()
