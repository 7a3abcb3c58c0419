"""Two sessions side by side."""

import copy
import dataclasses
import math

import pytest

from report.session import read
from report.versus import Side, differences, newcombe, numbers, write
from tests.report.test_page import FOLDER, headings, is_self_contained


def test_the_interval_of_a_difference_is_newcombes():
    """Newcombe 1998, Statistics in Medicine 17, table II, method 10: 56/70 against 48/80, and 10/10 against 0/10."""
    assert newcombe((48, 80), (56, 70)) == pytest.approx((0.0524, 0.3339), abs=1e-4)
    assert newcombe((0, 10), (10, 10)) == pytest.approx((0.6075, 1.0), abs=1e-4)
    assert all(map(math.isnan, newcombe((0, 0), (1, 1))))


def changed(session, component, **params):
    """The same session, as if it had been run with other parameters."""
    launch = copy.deepcopy(session.launch)
    spec = next(spec for spec in launch["components"] if spec["name"] == component)
    spec["params"].update(params)
    return dataclasses.replace(session, launch=launch)


@pytest.fixture(scope="module")
def first():
    return read(FOLDER / "reverse.mcap")


@pytest.fixture(scope="module")
def pair(first):
    return first, changed(first, "pilot", lost_s=1.0)


def test_what_was_set_differently_is_named_as_it_is_set(first):
    second = changed(changed(first, "pilot", lost_s=1.5, new="words"), "tracker", feed_forward=False)
    second.launch["seed"] = 9
    assert dict(differences(first, second)) == {
        "pilot.lost_s": ("15", "1.5"),
        "pilot.new": ("-", "words"),
        "tracker.feed_forward": ("true", "false"),
        "seed": (str(first.launch["seed"]), "9"),
    }
    assert differences(first, first) == []


def test_a_parameter_of_the_task_is_one_difference_however_many_components_have_it(first, tmp_path):
    second = copy.deepcopy(first)
    for spec in second.launch["components"]:
        if "task" in spec["params"]:
            spec["params"]["task"]["speed_mps"] = 0.25
    assert len(differences(first, second)) >= 3
    write((Side(first, None), Side(second, None)), tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8").count("speed_mps</td>") == 1


def test_the_page_shows_differences_first_and_needs_nothing_else(pair, tmp_path):
    sides = Side(pair[0], None), Side(pair[1], None)
    write(sides, tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert is_self_contained(text)
    assert headings(text) == ["What was set differently", "Docking", "Learning", "Tracking", "Losses and faults"]
    assert "<td>pilot.lost_s</td>" in text


@pytest.mark.parametrize(
    "launch", [{"components": None}, {"components": [{"name": "pilot", "params": None}], "task": 3}]
)
def test_any_launch_file_can_be_compared(pair, launch, tmp_path):
    odd = dataclasses.replace(pair[1], launch=launch, metadata={"fingerprint": "no JSON"})
    write((Side(pair[0], None), Side(odd, None)), tmp_path / "page.html")
    assert numbers((Side(odd, None), Side(pair[0], None)))["A"]["trials"] >= 1
