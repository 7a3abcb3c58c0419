"""`launch/look.toml` as its comments say: one # taken away, and `berth run`."""

import secrets
import shutil
import time
from collections import deque
from pathlib import Path

import pytest

from cli.on_bus import _take_all
from cli.progress import Progress
from cli.session import Watch
from runtime.launch import load
from runtime.recording import Recording
from runtime.supervise import Supervisor
from schemas.session_pb2 import RecorderAck

ROOT = Path(__file__).parents[2]
DEADLINE_S = 90.0


@pytest.mark.xdist_group("session")
def test_a_folder_of_images_is_looked_at_and_recorded(tmp_path):
    images = tmp_path / "images"
    shutil.copytree(ROOT / "tests" / "photographs", images)
    text = (ROOT / "launch" / "look.toml").read_text(encoding="utf-8")
    for before, after in (
        ('"berth/look"', f'"test/{secrets.token_hex(6)}"'),
        ('# device = { kind = "folder", port = "images"', f'device = {{ kind = "folder", port = "{images}"'),
    ):
        assert before in text
        text = text.replace(before, after)
    launch = tmp_path / "look.toml"
    launch.write_text(text, encoding="utf-8")
    supervisor, views = Supervisor(load(launch, recording=tmp_path / "seen.mcap")), []
    supervisor.watch("vision/view", lambda view, _: views.append(view))
    until_s = time.monotonic() + DEADLINE_S
    with supervisor:
        while len(views) < 12:
            assert supervisor.poll(0.05), supervisor.end_reason
            assert time.monotonic() < until_s, supervisor.missing
        supervisor.stop()
    assert not any(view.fault or view.object_visible for view in views)
    shown = {logged.decoded().data for logged in Recording(tmp_path / "seen.mcap").messages({"camera/image"})}
    assert len(shown) >= 4
    assert shown <= {file.read_bytes() for file in images.glob("*.jpg")}


def test_where_nobody_tells_of_trials_the_recorder_tells_how_long_the_session_is():
    watch = Watch(Progress("", quiet=True))
    _take_all(watch, deque([(RecorderAck(messages=7), 3_000_000_000), (RecorderAck(messages=8), 2_000_000_000)]))
    assert (watch.board.robot_s, watch.messages) == (3.0, 8)
