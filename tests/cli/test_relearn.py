"""Learning again from a recording: the live tables to the bit, other parameters, a policy that runs."""

import json
import re

import pytest

from cli.lessons import _check, learn
from cli.relearn import relearn
from docking.policy import PolicyTable
from runtime.handed_over import HandedOver
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.recorded_system import recorded_component
from runtime.recording import Recording
from runtime.system import params_of
from schemas.session_pb2 import Snapshot
from tests.cli.test_replay import berth
from tests.recorded_session import LAUNCH
from tests.runtime.offline import rewritten, small_session, without

pytestmark = pytest.mark.xdist_group("session")
LEARNERS = ("learner/policy", "learner/snapshot", "learner/journal")


@pytest.fixture(scope="module")
def session(twins):
    return twins.first


@pytest.fixture(scope="module")
def stripped(session, tmp_path_factory):
    """Without anything that the learner, or anybody for it, has said, and without images."""
    target = tmp_path_factory.mktemp("stripped") / "stripped.mcap"
    return rewritten(session, target, without(*LEARNERS, "camera/image"))


def live_digests(session) -> list[bytes]:
    return [logged.decoded().table_sha256 for logged in Recording(session).messages(["learner/snapshot"])]


def test_the_same_parameters_give_the_live_learner_s_tables(session):
    report = learn([session], "learner", (), compare=False)
    assert report.same is True
    assert report.checks[0].words.endswith("same hash")
    assert [digest for _, digest in report.lessons[0].learned.snapshots] == live_digests(session)
    assert "in the order of the journal" in report.notes[0]


def test_a_file_without_any_learner_channel_gives_the_same_table(session, stripped):
    report = learn([stripped], "learner", (), compare=False)
    policy = report.lessons[0].learned.policy
    assert policy.table_sha256 == live_digests(session)[-1]
    assert report.same is None
    assert "in the order of the file (no journal)" in report.notes[0]


def test_the_last_policy_is_the_one_that_the_live_learner_published(session):
    learned = learn([session], "learner", (), compare=False).lessons[0].learned.policy
    *_, last = Recording(session).messages(["learner/policy"])
    assert learned.version == last.decoded().version
    assert learned.action.tobytes() == last.decoded().action


@pytest.fixture(scope="module")
def forged(session, tmp_path_factory):
    """A learner that claims to have learned something else."""

    def forge(topic, message):
        if topic != "learner/snapshot":
            return message
        snapshot = Snapshot.FromString(message.payload)
        snapshot.table_sha256 = bytes(32)
        return message._replace(payload=snapshot.SerializeToString())

    return rewritten(session, tmp_path_factory.mktemp("forged") / "forged.mcap", forge)


def test_a_wrong_table_in_the_file_is_noticed(forged):
    code, output = berth(relearn, forged, "--no-comparison")
    assert code == 1
    assert re.search(r"snapshot 1 of \d: another hash than live", output)


def test_of_several_sessions_each_is_checked_by_itself(session, stripped, forged):
    good = learn([stripped, session], "learner", (), compare=False)
    assert [check.same for check in good.checks] == [None, True]
    assert good.same is True
    assert "no snapshot of the live learner" in good.notes[0]
    assert "same hash" in good.notes[1]
    bad = learn([session, forged], "learner", (), compare=False)
    assert [check.same for check in bad.checks] == [True, False]
    assert bad.same is False


def test_a_session_with_a_hole_is_not_accused_but_said_to_be_open(session, tmp_path):
    file = rewritten(session, tmp_path / "hole.mcap", without("tracker/percept", sequences=range(100, 140)))
    report = learn([file], "learner", (), compare=False)
    assert report.same is None
    assert "message 100 on percept is missing" in report.notes[0]
    assert "another hash than live, at policy version" in report.notes[0]
    assert "but the live learner's order is not known" in report.notes[0]
    assert report.is_lossy


def test_a_torn_session_is_learned_from_up_to_its_tear_and_said_to_be_torn(session, tmp_path):
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(session.read_bytes()[: session.stat().st_size * 2 // 3])
    code, output = berth(relearn, torn, "--no-comparison")
    assert code == 3
    assert "not all of it is there: byte " in output
    assert "snapshots: same hash; the next one's lessons are torn off" in output


def test_a_learner_that_was_started_again_is_checked_run_by_run(session, forged):
    count = len(live_digests(session))
    forgery = f"{count} of its outputs differ"
    for file, same, words in ((session, True, "its outputs are the same"), (forged, False, forgery)):
        spec = recorded_component(Recording(file), "learner")[1]
        restarted = HandedOver(restarted=True)
        check = _check(Recording(file), spec, restarted, None)
        assert check.same is same
        assert check.words == f"started again, so compared run by run: {words}"


def test_two_sessions_in_turn_teach_as_much_as_both(session):
    one = learn([session], "learner", (), compare=False).lessons[0].learned.policy
    two = learn([session, session], "learner", (), compare=False).lessons[0].learned.policy
    assert two.transitions == 2 * one.transitions
    assert two.known == one.known


def test_other_cells_and_another_method_are_compared_with_the_recorded_ones(session):
    report = learn([session], "learner", ["task.beta_cells=15", "learner.method=prioritised"], compare=True)
    assert [lesson.name for lesson in report.lessons] == ["recorded", "asked for"]
    assert report.lessons[1].learned.policy.grid.beta_cells == 15
    assert report.lessons[1].learned.policy.method == "prioritised"
    predicted = [line for line in report.lines() if "held-out" in line or "%" in line]
    assert len(predicted) == 6
    assert all(line.startswith("predicted: ") for line in predicted)


def test_the_policy_file_is_one_that_the_pilot_takes(session, tmp_path):
    target = tmp_path / "policy.bin"
    code, output = berth(relearn, session, "--no-comparison", "--json", "-o", target)
    assert code == 0
    table = PolicyTable.from_bytes(target.read_bytes())
    assert table.table_sha256.hex() == json.loads(output)["lessons"][0]["table_sha256"]
    pilot = load(LAUNCH, [f"pilot.policy={target}", "pilot.train_s=0"]).component("pilot")
    assert params_of(pilot).policy == target.read_bytes()
    with pytest.raises(ConfigurationError, match="must not exist yet"):
        berth(relearn, session, "-o", target)


def test_what_can_not_be_learned_from_is_said_in_one_line(session, tmp_path):
    other = small_session(tmp_path)
    for words, reason in (
        ([other], "component learner is unknown"),
        ([session, "-c", "tracker"], "--component tracker: must be a learner"),
        ([session, "--set", "learner.sweep=4"], "learner.params.sweep is unknown"),
        ([session, "--set", "pilot.train_s=4"], "must begin with learner, task or session"),
        ([rewritten(session, tmp_path / "none.mcap", lambda *_: None)], "must hold messages for learner"),
    ):
        with pytest.raises(ConfigurationError, match=reason):
            berth(relearn, *words)
