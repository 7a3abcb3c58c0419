"""Learning again from a recording: the live tables to the bit, other parameters, a policy that runs."""

import json

import pytest

from cli.lessons import learn
from cli.relearn import relearn
from docking.policy import PolicyTable
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.recording import Recording
from runtime.system import params_of
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
    assert report.check.same is True
    assert report.check.words.endswith("same hash")
    assert [digest for _, digest in report.lessons[0].learned.snapshots] == live_digests(session)
    assert "in the order of the journal" in report.notes[0]


def test_a_file_without_any_learner_channel_gives_the_same_table(session, stripped):
    report = learn([stripped], "learner", (), compare=False)
    policy = report.lessons[0].learned.policy
    assert policy.table_sha256 == live_digests(session)[-1]
    assert report.check.same is None
    assert "in the order of the file (no journal)" in report.notes[0]


def test_the_last_policy_is_the_one_that_the_live_learner_published(session):
    learned = learn([session], "learner", (), compare=False).lessons[0].learned.policy
    *_, last = Recording(session).messages(["learner/policy"])
    assert learned.version == last.decoded().version
    assert learned.action.tobytes() == last.decoded().action


def test_a_wrong_table_in_the_file_is_noticed(session, tmp_path):
    def forge(topic, message):
        if topic != "learner/snapshot":
            return message
        snapshot = type(next(Recording(session).messages([topic])).decoded()).FromString(message.payload)
        snapshot.table_sha256 = bytes(32)
        return message._replace(payload=snapshot.SerializeToString())

    code, output = berth(relearn, rewritten(session, tmp_path / "forged.mcap", forge), "--no-comparison")
    assert code == 1
    assert "snapshot 1 of 1: another hash than live" in output


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
