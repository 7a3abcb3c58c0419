"""Parameters are untrusted: each bad one is refused in one line that names key, value and rule."""

from dataclasses import dataclass, field

import pytest

from runtime.params import ConfigurationError, between, build, not_negative, odd, one_of, positive


@dataclass(frozen=True)
class Inner:
    cells: int = odd(31)


@dataclass(frozen=True)
class Params:
    rate_radps: float = positive(1.0)
    count: int = not_negative(0)
    share: float = between(0.5, 0.0, 1.0)
    mode: str = one_of("a", "a", "b")
    flag: bool = False
    names: tuple[str, ...] = ()
    inner: Inner = field(default_factory=Inner)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"rate_radps": -1.0}, "x.rate_radps must be > 0; got -1.0"),
        ({"rate_radps": "fast"}, "x.rate_radps must be a number; got 'fast'"),
        ({"rate_radps": float("nan")}, "x.rate_radps must be finite; got nan"),
        ({"rate_radps": True}, "x.rate_radps must be a number; got True"),
        ({"count": 1.5}, "x.count must be a whole number; got 1.5"),
        ({"count": -1}, "x.count must be >= 0; got -1"),
        ({"share": 1.1}, "x.share must be between 0 and 1; got 1.1"),
        ({"mode": "c"}, "x.mode must be one of a, b; got 'c'"),
        ({"flag": 1}, "x.flag must be a true or false; got 1"),
        ({"names": "a"}, "x.names must be a list of text; got 'a'"),
        ({"names": ["a", 2]}, "x.names[1] must be a text; got 2"),
        ({"inner": {"cells": 30}}, "x.inner.cells must be odd and at least 3, at most 501; got 30"),
        ({"inner": 3}, "x.inner must be a table; got 3"),
        ({"speed": 1}, "x.speed is unknown; known are rate_radps, count, share, mode, flag, names, inner"),
    ],
)
def test_a_bad_parameter_is_refused_in_one_line(table, message):
    with pytest.raises(ConfigurationError) as refused:
        build(Params, table, "x")
    assert str(refused.value) == message


def test_a_missing_parameter_without_default_is_named():
    @dataclass(frozen=True)
    class Needs:
        port: str

    with pytest.raises(ConfigurationError, match=r"x\.port is missing; it must be a text"):
        build(Needs, {}, "x")


def test_whole_numbers_serve_as_numbers_and_lists_become_tuples():
    made = build(Params, {"rate_radps": 2, "names": ["a", "b"], "inner": {"cells": 15}}, "x")
    assert made == Params(rate_radps=2.0, names=("a", "b"), inner=Inner(15))
    assert isinstance(made.rate_radps, float)
