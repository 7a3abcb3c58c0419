"""replay, info, doctor, recover on the command line: exit codes, one line for a mistake, JSON for machines."""

import json

import pytest
import typer
from typer.testing import CliRunner

from cli.doctor import doctor
from cli.recover import recover
from cli.replay import replay
from runtime.params import ConfigurationError
from runtime.recording import Recording
from tests.runtime.offline import FRAMES, rewritten, small_session, without

RUNNER = CliRunner()
MAGIC = b"\x89MCAP0\r\n"


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    return small_session(tmp_path_factory.mktemp("small"))


def berth(verb, *words):
    """Exit code and output of a verb, in this process."""
    app = typer.Typer()
    app.command()(verb)
    done = RUNNER.invoke(app, [str(word) for word in words])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return done.exit_code, done.output


def test_an_identical_replay_is_0_and_says_how_much(session):
    code, output = berth(replay, session, "--component", "fickle", "--check")
    assert code == 0
    assert output.splitlines()[-1] == f"identical: {FRAMES} of {FRAMES} outputs"


def test_a_replay_that_compares_nothing_misses_nothing(session):
    code, output = berth(replay, session, "--component", "fickle")
    assert (code, len(output.splitlines())) == (0, 1)


def test_a_difference_is_1_and_shown_with_time_and_sequence(session):
    code, output = berth(replay, session, "-c", "fickle", "--check", "--set", "fickle.gain=2")
    assert code == 1
    assert "0.125 s fickle/drive 1: v_mps: recorded 0.125, replayed 0.25" in output
    assert output.splitlines()[-1] == f"different: {FRAMES - 1} of {FRAMES} outputs: fickle/drive {FRAMES - 1}"


def test_a_parameter_asked_for_without_check_only_shows_what_it_changes(session):
    code, output = berth(replay, session, "-c", "fickle", "--set", "fickle.gain=2")
    assert code == 0
    assert "different:" in output


def test_identical_up_to_a_loss_is_3(session, tmp_path):
    file = rewritten(session, tmp_path / "hole.mcap", without("world/image", sequences=range(12, 13)))
    code, output = berth(replay, file, "-c", "fickle", "--check")
    assert code == 3
    assert "replayable until 1.500 s: message 12 of world/image is missing" in output
    assert "identical: 12 of 12 outputs" in output


def test_without_recorded_outputs_there_is_nothing_to_compare(session, tmp_path):
    file = rewritten(session, tmp_path / "stripped.mcap", without("fickle/drive"))
    code, output = berth(replay, file, "-c", "fickle", "--check")
    assert code == 3
    assert "nothing to compare: the recording holds nothing that fickle said" in output
    assert f"said: fickle/drive {FRAMES}" in output


def test_what_it_says_now_is_written_as_a_recording(session, tmp_path):
    target = tmp_path / "said.mcap"
    code, _ = berth(replay, session, "-c", "fickle", "--set", "fickle.gain=2", "-o", target)
    assert code == 0
    said, recorded = ([*Recording(file).messages(["fickle/drive"])] for file in (target, session))
    assert [(m.sequence, m.capture_ns, m.run) for m in said] == [(m.sequence, m.capture_ns, m.run) for m in recorded]
    assert said[1].decoded().v_mps == 2 * recorded[1].decoded().v_mps
    fickle = next(spec for spec in Recording(target).launch()["components"] if spec["name"] == "fickle")
    assert fickle["params"]["gain"] == 2.0


def test_a_recording_is_never_overwritten(session):
    before = session.read_bytes()
    with pytest.raises(ConfigurationError, match="must not exist yet"):
        berth(replay, session, "-c", "fickle", "-o", session)
    assert session.read_bytes() == before


def test_json_is_one_object_with_the_same_numbers(session):
    code, output = berth(replay, session, "-c", "fickle", "--check", "--json")
    table = json.loads(output)
    assert code == 0
    assert (table["identical"], table["different"], table["outputs"]) == (FRAMES, 0, {"fickle/drive": FRAMES})


def test_doctor_is_0_for_a_healthy_recording_and_3_for_a_lossy_one(session, tmp_path):
    assert berth(doctor, session)[0] == 0
    lossy = rewritten(session, tmp_path / "hole.mcap", without("world/image", sequences=range(12, 13)))
    code, output = berth(doctor, lossy)
    assert code == 3
    assert "sequence: world/image (run 0000000000000001): 1 lost" in output


def test_doctor_is_1_for_a_wrong_one(session, tmp_path):
    def back(topic, message):
        return message._replace(payload=b"\xff") if topic == "fickle/drive" else message

    code, output = berth(doctor, rewritten(session, tmp_path / "wrong.mcap", back))
    assert code == 1
    assert f"payload: fickle/drive: a message can not be decoded ({FRAMES} times)" in output


def test_recover_is_3_if_something_is_lost_and_never_touches_its_input(session, tmp_path):
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(session.read_bytes()[:7000])
    before = torn.read_bytes()
    code, output = berth(recover, torn)
    assert code == 3
    assert "lost at byte" in output
    assert torn.read_bytes() == before
    assert Recording(tmp_path / "torn-recovered.mcap").whole()
    assert berth(recover, session, "-o", tmp_path / "copy.mcap")[0] == 0


@pytest.mark.parametrize(
    "content", [b"", b"no MCAP", b"\x89MCAP1\r\n", b"\x89MCAP0\r\n", b"\x89MCAP0\r\n\x06" + b"\xff" * 8]
)
@pytest.mark.parametrize(("verb", "words"), [(replay, ["-c", "fickle"]), (doctor, []), (recover, [])])
def test_a_file_that_is_no_session_is_refused_in_one_line(tmp_path, content, verb, words):
    file = tmp_path / "bad.mcap"
    file.write_bytes(content)
    with pytest.raises(ConfigurationError) as refusal:
        berth(verb, file, *words)
    assert str(refusal.value).startswith(str(file))
    assert "\n" not in str(refusal.value)
