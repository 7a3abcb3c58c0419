"""New identities for one pass through a log."""

from runtime.epoch import Epoch
from runtime.recording import Logged


def logged(run, sequence, topic="a/b"):
    return Logged(topic, "berth.Percept", b"", run, sequence, 0, 0)


def test_one_logged_run_stays_one_run_and_two_stay_two():
    epoch = Epoch(1)
    runs = [epoch.stamp(logged(run, 0), 0).run for run in (5, 6, 5)]
    assert runs[0] == runs[2] != runs[1]
    assert not {5, 6} & set(runs)


def test_every_epoch_has_runs_of_its_own():
    assert Epoch(1).stamp(logged(5, 0), 0).run != Epoch(2).stamp(logged(5, 0), 0).run


def test_sequences_begin_at_zero_on_each_topic_and_keep_their_holes():
    epoch = Epoch(1)
    numbers = [epoch.stamp(logged(5, sequence, topic), 0).sequence for topic, sequence in
               [("a/b", 40), ("a/b", 41), ("c/d", 7), ("a/b", 44)]]  # fmt: skip
    assert numbers == [0, 1, 0, 4]
