"""Writes pictures and poses as a session: images, base readings, and a journal by which the eyes can be replayed."""

from __future__ import annotations

import dataclasses
import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from cli.intake.found import Found, Picture, Pose, Useless
from cli.intake.picture import PictureError, Size, as_jpeg
from runtime.contract import STOP, ComponentError
from runtime.journal import JournalWriter
from runtime.launch import resolve
from runtime.log import LogWriter
from runtime.params import ConfigurationError
from runtime.system import System
from schemas.drive_pb2 import BaseState
from schemas.image_pb2 import CompressedImage

IMAGE, STATE, JOURNAL = "camera/image", "base/state", "vision/journal"
_CAMERA_JOURNAL = "camera/journal"
_CAMERA, _VISION, _BASE = 1, 2, 3
"""Run ids: an imported session has had one run of each."""
_LEAD_NS = 1_000_000_000
"""Session time of the first thing found; what was captured up to so much before it may still come."""
_LATEST = datetime(2262, 1, 1, tzinfo=UTC)


@dataclass
class Intake:
    """What came of an import."""

    images: int = 0
    poses: int = 0
    size: Size = (0, 0)
    session_s: float = 0.0
    skipped: Counter[str] = field(default_factory=Counter)
    """Why -> how many were left out."""


def write(found: Iterable[Found], output: Path, source: Path) -> Intake:
    """Write a session; nothing is made before the first picture that can be used.

    Raises:
        ConfigurationError: no picture can be used, or the file exists already or can not be made.
    """
    writer = _Session(output, source)
    try:
        for item in found:
            writer.take(item)
        return writer.finish()
    except ComponentError as error:  # the disk is full
        writer.abandon()
        raise ConfigurationError(str(error)) from None
    except BaseException:
        writer.abandon()
        raise


class _Session:
    def __init__(self, output: Path, source: Path) -> None:
        self.intake = Intake()
        self._output, self._source = output, source
        self._log: LogWriter | None = None
        self._origin_ns: int | None = None
        self._time_ns = self._first_ns = 0
        self._newest = {IMAGE: -1, STATE: -1}
        """Capture time of each topic's newest message."""
        self._journal = JournalWriter()
        self._batches = 0
        self._early: list[tuple[int, Pose]] = []
        """Poses before the first picture."""

    def take(self, item: Found) -> None:
        if isinstance(item, Useless):
            self.intake.skipped[item.why] += 1
            return
        if self._origin_ns is None:
            self._origin_ns = item.stamp_ns - _LEAD_NS
        topic = IMAGE if isinstance(item, Picture) else STATE
        capture_ns = item.stamp_ns - self._origin_ns
        if capture_ns <= self._newest[topic]:
            self.intake.skipped["not later than the one before"] += 1
            return
        if isinstance(item, Pose):
            self._newest[topic] = capture_ns
            self._pose(item, capture_ns)
        elif self._picture(item, capture_ns):
            self._newest[topic] = capture_ns

    def _picture(self, picture: Picture, capture_ns: int) -> bool:
        try:
            size, data = as_jpeg(picture.data)
        except PictureError as error:
            self.intake.skipped[str(error)] += 1
            return False
        if self._log is None:
            self.intake.size = size
            self._log, self._first_ns = self._opened(picture.stamp_ns), capture_ns
        elif size != self.intake.size:
            self.intake.skipped["another size than the first"] += 1
            return False
        message = CompressedImage(frame_id="camera", data=data, format="jpeg")
        message.timestamp.FromNanoseconds(capture_ns)
        self._write(self._log, IMAGE, message, _CAMERA, self.intake.images, capture_ns)
        self._journal.add("image", _CAMERA, self.intake.images, self._time_ns, 0)
        if self._journal.is_due(0):
            self._write_journal(self._log)
        self.intake.images += 1
        return True

    def _pose(self, pose: Pose, capture_ns: int) -> None:
        if self._log is None:
            self._early = [*self._early[-255:], (capture_ns, pose)]
            return
        x_m, y_m, heading_rad, v_mps, omega_radps = pose[1:]
        message = BaseState(
            odometry_x_m=x_m,
            odometry_y_m=y_m,
            odometry_heading_rad=heading_rad,
            v_mps=v_mps,
            omega_radps=omega_radps,
        )
        self._write(self._log, STATE, message, _BASE, self.intake.poses, capture_ns)
        self.intake.poses += 1

    def _opened(self, stamp_ns: int) -> LogWriter:
        log = LogWriter(self._output, _system(self.intake.size, self._source), started=_started(stamp_ns))
        self._log, early = log, self._early
        for capture_ns, pose in early:
            self._pose(pose, capture_ns)
        return log

    def _write(self, log: LogWriter, topic: str, message: Any, run: int, sequence: int, capture_ns: int) -> None:
        self._time_ns = max(self._time_ns, capture_ns)
        payload = message.SerializeToString(deterministic=True)
        log.write(topic, message.DESCRIPTOR.full_name, payload, run, sequence, capture_ns, self._time_ns)

    def _write_journal(self, log: LogWriter) -> None:
        batch = self._journal.take()
        if batch is not None:
            self._write(log, JOURNAL, batch, _VISION, self._batches, self._time_ns)
            self._batches += 1

    def finish(self) -> Intake:
        """Close the file.

        Raises:
            ConfigurationError: there was no picture that could be used.
        """
        if self._log is None:
            reasons = ", ".join(f"{count} {why}" for why, count in self.intake.skipped.most_common(3))
            what = f"skipped were: {reasons}" if reasons else "it holds none"
            raise ConfigurationError(f"{self._source}: must hold pictures that can be used; {what}")
        self._journal.add(STOP, 0, 0, self._time_ns, 0)
        self._write_journal(self._log)
        idle = JournalWriter()
        idle.add(STOP, 0, 0, self._time_ns, 0)
        if (batch := idle.take()) is not None:
            self._write(self._log, _CAMERA_JOURNAL, batch, _CAMERA, 0, self._time_ns)
        self._log.close()
        self.intake.session_s = (self._newest[IMAGE] - self._first_ns) / 1e9
        return self.intake

    def abandon(self) -> None:
        """Leave no half of a session behind."""
        if self._log is not None:
            self._log.close()
            self._output.unlink(missing_ok=True)


def _system(size: Size, source: Path) -> System:
    """A camera and the eyes, as a launch file would have them."""
    eyes = {"width_px": size[0], "height_px": size[1]}
    table = {
        "realm": "berth/imported",
        "session": {"clock": "real"},
        "component": {
            "camera": {"run": "components.camera", "outputs": {"device": IMAGE}},
            "vision": {"run": "components.vision", "inputs": {"image": IMAGE}, "params": eyes},
        },
    }
    system = resolve(table, str(source))
    plain = json.loads(system.to_json())
    del plain["text"]
    return dataclasses.replace(system, text=json.dumps({**plain, "task": {}}, indent=1, sort_keys=True))


def _started(stamp_ns: int) -> str:
    try:
        return min(datetime.fromtimestamp(stamp_ns / 1e9, UTC), _LATEST).isoformat(timespec="seconds")
    except (OverflowError, ValueError, OSError):
        return ""
