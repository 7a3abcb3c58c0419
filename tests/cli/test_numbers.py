"""What the verbs print: for people one screen, with --json one object that has exactly the promised keys."""

import json
import sys

import pytest

from cli.main import VERBS, main
from runtime.launch import load
from runtime.recording import Recording
from tests.recorded_session import LAUNCH

pytestmark = pytest.mark.xdist_group("session")
SUMMARY = [
    "robot_s",
    "wall_s",
    "messages",
    "lost",
    "refused",
    "trials",
    "docked",
    "picked",
    "collisions",
    "recording",
    "report",
    "exit_reason",
]


@pytest.fixture
def berth(monkeypatch, capsys):
    """Calls the command line; returns (exit code, standard output)."""

    def call(*words: object) -> tuple[int, str]:
        monkeypatch.setattr(sys, "argv", ["berth", *map(str, words)])
        with pytest.raises(SystemExit) as exit_:
            main()
        out, err = capsys.readouterr()
        assert "Traceback" not in err
        return int(exit_.value.code or 0), out

    return call


def test_run_ends_with_one_object_of_the_promised_keys(berth, tmp_path):
    file = tmp_path / "two.mcap"
    code, out = berth("run", LAUNCH, "--in-process", "--duration", "2", "--record", file, "--json")
    summary = json.loads(out)
    assert code == 0
    assert list(summary) == SUMMARY
    assert summary["exit_reason"] == "duration"
    assert summary["robot_s"] == pytest.approx(2.0, abs=0.125)
    assert summary["lost"] == 0
    assert summary["recording"] == str(file)
    assert summary["report"] == "", "no trial, nothing to report"
    assert summary["messages"] == sum(1 for _ in Recording(file).messages())


def test_run_without_a_recording_makes_no_file(berth, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out = berth("run", LAUNCH, "--in-process", "--duration", "0.5", "--no-record", "--json")
    assert (code, json.loads(out)["recording"]) == (0, "")
    assert list(tmp_path.iterdir()) == []


def test_info_counts_what_is_in_the_file(berth, twins):
    code, out = berth("info", twins.first, "--json")
    numbers = json.loads(out)
    assert code == 0
    assert (numbers["state"], numbers["lost"]) == ("complete", 0)
    assert (numbers["realm"], numbers["clock"], numbers["seed"]) == ("berth/sim", "lockstep", "1")
    assert numbers["started"] == "started for first"
    assert numbers["messages"] == sum(topic["count"] for topic in numbers["topics"])
    assert numbers["docked"] >= numbers["picked"] >= 1
    assert numbers["trials"] >= numbers["reached"] >= numbers["docked"]
    topics = {topic["topic"]: topic for topic in numbers["topics"]}
    assert topics["camera/image"]["schema"] == "foxglove.CompressedImage"


def test_info_of_a_torn_file_is_exit_code_3(berth, twins, tmp_path):
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(twins.first.read_bytes()[:1_000_000])
    code, out = berth("info", torn, "--json")
    assert code == 3
    assert json.loads(out)["state"].startswith("torn; byte ")
    code, out = berth("info", torn)
    assert code == 3
    assert "torn" in out


def test_graph_shows_every_wire_in_every_form(berth):
    code, out = berth("graph", LAUNCH, "--json")
    table = json.loads(out)
    system = load(LAUNCH)
    assert code == 0
    assert table["components"] == [spec.name for spec in system.components]
    found = {(wire["target"], wire["input"], wire["key"]) for wire in table["wires"]}
    wired = {(spec.name, port, key) for spec in system.components for port, key in spec.inputs.items()}
    assert found == {wire for wire in wired if wire[1] != "ack"}, "the recorder is there only when it records"
    _, mermaid = berth("graph", LAUNCH, "--mermaid")
    assert mermaid.startswith("flowchart LR\n")
    assert "  vision -- vision/view --> tracker\n" in mermaid
    assert mermaid.count("-->") == len(found)
    _, text = berth("graph", LAUNCH)
    assert "vision/view" in text
    assert "-> tracker.view" in text
    assert next(line for line in text.splitlines() if "simulator/truth" in line).endswith("recorded only")


def test_check_tells_what_is_kept_and_fails_if_something_is_broken(berth, tmp_path):
    text = """
realm = "test/faulty"
[component.world]
run = "tests.runtime.parts.world"
inputs = { drive = "faulty/drive" }
[component.faulty]
run = "tests.runtime.parts.faulty"
inputs = { image = "world/image" }
params = { fault = "twice" }
"""
    (tmp_path / "twice.toml").write_text(text, encoding="utf-8")
    code, out = berth("check", tmp_path / "twice.toml", "--duration", "1", "--json")
    table = json.loads(out)
    assert (code, table["kept"]) == (1, False)
    broken = [(f["component"], f["rule"]) for f in table["findings"] if not f["kept"]]
    assert broken == [("faulty", "drive answers every frame once")]
    assert {"python", "numpy", "processor"} <= set(table["fingerprint"])
    assert berth("check", "--json")[0] == 0


def test_report_says_where_its_page_is(berth, twins, tmp_path):
    code, out = berth("report", twins.first, "-o", tmp_path / "page.html", "--json")
    assert code == 0
    assert json.loads(out)["report"] == str(tmp_path / "page.html")
    assert json.loads(out)["picked"] == 1
    assert (tmp_path / "page.html").exists()


def test_two_recordings_are_compared(berth, tmp_path):
    files = [LAUNCH.parent.parent / "recordings" / f"{name}.mcap" for name in ("reverse", "lost")]
    code, out = berth("report", *files, "-o", tmp_path / "page.html", "--json")
    told = json.loads(out)
    assert code == 0
    assert (told["A"]["file"], told["B"]["file"]) == tuple(map(str, files))
    assert told["different"]["pilot.lost_s"] == ["15", "1"]
    assert (tmp_path / "page.html").exists()


@pytest.mark.parametrize("words", [("--help",), ("-h",)])
def test_help_fits_a_screen(berth, words):
    code, out = berth(*words)
    lines = out.rstrip("\n").splitlines()
    assert code == 0
    assert len(lines) <= 40
    assert max(map(len, lines)) <= 80


def test_help_lists_exactly_the_verbs_that_there_are(berth):
    _, out = berth("--help")
    listed = [line.split()[0] for line in out.partition("Commands:")[2].splitlines() if line.startswith("  ")]
    assert listed == [verb for verb in VERBS if verb in listed]
    assert {"run", "ps", "stop", "logs", "graph", "check", "info", "topic", "report"} <= set(listed)
    for verb in listed:
        code, text = berth(verb, "--help")
        assert code == 0
        assert len(text.splitlines()) <= 50, verb
