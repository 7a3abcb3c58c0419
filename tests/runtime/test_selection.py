"""Which topics are meant."""

import pytest

from runtime.params import ConfigurationError
from runtime.selection import Selection

KEYS = ("camera/image", "vision/view", "tracker/percept", "tracker/status")


@pytest.mark.parametrize(
    ("selection", "left"),
    [
        (Selection(), KEYS),
        (Selection(topics=("vision/view",)), ("vision/view",)),
        (Selection(include="^tracker/"), ("tracker/percept", "tracker/status")),
        (Selection(exclude="image|status"), ("vision/view", "tracker/percept")),
        (Selection(include="^tracker/", exclude="status$"), ("tracker/percept",)),
        (Selection(topics=("camera/image",), include="view"), ("camera/image", "vision/view")),
        (Selection(topics=("camera/image",), exclude="camera"), ()),
    ],
)
def test_names_and_patterns_add_up_and_exclusion_wins(selection, left):
    assert tuple(filter(selection.takes, KEYS)) == left


def test_what_is_no_pattern_is_refused():
    with pytest.raises(ConfigurationError, match="-x must be a regular expression"):
        Selection(exclude="(")


def test_a_selection_of_nothing_or_of_the_unknown_is_refused():
    with pytest.raises(ConfigurationError, match="must leave a key"):
        Selection(exclude=".").check(KEYS, "here")
    with pytest.raises(ConfigurationError, match="got 'no/such'"):
        Selection(topics=("no/such",)).check(KEYS, "here")
