"""Shows a recording, all of it at once; the viewer's own time line does the rest."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from runtime.clock import SECOND_NS
from runtime.params import ConfigurationError
from runtime.recording import Recording
from viewer.live import Sink
from viewer.scene import Scene

_PICTURES = 4000
"""Camera images shown of one file, at the most; a longer one is shown with fewer a second. 40 MB."""
_POLICIES = 600
_TOLD = 2000


def opened(file: Path) -> tuple[Recording, Scene]:
    """A session's file and a scene that shows not too much of it.

    Raises:
        ConfigurationError: no MCAP file, or no session of ours.
    """
    recording = Recording(file)
    launch = recording.launch()
    if not recording.session() or not launch:
        raise ConfigurationError(f"{file}: must be a session recorded by berth")
    first_ns, last_ns = span_ns(recording)
    length_ns = last_ns - first_ns
    return recording, Scene(
        launch,
        picture_ns=max(SECOND_NS // 10, length_ns // _PICTURES),
        policy_ns=max(SECOND_NS // 2, length_ns // _POLICIES),
    )


def span_ns(recording: Recording) -> tuple[int, int]:
    """Session time of the first and of the last frame; (0, 0) in a file without any."""
    frames = recording.messages((str(recording.launch().get("trial")), "camera/image"))
    times = [logged.capture_ns for logged in frames]
    return (min(times), max(times)) if times else (0, 0)


def show(recording: Recording, scene: Scene, sink: Sink, told: Callable[[float], None]) -> None:
    """Show every message.

    Args:
        recording: the session.
        scene: of it.
        sink: the viewer.
        told: called now and then with the session seconds that are shown already.
    """
    sink.stands(scene.furniture())
    for number, logged in enumerate(recording.messages()):
        sink.show(scene.take(logged, logged.capture_ns))
        if number % _TOLD == 0:
            told(logged.capture_ns / SECOND_NS)
    sink.show(scene.pages())
    sink.flush()
