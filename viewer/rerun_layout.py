"""The layout that the Rerun viewer opens with."""

from __future__ import annotations

import rerun as rr
import rerun.blueprint as rrb

from viewer.plan import TRAIL_S
from viewer.rerun_sink import TIMELINE

_WINDOW_S = 40.0
"""Of the fast plots."""


def layout(*, follow: bool, trails: tuple[str, ...] = ("plan/robot_trail", "plan/belief_trail")) -> rrb.Blueprint:
    """Camera and plan large; what is learned beside them; the plots, the processes and the log below.

    Args:
        follow: the newest moment; else begin at the beginning.
        trails: entities that fade.
    """
    return rrb.Blueprint(
        rrb.Vertical(
            rrb.Horizontal(_camera(), _plan(trails), _policies(), column_shares=[4, 4, 3]),
            rrb.Horizontal(_fast_plots(), _slow_plots(), _words(), column_shares=[4, 4, 3]),
            row_shares=[3, 2],
        ),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE, play_state="following" if follow else "playing"),
        auto_layout=False,
        auto_views=False,
    )


def _camera() -> rrb.View:
    return rrb.Spatial2DView(origin="camera/image", name="camera, and what vision found")


def _plan(trails: tuple[str, ...]) -> rrb.View:
    start = rrb.TimeRangeBoundary.cursor_relative(seconds=-TRAIL_S)
    fading = rr.VisibleTimeRange(TIMELINE, start=start, end=rrb.TimeRangeBoundary.cursor_relative())
    return rrb.Spatial2DView(
        origin="plan",
        name="from above",
        overrides={trail: [rr.LineStrips2D.from_fields(), rrb.VisibleTimeRanges([fading])] for trail in trails},
        visual_bounds=rrb.VisualBounds2D(x_range=[-1.6, 1.6], y_range=[-0.5, 2.3]),
    )


def _policies() -> rrb.Container:
    return rrb.Vertical(
        rrb.Spatial2DView(origin="policy/action", name="policy: blue left, orange right"),
        rrb.Spatial2DView(origin="policy/value", name="value"),
    )


def _fast_plots() -> rrb.Container:
    newest = rr.TimeRange(
        start=rrb.TimeRangeBoundary.cursor_relative(seconds=-_WINDOW_S), end=rrb.TimeRangeBoundary.cursor_relative()
    )
    moving = rrb.archetypes.TimeAxis(link=rrb.components.LinkAxis.Independent, view_range=newest)
    angles = rrb.ScalarAxis(range=(-110.0, 110.0))
    window = rr.VisibleTimeRange(
        TIMELINE,
        start=rrb.TimeRangeBoundary.cursor_relative(seconds=-_WINDOW_S),
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )
    return rrb.Tabs(
        rrb.TimeSeriesView(origin="head", name="pan, tilt", time_ranges=[window], axis_x=moving, axis_y=angles),
        rrb.TimeSeriesView(origin="percept", name="percept", time_ranges=[window], axis_x=moving, axis_y=angles),
        rrb.TimeSeriesView(origin="drive", name="drive", time_ranges=[window], axis_x=moving),
        rrb.TimeSeriesView(origin="latency_ms", name="latency", time_ranges=[window], axis_x=moving),
        rrb.TimeSeriesView(origin="lost", name="losses"),
    )


def _slow_plots() -> rrb.Container:
    always = rr.TimeRange(start=rrb.TimeRangeBoundary.infinite(), end=rrb.TimeRangeBoundary.infinite())
    whole = rrb.archetypes.TimeAxis(link=rrb.components.LinkAxis.Independent, view_range=always)
    return rrb.Tabs(
        rrb.TimeSeriesView(
            origin="learning",
            name="learning curve",
            axis_x=whole,
            axis_y=rrb.ScalarAxis(range=(-3.0, 103.0), zoom_lock=True),
        ),
        rrb.TimeSeriesView(origin="policy_size", name="policy size", axis_x=whole),
        rrb.StateTimelineView(origin="/", contents=["+ pilot/**", "+ drive/commander", "+ processes/*"], name="states"),
    )


def _words() -> rrb.Container:
    return rrb.Tabs(
        rrb.TextDocumentView(origin="session", name="session"),
        rrb.TextDocumentView(origin="processes", contents=["processes"], name="processes"),
        rrb.TextLogView(origin="log", name="log"),
    )
