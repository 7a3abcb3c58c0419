"""Forecasts in words."""

import pytest

from docking.score import Trial as Scored
from report.forecast import sentence
from report.page import outcome_rows
from schemas.trial_pb2 import Trial


@pytest.mark.parametrize(("told", "words"), [
    ({"dock_share": 0.966, "dock_s": 14.3}, "docks with 97 %, 14 s"),
    ({"dock_share": 0.034, "back_off_m": 0.4}, "hardly reachable from here (3 %), back off 0.4 m"),
    ({"dock_share": 0.034}, "hardly reachable from here (3 %)"),
    ({}, ""),
])  # fmt: skip
def test_a_forecast_in_words(told, words):
    assert sentence(Trial(**told)) == words


def test_the_report_judges_forecasts_of_the_evaluation_and_is_silent_without_any():
    def trial(phase, docked, share):
        return Scored(phase, 0, "greedy", 0.0, (0.0, 0.0, 1.0), docked=docked, dock_share=share)

    groups = {"training": [trial("TRAIN", False, 0.9)], "evaluation": [trial("EVALUATE", True, 0.9)] * 2}
    rows = {row[0]: row[1:] for row in outcome_rows(groups)}
    assert rows["forecast to dock"] == ["1", "2"]
    assert rows["Brier score of that"] == ["-", "0.010"]
    assert "forecast to dock" not in {row[0] for row in outcome_rows({"evaluation": [trial("EVALUATE", True, 0.0)]})}
