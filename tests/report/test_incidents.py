"""What went wrong in the machinery: told once each, with its time, and only if it did."""

from report.incidents import Incidents, commanders_of
from runtime.journal import LOADED
from runtime.recording import Logged
from schemas.drive_pb2 import Applied, BaseState
from schemas.session_pb2 import Gap, Hold, Journal, Status
from schemas.view_pb2 import View

S = 1_000_000_000
LAUNCH = {"components": [{"name": "base", "inputs": {"pilot": "pilot/drive", "teleop": "teleop/drive"}}]}


def found(*rows):
    """Incidents of (topic, run, second, message)."""
    incidents = Incidents(commanders_of(LAUNCH))
    for topic, run, at_s, message in rows:
        schema = message.DESCRIPTOR.full_name
        assert incidents.wants(schema)
        incidents.take(Logged(topic, schema, b"", run, 0, round(at_s * S), round(at_s * S)), message)
    return [(i.kind, i.who, round(i.from_s, 6), round(i.to_s, 6), i.count) for i in incidents.found]


def test_a_session_in_which_nothing_went_wrong_has_none():
    assert (
        found(
            ("pilot/status", 1, 1, Status(component="pilot", handled=8)),
            ("pilot/status", 1, 2, Status(component="pilot", handled=16)),
            ("base/applied", 2, 1, Applied(commander="pilot")),
            ("base/applied", 2, 2, Applied(commander="teleop")),
            ("base/applied", 2, 3, Applied(commander="none")),
            ("base/applied", 2, 4, Applied(commander="stop")),
            ("base/state", 2, 4, BaseState()),
            ("vision/view", 3, 4, View(object_visible=True)),
        )
        == []
    )


def test_a_death_and_the_return_are_one_incident():
    status = Status(component="pilot")
    assert found(
        ("pilot/status", 1, 10, status),
        ("supervisor/hold", 9, 10.5, Hold(active=True, component="pilot")),
        ("pilot/status", 2, 14, status),
        ("pilot/status", 2, 15, status),
    ) == [("died", "pilot", 10.5, 14.0, 1)]


def test_a_return_without_a_word_of_the_death_is_told_too():
    status = Status(component="pilot")
    assert found(("pilot/status", 1, 10, status), ("pilot/status", 2, 14, status)) == [("died", "pilot", 14.0, 14.0, 1)]


def test_counters_tell_what_is_new_since_the_last_status():
    assert found(
        ("pilot/status", 1, 1, Status(skipped=2)),
        ("pilot/status", 1, 2, Status(skipped=2, lost=3)),
        ("pilot/status", 1, 60, Status(skipped=7, lost=3, malformed=1, note="pilot/x: no Percept")),
    ) == [
        ("late", "pilot", 1.0, 1.0, 2),
        ("missed", "pilot", 2.0, 2.0, 3),
        ("late", "pilot", 60.0, 60.0, 5),
        ("refused", "pilot", 60.0, 60.0, 1),
    ]


def test_stops_close_to_one_another_are_one_incident():
    stale = Applied(commander="stale")
    assert found(*(("base/applied", 1, at_s, stale) for at_s in (10, 10.1, 10.2, 30, 30.1))) == [
        ("stopped", "base", 10.0, 10.2, 3),
        ("stopped", "base", 30.0, 30.1, 2),
    ]


def test_what_the_device_the_eyes_the_recorder_and_the_journal_say_is_told():
    kinds = [kind for kind, *_ in found(
        ("base/state", 1, 1, BaseState(fault="stop button")),
        ("vision/view", 1, 2, View(fault="no JPEG")),
        ("recorder/gap", 1, 3, Gap(key="camera/image", count=4)),
        ("learner/journal", 1, 4, Journal(ports=[LOADED, "percept"], port=[1, 0])),
        ("learner/journal", 1, 5, Journal(ports=[LOADED, "percept"], port=[1, 1])),
    )]  # fmt: skip
    assert kinds == ["stopped", "unusable", "lost", "resumed"]


def test_a_launch_file_of_anybody_has_no_commanders():
    assert commanders_of({"components": [None, {"inputs": 3}]}) == frozenset()
