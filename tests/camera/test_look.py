"""`launch/look.toml` as its comments say: one # taken away, and `berth run`."""

import json
import secrets
import shutil
from pathlib import Path

import pytest

from runtime.recording import Recording
from tests.cli.running import berth, finish

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.xdist_group("session")


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
    words = ["--only", "camera,vision,recorder", "--duration", "3", "--record", tmp_path / "seen.mcap", "--json"]
    code, out, err = finish(berth("run", launch, *words))
    assert code == 0, err
    assert json.loads(out)["exit_reason"] == "duration"
    recording = Recording(tmp_path / "seen.mcap")
    shown = [logged.decoded().data for logged in recording.messages({"camera/image"})]
    assert len(shown) >= 4
    assert set(shown) <= {file.read_bytes() for file in images.glob("*.jpg")}
    views = [logged.decoded() for logged in recording.messages({"vision/view"})]
    assert len(views) >= 4
    assert not any(view.fault or view.object_visible for view in views)
