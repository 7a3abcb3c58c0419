"""The report: one page that needs nothing else, whatever the session was and however its file ended."""

import re
import time

import numpy as np
import pytest

from cli.report import write_report
from report.session import read
from runtime.log import LogWriter
from runtime.params import ConfigurationError
from runtime.recording import Recording
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.trial_pb2 import Trial
from schemas.truth_pb2 import Truth
from tests.recorded_session import ROOT, record
from tests.runtime.offline import rewritten, without

pytestmark = pytest.mark.xdist_group("session")
FOLDER = ROOT / "recordings"
FRAME_NS = 125_000_000


@pytest.fixture(scope="module")
def page(twins, tmp_path_factory) -> str:
    """Of the learning session."""
    file, _ = write_report(twins.first, tmp_path_factory.mktemp("page") / "page.html")
    return file.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def short(tmp_path_factory):
    """Two seconds, without a trial, its chunks readable byte by byte."""
    file = tmp_path_factory.mktemp("short") / "short.mcap"
    words = ["pilot.train_s=0", "pilot.evaluation_trials=1", "recorder.compression=none", "recorder.chunk_bytes=4096"]
    return file, record(file, words, duration_s=2.0)


def headings(text: str) -> list[str]:
    return re.findall(r"<h2>(.*?)</h2>", text)


def is_self_contained(text: str) -> bool:
    sources = re.findall(r"(?:src|href)\s*=\s*['\"]?([^'\" >]*)", text)
    return all(re.match(r"data:image/(png|jpeg);base64,", source) for source in sources) and not re.search(
        r"https?:|<script|<link|@import|url\(", text
    )


def test_the_page_needs_nothing_from_elsewhere(page):
    assert is_self_contained(page)
    assert not is_self_contained("<img src='http://a/b.png'>")
    assert not is_self_contained("<img src=b.png>")
    assert not is_self_contained("<svg><image href='b.png'/></svg>")


def test_the_page_has_its_sections_and_pictures(page):
    assert headings(page) == [
        "Learning",
        "Docking",
        "What went wrong",
        "What was learned",
        "What the robot saw",
        "Latency",
        "Messages",
        "Configuration",
    ]
    assert page.count("<svg") >= 8
    assert page.count("<img") == 4, "approach, servo, grasp, reverse"
    assert all(re.search(r"aria-label='[^']{20,}", chart) for chart in page.split("<svg")[1:])


def test_four_questions_are_answered_first(page):
    tiles = re.findall(r"<div class='tile (\w+)'>(.*?)<b>(.*?)</b>", page)
    assert [question for _, question, _ in tiles] == [
        "Did it learn?",
        "Does it dock?",
        "How fast?",
        "What went wrong?",
    ]
    assert tiles[1][0] == "fair", "one docking does not show that it docks well"
    assert tiles[1][2].endswith("1 of 1")


def test_the_page_says_that_the_session_is_complete_and_what_it_holds(page, twins):
    assert "complete" in page
    assert "no message lost" in page
    assert "torn" not in page
    session = read(twins.first)
    assert f"<td>camera/image</td><td class=n>{session.counts['camera/image']}</td>" in page
    rows = dict(re.findall(r"<tr><td>(\w+)</td><td class=n>\d+</td><td class=n>(\d+)</td></tr>", page))
    assert [rows[name] for name in ("trials", "reached", "docked", "picked")] == ["1", "1", "1", "1"]


def test_tracking_is_compared_with_the_truth_of_the_same_frame(twins):
    session = read(twins.first)
    assert len(session.tracking_px) == len(session.bearing_error_rad) > 400
    assert np.percentile(session.bearing_error_rad, 95) < np.radians(2)


def test_a_session_without_trials_has_a_page(short, tmp_path):
    file, _ = write_report(short[0], tmp_path / "short.html")
    text = file.read_text(encoding="utf-8")
    assert is_self_contained(text)
    assert "It did not train in this session" in text
    assert "No trial ended in this session." in text
    assert "No policy was published in this session." in text
    assert headings(text)[0] == "Learning"


def test_a_session_without_truth_is_told_by_the_robot_itself(tmp_path):
    file = rewritten(FOLDER / "docking.mcap", tmp_path / "real.mcap", without("simulator/truth"))
    (trial,) = read(file).trials
    page, _ = write_report(file)
    text = page.read_text(encoding="utf-8")
    assert (trial.docked, trial.picked) == (True, True)
    assert len(trial.path) > 80
    assert "No ground truth is in the file: outcomes are what the robot itself tells." in text
    assert "camera heights" in text
    assert "Tracking" not in text
    assert "Accuracy" not in text


def test_a_torn_session_has_a_page_that_says_so(twins, tmp_path):
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(twins.first.read_bytes()[:3_000_000])
    file, _ = write_report(torn)
    text = file.read_text(encoding="utf-8")
    assert file == tmp_path / "torn.html"
    assert "torn: the end of the file is missing" in text
    assert is_self_contained(text)
    assert 0 < read(torn).robot_s < read(twins.first).robot_s
    assert not read(torn).whole


def test_a_file_that_is_no_session_is_refused(tmp_path):
    (tmp_path / "x.mcap").write_bytes(b"\x89MCAP0\r\n")
    with pytest.raises(ConfigurationError, match="must be a session of ours; it holds no launch file"):
        read(tmp_path / "x.mcap")


def test_names_in_a_session_are_text_not_markup(short, tmp_path):
    _, system = short
    file = tmp_path / "<u>bold.mcap"
    log = LogWriter(file, system, started="<script>alert(1)</script>")
    log.write("<i>topic</i>/x", "berth.Truth", b"", 1, 0, 0, 0)
    log.close()
    page, _ = write_report(file)
    text = page.read_text(encoding="utf-8")
    assert is_self_contained(text)
    assert "<i>" not in text
    assert "<u>" not in text


def strange(system, file, number: int):
    """A well-formed file of well-formed messages with absurd contents, from a seed."""
    chance = np.random.default_rng([2011, number])
    log = LogWriter(file, system, started="")
    for frame in range(40):
        values = [0.0, 1.0, -3.0, 1e300, -1e300, 1e-300, *([np.nan, np.inf, -np.inf] if frame % 4 == 0 else [])]
        x_m, y_m, heading_rad, v_mps, alpha_rad, u_px = chance.choice(values, 6)
        phase, mode, outcome = (int(chance.integers(names)) for names in (2, 5, 9))
        if frame % 8 == 0:
            phase, mode, outcome = 3, 9, 12  # none of ours
        trial = Trial(phase=phase, mode=mode, outcome=outcome, number=frame // 3, ended=frame // 3)
        truth = Truth(x_m=x_m, y_m=y_m, heading_rad=heading_rad, v_mps=v_mps, alpha_rad=alpha_rad, object_u_px=u_px)
        percept = Percept(visible=True, pan_rad=u_px)
        policy = Policy(version=frame, beta_cells=int(chance.integers(0, 40)), action=bytes(int(chance.integers(9))))
        for topic, message in (
            ("tracker/percept", percept),
            ("pilot/trial", trial),
            ("simulator/truth", truth),
            ("learner/policy", policy),
        ):
            log.write(topic, message.DESCRIPTOR.full_name, message.SerializeToString(), 1, frame, frame * FRAME_NS, 0)
    log.close()


def test_absurd_messages_make_a_page(short, tmp_path):
    began_s = time.monotonic()
    for number in range(2):
        file = tmp_path / f"{number}.mcap"
        strange(short[1], file, number)
        page, _ = write_report(file)
        assert is_self_contained(page.read_text(encoding="utf-8"))
        assert read(file).trials
    assert time.monotonic() - began_s < 60


def test_hostile_bytes_make_a_session_or_one_line(short, tmp_path):
    data, file, began_s = short[0].read_bytes(), tmp_path / "hostile.mcap", time.monotonic()
    read_at_all = 0
    for number in range(200):
        chance = np.random.default_rng([2019, number])
        changed = bytearray(data)
        for place in chance.integers(8, len(data), size=int(chance.integers(1, 40))):
            changed[place] = int(chance.integers(256))
        file.write_bytes(changed[: int(chance.integers(8, len(data)))] if number % 2 else changed)
        try:
            read_at_all += read(file).messages > 0
            Recording(file).topics()
        except ConfigurationError:
            continue
    assert read_at_all > 20
    assert time.monotonic() - began_s < 60


def test_a_page_that_can_not_be_written_is_named(short, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(ConfigurationError, match=r"file/page\.html: can not be written: Not a directory"):
        write_report(short[0], tmp_path / "file" / "page.html")
