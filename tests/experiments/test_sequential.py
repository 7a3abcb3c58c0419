"""The sequential rule of `berth compare`: its error rate is what it claims, whenever one looks."""

import math

import numpy as np
import pytest
from scipy import integrate, stats

from experiments.sequential import better, evidence, wilson
from report.duel import Duel
from schemas.trial_pb2 import Trial


def chance_to_decide(alpha: float, pairs: int, p: float = 0.5) -> float:
    """Exact probability that a coin of bias p is called unfair at any of so many looks."""
    alive, decided = {0: 1.0}, 0.0
    for n in range(1, pairs + 1):
        ahead: dict[int, float] = {}
        for k, mass in alive.items():
            ahead[k + 1] = ahead.get(k + 1, 0.0) + mass * p
            ahead[k] = ahead.get(k, 0.0) + mass * (1.0 - p)
        decided += sum(mass for k, mass in ahead.items() if better(k, n - k, alpha))
        alive = {k: mass for k, mass in ahead.items() if not better(k, n - k, alpha)}
    return decided


@pytest.mark.parametrize(("k", "n"), [(0, 0), (1, 1), (3, 9), (12, 12)])
def test_the_evidence_is_the_likelihood_ratio_of_a_coin_of_unknown_bias(k, n):
    unknown, _ = integrate.quad(lambda p: p**k * (1 - p) ** (n - k), 0.0, 1.0)
    assert evidence(k, n - k) == pytest.approx(unknown / 0.5**n, rel=1e-9)


def test_under_the_fair_coin_the_evidence_is_a_martingale():
    for n in range(30):
        for k in range(n + 1):
            later = (evidence(k + 1, n - k) + evidence(k, n - k + 1)) / 2
            assert later == pytest.approx(evidence(k, n - k), rel=1e-9)


@pytest.mark.parametrize("alpha", [0.2, 0.05, 0.01])
def test_equal_policies_are_told_apart_no_more_often_than_claimed_however_often_one_looks(alpha):
    false = chance_to_decide(alpha, 300)
    assert alpha / 10 < false <= alpha


def test_a_clearly_better_policy_is_found():
    assert chance_to_decide(0.05, 60, p=0.85) > 0.95
    assert better(8, 0, 0.05) == "a"
    assert better(0, 8, 0.05) == "b"
    assert better(7, 0, 0.05) == ""


def test_enormous_evidence_overflows_nothing():
    assert math.isfinite(evidence(10_000, 0))


@pytest.mark.parametrize(("k", "n"), [(0, 10), (5, 12), (93, 100), (10, 10)])
def test_wilsons_interval_is_that_of_scipy(k, n):
    expected = stats.binomtest(k, n).proportion_ci(0.95, method="wilson")
    assert wilson(k, n) == pytest.approx((expected.low, expected.high), abs=1e-12)


def test_nothing_is_known_of_a_policy_without_a_trial():
    assert wilson(0, 0) == (0.0, 1.0)


def ending(number: int, side: str, outcome: Trial.Outcome, failure=Trial.NO_FAILURE) -> Trial:
    return Trial(phase=Trial.EVALUATE, number=number, ended=number + 1, side=side, outcome=outcome, failure=failure)


def fought(results) -> Duel:
    """A duel of (a succeeds, b succeeds) per pair, b first in every other pair; ends when decided."""
    duel = Duel(0.05)
    for pair, (a, b) in enumerate(results):
        order = [("a", a), ("b", b)] if pair % 2 else [("b", b), ("a", a)]
        for i, (side, success) in enumerate(order):
            outcome = Trial.PICKED if success else Trial.SINK
            failure = Trial.NO_FAILURE if success else Trial.OFF_COURSE
            duel.take(ending(2 * pair + i, side, outcome, failure), pair)
        if duel.winner:
            break
    return duel


def test_whole_duels_of_equal_policies_are_decided_rarely_enough():
    generator = np.random.default_rng(5)
    duels = [fought(generator.random((80, 2)) < 0.7) for _ in range(300)]
    false = sum(bool(duel.winner) for duel in duels)
    assert false <= stats.binom.ppf(0.999, 300, 0.05)


def test_pairs_that_both_win_or_both_lose_tell_nothing():
    duel = fought([(True, True), (False, False)] * 20)
    assert duel.telling == (0, 0)
    assert duel.table()["evidence"] == 1.0
    assert duel.table()["better"] == "undecided"


def test_each_side_has_its_rate_and_the_names_of_its_failures():
    table = fought([(True, False)] * 8).table()
    assert (table["better"], table["only_a"], table["only_b"], table["pairs"]) == ("a", 8, 0, 8)
    assert table["a"]["success_percent"] == 100.0
    assert table["b"]["failures"] == {"off course": 8}


def test_a_pair_whose_second_trial_is_missing_does_not_count():
    duel = Duel(0.05)
    duel.take(ending(0, "a", Trial.PICKED), 0)
    duel.take(ending(3, "b", Trial.SINK), 1)
    assert duel.pairs == []


def test_messages_of_nonsense_change_nothing():
    duel = Duel(0.05)
    for message in (Trial(phase=77, ended=3, side="a"), Trial(phase=1, ended=1, side="c", outcome=99, failure=99)):
        duel.take(message, 0)
    assert duel.table()["pairs"] == 0
