"""The fault campaign: its judges can say no, its folds hold, and real processes are shot at and cleared away."""

import itertools
from pathlib import Path

import pytest

from experiments.faults.experiment import FORM, NAME, Tampered, judged, tamper
from experiments.faults.motion import Robot, late_s, stale_s, stop_s
from experiments.faults.plan import DEADLY, EVERYBODY, PASSING, Injection, deaths, plan
from experiments.faults.rules import simulated_robot
from experiments.faults.timeline import Moved, Timeline, Told
from experiments.faults.verdict import (
    BRAKES,
    FRESH,
    NOBODY,
    READABLE,
    REASON,
    TRIAL,
    WORD,
    Verdict,
    verdict_of,
)

ROBOT = Robot(0.3, 0.03125, 0.3, 0.3, 1.75)
MS = 1_000_000
FRAMES = range(0, 2000, 125)


def driven(brakes_ms, word_ms=None):
    """A robot that drives at 0.1 m/s by frames answered up to 1000 ms, 40 ms late, and begins to brake at a time."""
    truths = [Moved(ms * MS, max(0.0, 0.1 - 0.3 * max(0, ms - brakes_ms) / 1000), 0.0) for ms in FRAMES]
    commands = [Told(ms * MS, (ms + 40) * MS, 0.1, 0.0) for ms in FRAMES if ms <= 1000]
    if word_ms is not None:
        commands.append(Told(word_ms * MS, word_ms * MS, 0.0, 0.0))
    return Timeline(truths, commands)


@pytest.mark.parametrize(("brakes_ms", "late_ms"), [(1280, 0), (1331, 0), (1400, 69), (1531, 200)])
def test_a_robot_that_brakes_too_late_is_told_from_its_speed(brakes_ms, late_ms):
    found = late_s(ROBOT, driven(brakes_ms), 1000 * MS, 2000 * MS, deaf=False)
    assert found == pytest.approx(late_ms / 1000, abs=0.001)


def test_a_base_that_was_hit_has_its_watchdog_from_its_last_word_on():
    line = driven(1370)
    assert late_s(ROBOT, line, 1000 * MS, 2000 * MS, deaf=True) == 0.0
    assert late_s(ROBOT, line, 1000 * MS, 2000 * MS, deaf=False) == pytest.approx(0.039, abs=0.001)


def test_a_world_that_was_stopped_for_long_has_not_moved_its_robot():
    line = driven(1331)
    later = [
        truth._replace(at_ns=truth.at_ns + 3000 * MS) if truth.at_ns > 1200 * MS else truth for truth in line.truths
    ]
    assert late_s(ROBOT, Timeline(later, line.commands), 1000 * MS, 6000 * MS, deaf=False) <= 0.125


def test_a_word_that_stands_too_long_is_told_by_bases_own_clock():
    assert stale_s(ROBOT, driven(1300, 1290), 1100 * MS, 2000 * MS) == pytest.approx(-0.01)
    assert stale_s(ROBOT, driven(1300, 1330), 1100 * MS, 2000 * MS) == pytest.approx(0.03)
    assert stale_s(ROBOT, driven(1300), 1100 * MS, 2000 * MS) is None


def test_the_stop_is_the_first_word_to_stand_or_the_beginning_of_the_braking():
    assert stop_s(ROBOT, driven(1300, 1200), 1050 * MS) == pytest.approx(0.15)
    assert stop_s(ROBOT, driven(1300, 1350), 1050 * MS) == pytest.approx(0.25)
    assert stop_s(ROBOT, driven(1300), 500 * MS) is None, "fresh frames drove it on"


def test_as_many_seeds_as_there_are_deaths_try_each_of_them():
    last = [(plan(seed)[-1].fault, plan(seed)[-1].victim) for seed in range(len(deaths()))]
    assert len(set(last)) == len(last)
    names = set(EVERYBODY) - {"learner"}
    assert set(last) == set(itertools.product(DEADLY, names)) - {("crash", "recorder"), ("crash", "supervisor")}


def test_everybody_meets_every_passing_fault_and_the_learner_every_death():
    done = {(one.fault, one.victim) for seed in range(60) for one in plan(seed)}
    assert done >= set(itertools.product(PASSING, EVERYBODY)) | {(fault, "learner") for fault in DEADLY}


def test_the_promises_hold_for_folds_whose_messages_are_tampered_with():
    verdicts = tamper(5)
    assert [row for row in verdicts if not row.held] == []
    assert {row.promise for row in verdicts} >= {BRAKES, WORD, FRESH, REASON}
    assert len({row.injection for row in verdicts}) > 12


def short(seed, count, *overrides):
    session = Tampered(seed, simulated_robot(), count, overrides)
    session.run()
    return list(session.verdicts(NAME, seed))


def test_the_same_seed_is_the_same_session():
    assert short(2, 3) == short(2, 3)


def test_a_base_that_believes_old_frames_is_found_out():
    assert {row.promise for row in short(34, 4, "base.max_age_s=2.0") if not row.held} >= {WORD}


def test_a_robot_without_a_watchdog_is_found_out():
    """The base that would have told it to stand is paused."""
    broken = [row for row in short(34, 3, "simulator.watchdog_s=5.0") if not row.held]
    assert {(row.fault, row.victim) for row in broken if row.promise == FRESH} == {("pause", "base")}


def test_a_verdict_comes_back_as_it_was():
    row = Verdict(NAME, 1, "live", 0, "kill", "pilot", BRAKES, held=True, measured=0.1, note="x")
    assert verdict_of({name: getattr(row, name) for name in FORM.columns}) == row
    with pytest.raises(ValueError, match="columns"):
        verdict_of({"seed": 1})


def test_the_table_counts_what_was_tried_and_names_what_did_not_hold():
    rows = [Verdict(NAME, 1, "live", k, "kill", "pilot", NOBODY, held=k > 0) for k in range(3)]
    header, *lines = FORM.summary(rows)
    assert header == ("promise", "shell", "tried", "held", "worst", "not held")
    assert lines[0] == (NOBODY, "live", "3", "2", "", "kill pilot")
    assert [line[:3] for line in lines[1:]] == [("injections", "live", "3"), ("injections", "in-process", "0")]


@pytest.mark.xdist_group("live")
def test_real_processes_are_shot_at_and_nobody_is_left(tmp_path: Path):
    """What depends on a free processor is left to the campaign."""
    shots = [Injection("pause", "simulator", lasts_s=0.4), Injection("kill", "learner"), Injection("crash", "vision")]
    verdicts = judged(shots, 1, tmp_path)
    untimed = [row for row in verdicts if row.promise in {REASON, NOBODY, READABLE, TRIAL}]
    assert [row for row in untimed if not row.held] == []
    assert {row.promise for row in untimed} == {REASON, NOBODY, READABLE, TRIAL}
    ends = [row.note for row in verdicts if row.promise == REASON]
    assert ends[:2] == ["goes on", "goes on"]
    assert ends[2].startswith("vision ended with exit code 1: ArithmeticError")
