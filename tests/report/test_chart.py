"""Charts: where a point of the data lies on the paper, and that nothing but numbers gets there."""

import itertools
import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from report.chart import WIDTH, Axis, Chart, span

finite = st.floats(-1e6, 1e6)


@given(finite, st.floats(1e-3, 1e6))
def test_ticks_lie_within_the_axis_at_equal_steps(low, width):
    ticks = Axis(low, low + width).ticks()
    assert 2 <= len(ticks) <= 8
    slack = 1e-6 * width + 1e-9 * abs(low)
    assert all(low - slack <= tick <= low + width + slack for tick in ticks)
    steps = {round((b - a) / (ticks[1] - ticks[0]), 6) for a, b in itertools.pairwise(ticks)}
    assert steps == {1.0}


def test_a_logarithmic_axis_has_the_powers_of_ten():
    assert Axis(0.1, 1000, log=True).ticks() == pytest.approx([0.1, 1, 10, 100, 1000])
    assert Axis(1, 100, log=True).share(10) == pytest.approx(0.5)


def test_up_is_up_and_right_is_right():
    chart = Chart(Axis(-2, 2), Axis(0, 100))
    (left, bottom), (right, top) = chart.place(-2, 0), chart.place(2, 100)
    assert 0 < left < right < WIDTH
    assert 0 < top < bottom < chart.height
    assert chart.place(0, 50) == pytest.approx(((left + right) / 2, (top + bottom) / 2))


@given(st.lists(st.tuples(st.floats(), st.floats()), max_size=20))
def test_whatever_is_drawn_only_finite_numbers_are_written(points):
    chart = Chart(Axis(0, 1, "x"), Axis(0, 1, "y"))
    chart.line(points, "a")
    chart.dots(points, "a")
    chart.crosses(points, "bad")
    assert not re.search(r"nan|inf", chart.svg("words"))


def test_bars_beside_one_another_share_their_bin():
    chart = Chart(Axis(0, 1), Axis(0, 10))
    chart.bars([0.0, 1.0], [10.0], "a", (0, 2))
    chart.bars([0.0, 1.0], [5.0], "b", (1, 2))
    boxes = [tuple(map(float, re.findall(r"(?:x|y|width|height)='([-\d.]+)'", part))) for part in chart.parts]
    (x, y, wide, high), (next_x, next_y, next_wide, next_high) = boxes
    assert next_x == pytest.approx(x + wide + 0.6, abs=0.11)
    assert next_wide == pytest.approx(wide, abs=0.11)
    assert next_high == pytest.approx(high / 2, abs=0.11)
    assert y + high == pytest.approx(next_y + next_high, abs=0.11)


def test_words_are_text_not_markup():
    chart = Chart(Axis(0, 1, "<b>"), Axis(0, 1))
    chart.text(0, 0, "<script>")
    assert "<b>" not in chart.svg("'><script>")
    assert "<script>" not in chart.svg("'><script>")


def test_a_span_is_never_empty():
    assert span([]) == (0.0, 1.0)
    assert span([math.nan, math.inf, 20.0]) == (0.0, 21.0)
