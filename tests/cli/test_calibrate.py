"""`berth calibrate colour`: from a picture and from a recording, into a launch file; mistakes are one line."""

import json
import shutil

import cv2
import pytest
from typer.testing import CliRunner

from benchmarks.scenes import Room, decoded
from cli.calibrate import calibrate
from components.simulator.params import Params as WorldParams
from runtime.launch import load
from runtime.params import ConfigurationError
from tests.recorded_session import LAUNCH

DRIVING = LAUNCH.parent.parent / "recordings" / "docking.mcap"


@pytest.fixture
def frame(tmp_path):
    """A picture with the object in its middle, and a point of the stripe."""
    room = Room(WorldParams())
    camera = room.camera(0.2, 1.0)
    file = tmp_path / "frame.jpg"
    file.write_bytes(room.view(camera).data)
    row, _ = room.edge(camera, -60.0, "stripe")
    return file, f"100,{round(row + 119.5)}"


def run(*words, code=0):
    done = CliRunner().invoke(calibrate, ["colour", *map(str, words)])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    assert done.exit_code == code
    return done.stdout


def refused(*words):
    with pytest.raises(ConfigurationError) as error:
        run(*words)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_pointing_at_object_and_stripe_puts_both_colours_into_the_launch_file(frame, tmp_path):
    file, stripe = frame
    launch = shutil.copy(LAUNCH, tmp_path / "mine.toml")
    said = run(file, "--object", "160,120", "--table", stripe, "--launch", launch, "--write", "-o", tmp_path / "a.png")
    params = next(spec for spec in load(launch).components if spec.name == "vision").params
    assert params["object_colour"] == pytest.approx((25, 130, 50), abs=25)
    assert params["table_colour"] == pytest.approx((215, 108, 20), abs=25)
    assert "the object is found" in said
    assert cv2.imread(str(tmp_path / "a.png")).shape == (240, 320, 3)


def test_without_a_stripe_the_edge_is_found_by_lines(frame):
    table = json.loads(run(frame[0], "--object", "155,115,10,10", "--json"))
    assert "table_colour" not in table
    assert table["object"]["pixels"] > 100
    assert table["edge"]["pixels"] > 100


def test_a_frame_of_a_recording_is_written_to_be_pointed_into(tmp_path):
    run(DRIVING, "--at", "5", "-o", tmp_path / "frame.png")
    assert cv2.imread(str(tmp_path / "frame.png")).shape == (240, 320, 3)


def test_a_mistake_is_one_line(frame, tmp_path):
    file, stripe = frame
    assert "--object must be given" in refused(file)
    assert "--object must be U,V or" in refused(file, "--object", "here")
    assert "--object 160,5000: must lie within" in refused(file, "--object", "160,5000")
    assert "--table 160,120: has a colour that" in refused(file, "--object", "160,120", "--table", "160,120")
    assert "--write must stand with --launch" in refused(file, "--object", "160,120", "--write")
    assert "--at must be >= 0" in refused(file, "--object", "160,120", "--at", "nan")
    assert "none.jpg: can not be read" in refused(tmp_path / "none.jpg", "--object", "1,1")
    assert "there is none" in refused(DRIVING, "--at", "1e6", "--object", "1,1")
    (tmp_path / "text.jpg").write_text("no picture", encoding="utf-8")
    assert "must be a picture" in refused(tmp_path / "text.jpg", "--object", "1,1")
    assert decoded(file.read_bytes()).any()
    assert stripe
