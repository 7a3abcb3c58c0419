"""Two policies on one robot, trial against trial, scored by what the pilot itself can tell."""

from __future__ import annotations

from typing import Any

from experiments.sequential import better, evidence, wilson
from report.failures import Endings, counted
from schemas.trial_pb2 import Trial

SUCCESSES = frozenset({Trial.ARRIVED, Trial.PICKED})
"""The robot stands at the pick-up, or has the object."""
_SIDES = ("a", "b")


class Duel:
    """Folds trial messages of a session in which the pilot alternates between two policies."""

    def __init__(self, alpha: float) -> None:
        """Begin; alpha is the largest probability of naming a better one of two that are equal."""
        self._alpha = alpha
        self._endings = Endings()
        self._results: dict[int, dict[str, bool]] = {}
        """Pair -> side -> success."""

    def take(self, message: Trial, capture_ns: int) -> None:
        """Take one message of the pilot."""
        ended = self._endings.take(message, capture_ns)
        if ended and message.phase == Trial.EVALUATE and message.side in _SIDES:
            self._results.setdefault(message.number // 2, {})[message.side] = message.outcome in SUCCESSES

    @property
    def pairs(self) -> list[dict[str, bool]]:
        """Results of the pairs of which both trials have ended."""
        return [result for result in self._results.values() if len(result) == len(_SIDES)]

    @property
    def telling(self) -> tuple[int, int]:
        """Pairs that only a, that only b has won."""
        pairs = self.pairs
        return sum(p["a"] and not p["b"] for p in pairs), sum(p["b"] and not p["a"] for p in pairs)

    @property
    def winner(self) -> str:
        """`a`, `b`, or empty as long as it is undecided."""
        return better(*self.telling, self._alpha)

    def table(self) -> dict[str, Any]:
        """As a JSON object."""
        only_a, only_b = self.telling
        return {
            **{side: self._side(side) for side in _SIDES},
            "pairs": len(self.pairs),
            "only_a": only_a,
            "only_b": only_b,
            "evidence": round(evidence(only_a, only_b), 3),
            "alpha": self._alpha,
            "better": self.winner or "undecided",
        }

    def _side(self, side: str) -> dict[str, Any]:
        results = [result[side] for result in self._results.values() if side in result]
        low, high = wilson(sum(results), len(results))
        return {
            "trials": len(results),
            "successes": sum(results),
            "success_percent": round(100 * sum(results) / len(results), 1) if results else None,
            "wilson_percent": [round(100 * low, 1), round(100 * high, 1)],
            "failures": counted([failed for failed in self._endings.failed if failed.side == side]),
        }
