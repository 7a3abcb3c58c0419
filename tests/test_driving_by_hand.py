"""A person at a real terminal drives the simulated robot with keys, lets go, drives again, and closes the terminal."""

import contextlib
import json
import os
import pty
import secrets
import select
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from benchmarks.watched import START_S, Bystander, children, is_alive, wait_until
from runtime.bus import open_peer
from runtime.recording import Recording
from runtime.replay import replay

pytestmark = pytest.mark.xdist_group("live")
ROOT = Path(__file__).parent.parent
COMPONENTS = "simulator,head,base,teleop,recorder"
IN_THE_TERMINAL = (
    "import fcntl, os, sys, termios; os.setsid(); fcntl.ioctl(0, termios.TIOCSCTTY, 0); "
    "os.execv(sys.executable, [sys.executable, '-c', 'from cli.main import main; main()', *sys.argv[1:]])"
)
SOON_S = 10.0
"""Of a busy test machine; how long a key counts is tested by the clock of the session below."""


class Person:
    """A terminal with `berth run launch/teleop.toml` in it, and hands on its keys."""

    def __init__(self, directory):
        self.realm = f"test/{secrets.token_hex(6)}"
        self.recording = directory / "hand.mcap"
        launch = directory / "teleop.toml"
        text = (ROOT / "launch" / "teleop.toml").read_text(encoding="utf-8")
        launch.write_text(text.replace('"berth/teleop"', f'"{self.realm}"'), encoding="utf-8")
        self._home = directory / "run"
        self._home.mkdir(mode=0o700)
        self._master, slave = pty.openpty()
        words = ["run", str(launch), "--only", COMPONENTS, "--record", str(self.recording)]
        self.process = subprocess.Popen(
            [sys.executable, "-c", IN_THE_TERMINAL, *words],
            cwd=ROOT,
            env={**os.environ, "XDG_RUNTIME_DIR": str(self._home), "TERM": "xterm"},
            stdin=slave,
            stdout=slave,
            stderr=slave,
        )
        os.close(slave)
        self.shown = b""
        self._leaves = threading.Event()
        self._eyes = threading.Thread(target=self._look)
        self._eyes.start()

    def _look(self):
        while not self._leaves.is_set():
            if select.select([self._master], [], [], 0.05)[0]:
                with contextlib.suppress(OSError):
                    self.shown += os.read(self._master, 65536)

    def endpoint(self):
        """Of the running system."""
        found = {}

        def is_there():
            file = self._home / "berth" / f"{self.realm.replace('/', '+')}.run.json"
            with contextlib.suppress(OSError, ValueError):
                found.update(json.loads(file.read_text(encoding="utf-8")))
            return bool(found) or self.process.poll() is not None

        assert wait_until(is_there, START_S)
        assert found, self.shown.decode(errors="replace")
        return found["endpoint"]

    def holds(self, key, condition, timeout_s):
        """Hold a key, as a keyboard repeats it, until a condition is true; returns when it was pressed last."""
        until_s = time.monotonic() + timeout_s
        while not condition() and time.monotonic() < until_s:
            os.write(self._master, key)
            time.sleep(0.03)
        assert condition(), self.shown[-3000:].decode(errors="replace")
        return time.monotonic_ns()

    def leaves(self):
        """Close the terminal."""
        if not self._leaves.is_set():
            self._leaves.set()
            self._eyes.join()
            os.close(self._master)


@pytest.fixture
def person(tmp_path):
    found = Person(tmp_path)
    yield found
    found.leaves()
    found.process.kill()
    found.process.wait()


def test_a_robot_driven_by_keys_stops_when_they_are_released_and_when_the_terminal_is_closed(person):
    with open_peer(person.endpoint()) as session:
        seen = Bystander(session, person.realm)
        person.holds(b"i", seen.drives, START_S)
        released_ns = person.holds(b"i", lambda: b"teleop, +0.10 m/s" in person.shown, SOON_S)
        assert wait_until(lambda: seen.first_zero(released_ns), SOON_S)
        assert wait_until(seen.rests, SOON_S)
        person.holds(b"u", lambda: seen.drives() and seen.commands[-1].omega_radps > 0.0, SOON_S)
        pids = children(person.process.pid)
        closed_ns = time.monotonic_ns()
        person.leaves()
        assert wait_until(lambda: seen.first_zero(closed_ns), SOON_S)
        assert wait_until(lambda: not any(map(is_alive, pids.values())), SOON_S)
        assert person.process.wait(SOON_S) is not None
    assert set(pids) == set(COMPONENTS.split(","))
    the_log_tells(Recording(person.recording))


def the_log_tells(recording):
    """Everything is in the file: the keys, who drove, that no motion outlived its key, and the rest at the end."""
    assert recording.whole()
    applied = [(m.time_ns, m.decoded()) for m in recording.messages({"base/applied"})]
    assert {"teleop"} <= {message.commander for _, message in applied} <= {"teleop", "none", "gone", "stale", "stop"}
    assert applied[-1][1].v_mps == 0.0
    keys = [m.capture_ns for m in recording.messages({"teleop/device"})]
    for message in recording.messages({"teleop/drive"}):
        if message.decoded().v_mps:
            assert min(message.time_ns - key for key in keys if key <= message.time_ns) < 1_000_000_000
    assert not replay(recording, "teleop").differs
    assert not replay(recording, "base").differs
