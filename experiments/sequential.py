"""Two policies in pairs of trials: how sure are we that one is better, at any time that we care to look?

Only pairs in which one succeeded and the other failed tell them apart. If the policies are equally good, each such pair
is a fair coin: the order in a pair is drawn, so that neither drift nor wear favours one. Against the fair coin stands a
coin of unknown bias, uniform on (0, 1); of n such pairs with k for A the ratio of the likelihoods is

    e(n, k) = 2**n k! (n-k)! / (n+1)!

Under the fair coin it is a martingale of mean 1, so by Ville's inequality it ever reaches 1 / alpha with probability at
most alpha, however often one looks and whenever one stops (Ville 1939; Robbins 1970, `Statistical methods related to
the law of the iterated logarithm`).
"""

from __future__ import annotations

import math

Z_95 = 1.959963984540054
"""Standard normal quantile of a two-sided 95 % interval."""


def evidence(for_a: int, for_b: int) -> float:
    """e(n, k) of so many telling pairs; 1 = nothing is known."""
    n = for_a + for_b
    log = n * math.log(2.0) + math.lgamma(for_a + 1) + math.lgamma(for_b + 1) - math.lgamma(n + 2)
    return math.exp(min(log, 700.0))


def better(for_a: int, for_b: int, alpha: float) -> str:
    """`a`, `b`, or empty as long as nothing is decided at this error rate."""
    if evidence(for_a, for_b) < 1.0 / alpha:
        return ""
    return "a" if for_a > for_b else "b"


def wilson(successes: int, trials: int, z: float = Z_95) -> tuple[float, float]:
    """Interval of a success rate (Wilson 1927), for a number of trials fixed beforehand; (0, 1) without any."""
    if trials == 0:
        return 0.0, 1.0
    share, spread = successes / trials, z * z / trials
    middle = (share + spread / 2.0) / (1.0 + spread)
    half = z * math.sqrt(share * (1.0 - share) / trials + spread / (4.0 * trials)) / (1.0 + spread)
    return max(0.0, middle - half), min(1.0, middle + half)
