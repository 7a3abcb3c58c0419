"""The page on one's own robot, followed to the letter for a toy."""

import contextlib
import os
import re
import secrets
import signal
import sys
import threading
import time
import tomllib
import tty
from pathlib import Path

import pytest

from docking import plant
from runtime.launch import load
from runtime.supervise import Supervisor
from tests.runtime.system import run_until

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "own-robot.md"
DEADLINE_S = 30.0


class Toy:
    """The other end of the toy's cable: obeys lines of text for ever, whoever says them."""

    def __init__(self):
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.port = os.ttyname(self._slave)
        self.pose, self.twist = (0.0, 0.0, 0.0), (0.0, 0.0)
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._live, daemon=True)
        self._thread.start()

    def _live(self):
        heard, before_s = b"", time.monotonic()
        while not self._done.wait(0.02):
            with contextlib.suppress(BlockingIOError):
                heard += os.read(self._master, 4096)
            *lines, heard = heard.split(b"\n")
            for line in lines:
                self.twist = tuple(map(float, line.split()))
            now_s = time.monotonic()
            self.pose = plant.advance(*self.pose, *self.twist, now_s - before_s)
            before_s = now_s
            os.write(self._master, b"%.4f %.4f %.4f\n" % self.pose)

    def close(self):
        self._done.set()
        self._thread.join()
        os.close(self._master)
        os.close(self._slave)


@pytest.fixture
def toy():
    found = Toy()
    yield found
    found.close()


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """`my_robot` as on the page; here it is not beside `components`, so it must be found."""
    blocks = re.findall(r"```python\n# (my_robot/\w+\.py)\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert [name for name, _ in blocks] == ["my_robot/toy.py", "my_robot/ports.py", "my_robot/component.py"]
    (tmp_path / "my_robot").mkdir()
    for name, content in blocks:
        (tmp_path / name).write_text(content, encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    yield tmp_path
    for name in [name for name in sys.modules if name.split(".")[0] == "my_robot"]:
        del sys.modules[name]


def launch_of(folder, toy):
    (block,) = re.findall(r'```toml\n(\[component\.base\]\nrun = "my_robot".*?)```', PAGE.read_text("utf-8"), re.DOTALL)
    tomllib.loads(block)
    block = block.replace("/dev/ttyUSB0", toy.port).replace(' grasper = "grasper/drive",', "")
    file = folder / "toy.toml"
    file.write_text(f"""
realm = "test/{secrets.token_hex(6)}"
[session]
clock = "real"
[component.pilot]
run = "tests.pioneer.commander"
{block}
params = {{ commanders = ["pilot"] }}
""")
    return load(file)


def test_the_toy_of_the_page_is_driven_and_rests_when_its_driver_is_killed(folder, toy):
    with Supervisor(launch_of(folder, toy)) as supervisor:
        run_until(supervisor, lambda: toy.pose[0] > 0.02)
        assert toy.twist == (0.1, 0.0)
        os.kill(supervisor.pids["base"], signal.SIGKILL)
        run_until(supervisor, lambda: False)
        end_s = time.monotonic() + DEADLINE_S
        while toy.twist != (0.0, 0.0):
            assert time.monotonic() < end_s
            time.sleep(0.01)


def test_the_toy_of_the_page_rests_at_the_end_of_a_session(folder, toy):
    with Supervisor(launch_of(folder, toy)) as supervisor:
        run_until(supervisor, lambda: toy.twist[0] > 0.0)
        supervisor.stop()
        assert supervisor.deaths == []
    end_s = time.monotonic() + DEADLINE_S
    while toy.twist != (0.0, 0.0):
        assert time.monotonic() < end_s
        time.sleep(0.01)
