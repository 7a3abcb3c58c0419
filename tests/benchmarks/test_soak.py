"""Whoever leaks, loses or slows down is found: the judges on made-up series, and a minute of a small system."""

import os

import pytest

from benchmarks.figure import Figure
from benchmarks.memory import Memory, Sample, growth, private_mb
from benchmarks.rates import paced, rates
from benchmarks.soak import judged
from benchmarks.view import _bounded
from runtime.recording import Logged
from tests.runtime.system import recorded_system

MB = 2**20


def series(mb_at):
    return [Sample(float(n), mb_at(n)) for n in range(400)]


def spoken(hz_at, topic="a/b", seconds=400):
    times_ns = [round((second + n / hz_at(second)) * 1e9) for second in range(seconds) for n in range(hz_at(second))]
    return [Logged(topic, "", b"", 1, number, time_ns, time_ns) for number, time_ns in enumerate(times_ns)]


@pytest.mark.parametrize("share", [0.06, 0.2, 1.0])
def test_a_steady_leak_is_seen_by_half_of_it(share):
    assert growth(series(lambda n: 100.0 * (1.0 + share * n / 400))) == pytest.approx(0.5 * share, rel=0.3)


def test_warming_up_and_a_collection_now_and_then_are_no_leak():
    assert abs(growth(series(lambda n: (20.0 if n < 90 else 100.0) + 30.0 * (n % 10 == 0)))) < 0.01


def test_a_series_of_one_moment_is_not_called_flat():
    assert growth([Sample(1.0, 50.0)]) == float("inf")


def test_memory_that_this_process_takes_is_seen(tmp_path):
    memory = Memory()
    memory.look({"me": os.getpid(), "nobody": 2**22 + 1}, 0.0)
    taken = bytearray(os.urandom(MB)) * 40
    memory.look({"me": os.getpid()}, 1.0)
    before, after = memory.series["me"]
    assert 38.0 < after.mb - before.mb < 60.0
    assert set(memory.series) == {"me"}
    assert len(taken) == 40 * MB
    memory.write(tmp_path / "memory.csv")
    assert len((tmp_path / "memory.csv").read_text().splitlines()) == 3


def test_who_is_gone_has_no_memory():
    assert private_mb(2**22 + 1) is None


def test_a_steady_topic_does_not_drift_and_one_that_slows_down_does():
    assert rates(spoken(lambda _: 8), {"a/b"}).drift == 0.0
    slower = rates(spoken(lambda second: 8 if second < 250 else 6), {"a/b"})
    assert slower.drift == pytest.approx(0.25, abs=0.01)
    assert slower.topic == "a/b"
    assert rates(spoken(lambda second: 1 + second // 100), set()).drift == 0.0, "it promises no rate"


def test_a_missing_message_is_counted():
    messages = spoken(lambda _: 8)
    found = rates(messages[:100] + messages[103:], {"a/b"})
    assert (found.messages, found.lost) == (3197, 3)


def test_what_a_viewer_may_fill_is_bounded_and_need_not_be_flat():
    note = "median of each quarter: 159.3, 205.3, 218.6, 226.5 MB"
    full = _bounded(Figure("real: private memory of program of view --web", 10.3, "%", at_most=5, note=note))
    assert (full.value, full.kept) == (226.5, True)
    assert not _bounded(full._replace(note=note.replace("226.5", "260.0"))).kept
    own = Figure("real: private memory of view --web", 10.3, "%", at_most=5, note=note)
    assert _bounded(own) == own


@pytest.mark.xdist_group("live")
def test_a_minute_of_a_small_system_is_judged_as_a_whole(tmp_path):
    system = recorded_system(tmp_path, ["world.frames=0"])
    figures = {figure.name: figure for figure in judged(system, 60.0)}
    assert paced(system) >= {"world/image", "echo/drive", "recorder/ack"}
    for name in ("world", "echo", "recorder", "supervisor"):
        assert "median of each quarter" in figures[f"lockstep: private memory of {name}"].note
    for name in ("messages lost", "largest change of a rate"):
        assert figures[f"lockstep: {name}"].kept, figures
    # Who had to be killed at the end, as on a very busy machine, counts here: 0 is for the hour, not for a test.
    assert "lockstep: refused or failed" in figures
    assert system.recording.with_suffix(".csv").exists()
