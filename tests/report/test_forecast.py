"""Forecasts in words."""

import pytest

from report.forecast import sentence
from schemas.trial_pb2 import Trial


@pytest.mark.parametrize(("told", "words"), [
    ({"dock_share": 0.966, "dock_s": 14.3}, "docks with 97 %, 14 s"),
    ({"dock_share": 0.034, "back_off_m": 0.4}, "hardly reachable from here (3 %), back off 0.4 m"),
    ({"dock_share": 0.034}, "hardly reachable from here (3 %)"),
    ({}, ""),
])  # fmt: skip
def test_a_forecast_in_words(told, words):
    assert sentence(Trial(**told)) == words
