"""The layout to import into Foxglove: the panes that Rerun's has."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from foxglove import layouts as fl

from runtime.params import ConfigurationError
from viewer.foxglove_sink import FRAME

_COLOURS = ("#1f6feb", "#f2a33c", "#1a7f37", "#cf222e", "#8250df", "#57606a")


def write(file: Path) -> None:
    """Write it as JSON.

    Raises:
        ConfigurationError: the file exists or can not be made.
    """
    try:
        with file.open("x", encoding="utf-8") as stream:
            stream.write(layout().to_json())
    except OSError as error:
        raise ConfigurationError(f"--layout {file}: can not be made: {error.strerror}") from None


def layout() -> fl.Layout:
    """Camera, plan and policy above; plots, words below."""
    above = (_image("/camera/image", "object", "edge", "centre"), _plan(), _column(*_policies()))
    below = (_tabs(_fast_plots()), _tabs(_slow_plots()), _tabs(_words()))
    return fl.Layout(content=_column(_row(*above), _row(*below)))


def _image(topic: str, *marks: str) -> fl.ImagePanel:
    shown = {f"{topic}/{mark}": fl.ImageAnnotationSettings(visible=True) for mark in marks}
    return fl.ImagePanel(config=fl.ImageConfig(image_mode=fl.ImageModeConfig(image_topic=topic, annotations=shown)))


def _policies() -> tuple[fl.ImagePanel, fl.ImagePanel]:
    return _image("/policy/action", "robot", "goal"), _image("/policy/value", "robot", "goal")


def _plan() -> fl.ThreeDeePanel:
    above = fl.ThreeDeeCameraState(
        perspective=False, phi=0.0, theta_offset=90.0, distance=4.0, target_offset=(-0.9, 0.0, 0.0)
    )
    shown: dict[str, Any] = {"/plan": fl.BaseRendererSceneUpdateTopicSettings(visible=True)}
    return fl.ThreeDeePanel(config=fl.ThreeDeeConfig(camera_state=above, fixed_frame=FRAME, topics=shown))


def _fast_plots() -> dict[str, fl.PlotPanel]:
    return {
        "pan, tilt": _plot("head/pan_deg", "head/tilt_deg"),
        "percept": _plot("percept/beta_deg", "percept/alpha_deg"),
        "drive": _plot("drive/speed_cmps", "drive/turn_degps"),
        "latency": _plot(
            *(f"latency_ms/{key}" for key in ("camera_image", "vision_view", "tracker_percept", "base_applied"))
        ),
        "losses": _plot("lost/messages", "lost/by_this_viewer"),
    }


def _slow_plots() -> dict[str, fl.PlotPanel]:
    controllers = ("greedy", "random", "lc", "servo")
    return {
        "learning curve": _plot(*(f"learning/{name}" for name in controllers)),
        "policy size": _plot("policy_size/known_percent", "policy_size/transitions"),
    }


def _words() -> dict[str, fl.BasePanel]:
    states = ("pilot/phase", "pilot/mode", "pilot/controller", "drive/commander")
    lanes = [fl.StateTransitionsSeries(value=f"/{name}.state", label=name) for name in states]
    return {
        "states": fl.StateTransitionsPanel(config=fl.StateTransitionsConfig(paths=lanes)),
        "session": _text("/session/page"),
        "processes": _text("/processes/page"),
        "log": fl.LogPanel(config=fl.LogConfig(topic_to_render="/log/trials")),
    }


def _text(topic: str) -> fl.RawMessagesPanel:
    return fl.RawMessagesPanel(config=fl.RawMessagesConfig(topic_path=f"{topic}.text"))


def _plot(*entities: str) -> fl.PlotPanel:
    paths = [
        fl.PlotSeries(value=f"/{entity}.value", label=entity, color=_COLOURS[number % len(_COLOURS)])
        for number, entity in enumerate(entities)
    ]
    return fl.PlotPanel(config=fl.PlotConfig(paths=paths))


def _row(*panes: fl.Content) -> fl.SplitContainer:
    return fl.SplitContainer(direction="row", items=[fl.SplitItem(content=pane) for pane in panes])


def _column(*panes: fl.Content) -> fl.SplitContainer:
    return fl.SplitContainer(direction="column", items=[fl.SplitItem(content=pane) for pane in panes])


def _tabs(panes: Mapping[str, fl.BasePanel]) -> fl.TabContainer:
    return fl.TabContainer(tabs=[fl.TabItem(title=title, content=pane) for title, pane in panes.items()])
