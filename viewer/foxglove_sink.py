"""Translates what is shown into Foxglove's words, each entity a topic; the plan is one scene."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from foxglove import Channel, Context
from foxglove.channels import (
    CompressedImageChannel,
    ImageAnnotationsChannel,
    LogChannel,
    SceneUpdateChannel,
)
from foxglove.messages import (
    CircleAnnotation,
    Color,
    CompressedImage,
    Duration,
    ImageAnnotations,
    LinePrimitive,
    LinePrimitiveLineType,
    Log,
    LogLevel,
    Point2,
    Point3,
    PointsAnnotation,
    PointsAnnotationType,
    SceneEntity,
    SceneUpdate,
    Timestamp,
)

from viewer.shown import Colour, Dots, Lines, Number, Page, Picture, Remark, Shown, What, Word

PLAN = "plan"
FRAME = "table"
"""Of the plan: the world of `docking.plant`."""
_SECOND_NS = 1_000_000_000


class FoxgloveSink:
    """Logs to one context. Whoever joins late is shown the newest of everything again."""

    def __init__(self, context: Context, origin_ns: int) -> None:
        """Log to a context.

        Args:
            context: that a server or a file listens to.
            origin_ns: wall-clock time at session time 0.
        """
        self._context = context
        self._origin_ns = origin_ns
        self._channels: dict[str, Any] = {}
        self._newest: dict[str, Shown] = {}
        self._standing: dict[str, What] = {}
        self._joined = False

    def stands(self, entities: Mapping[str, What]) -> None:
        """Show what is there at all times."""
        self._standing = dict(entities)
        self._joined = True

    def joined(self) -> None:
        """Somebody looks who did not; from any thread."""
        self._joined = True

    def show(self, shown: Iterable[Shown]) -> None:
        """Send at once."""
        for each in shown:
            self._newest[each.entity] = each
            self._send(each)

    def flush(self) -> None:
        """Tell those who have joined what was said before."""
        if not self._joined:
            return
        self._joined = False
        now_ns = max((each.time_ns for each in self._newest.values()), default=0)
        for entity, what in self._standing.items():
            self._send(Shown(entity, now_ns, what))
        for each in list(self._newest.values()):
            self._send(each._replace(time_ns=now_ns))

    def _send(self, shown: Shown) -> None:
        topic, make, message = _translated(shown, self.stamp(shown.time_ns))
        channel = self._channels.get(topic)
        if channel is None:
            channel = self._channels[topic] = make(topic, context=self._context)
        channel.log(message, log_time=self._origin_ns + shown.time_ns)

    def stamp(self, time_ns: int) -> Timestamp:
        """A session time as wall-clock time."""
        seconds, rest_ns = divmod(self._origin_ns + time_ns, _SECOND_NS)
        return Timestamp(sec=seconds, nsec=rest_ns)


Translated = tuple[str, Callable[..., Any], Any]
"""Topic, what makes its channel, message."""


def _translated(shown: Shown, stamp: Timestamp) -> Translated:
    topic, what = f"/{shown.entity}", shown.what
    match what:
        case Number():
            return topic, _numbers, {"value": what.value}
        case Word():
            return topic, _words, {"state": what.text}
        case Page():
            return f"{topic}/page", _pages, {"text": what.text}
        case Remark():
            level = LogLevel.Warning if what.is_bad else LogLevel.Info
            return topic, LogChannel, Log(timestamp=stamp, level=level, message=what.text, name=shown.entity)
        case Picture():
            image = CompressedImage(timestamp=stamp, frame_id=shown.entity, data=what.data, format=what.format)
            return topic, CompressedImageChannel, image
        case Lines() | Dots():
            return _drawn(topic, shown, what, stamp)


def _drawn(topic: str, shown: Shown, what: Lines | Dots, stamp: Timestamp) -> Translated:
    if isinstance(what, Lines) and shown.entity.startswith(PLAN):
        return f"/{PLAN}", SceneUpdateChannel, SceneUpdate(entities=[_scenery(shown, what, stamp)])
    return topic, ImageAnnotationsChannel, _annotations(what, stamp)


def _schema(field: str, kind: str) -> dict[str, Any]:
    return {"type": "object", "title": f"berth.{field}", "properties": {field: {"type": kind}}}


def _numbers(topic: str, *, context: Context) -> Channel:
    return Channel(topic, schema=_schema("value", "number"), context=context)


def _words(topic: str, *, context: Context) -> Channel:
    return Channel(topic, schema=_schema("state", "string"), context=context)


def _pages(topic: str, *, context: Context) -> Channel:
    return Channel(topic, schema=_schema("text", "string"), context=context)


def _scenery(shown: Shown, lines: Lines, stamp: Timestamp) -> SceneEntity:
    name = shown.entity
    if math.isfinite(lines.lasts_s):
        name = f"{name}/{shown.time_ns}"  # each piece of a trail lives its own time
    seconds = lines.lasts_s if math.isfinite(lines.lasts_s) else 0.0
    return SceneEntity(
        timestamp=stamp,
        frame_id=FRAME,
        id=name,
        lifetime=Duration(sec=int(seconds), nsec=0),
        lines=[
            LinePrimitive(
                type=LinePrimitiveLineType.LineStrip,
                thickness=lines.width_px,
                scale_invariant=True,
                points=[Point3(x=x, y=y, z=0.0) for x, y in strip],
                color=_colour(lines.colour),
            )
            for strip in lines.strips
        ],
    )


def _annotations(what: Lines | Dots, stamp: Timestamp) -> ImageAnnotations:
    colour = _colour(what.colour)
    if isinstance(what, Dots):
        circles = [
            CircleAnnotation(
                timestamp=stamp,
                position=Point2(x=u, y=v),
                diameter=2.0 * what.radius_px,
                thickness=2.0,
                outline_color=colour,
            )
            for u, v in what.points
        ]
        return ImageAnnotations(circles=circles)
    points = [
        PointsAnnotation(
            timestamp=stamp,
            type=PointsAnnotationType.LineStrip,
            points=[Point2(x=u, y=v) for u, v in strip],
            outline_color=colour,
            thickness=what.width_px,
        )
        for strip in what.strips
    ]
    return ImageAnnotations(points=points)


def _colour(colour: Colour) -> Color:
    red, green, blue, opacity = (level / 255 for level in colour)
    return Color(r=red, g=green, b=blue, a=opacity)
