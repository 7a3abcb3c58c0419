"""The two halves of `launch/sim2.toml`, or of something like it, started on two machines."""

from __future__ import annotations

import json
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.machines import ROBOT_ADDRESS, ROOT, Cable, Machine
from benchmarks.watched import START_S, wait_until

FRAME_NS = 125_000_000
APPROACH = "APPROACH"
LAUNCH = (ROOT / "launch" / "sim2.toml").read_text(encoding="utf-8")


class Halves(NamedTuple):
    """`berth run` of each host."""

    robot: subprocess.Popen[str]
    laptop: subprocess.Popen[str]

    def alive(self) -> bool:
        """Whether both run."""
        return all(half.poll() is None for half in self)

    def interrupt(self) -> None:
        """Ctrl-C on the robot."""
        self.robot.send_signal(signal.SIGINT)

    def outputs(self) -> list[tuple[str, str]]:
        """What both have said when they have ended; on a busy machine the report takes a minute."""
        return [half.communicate(timeout=180) for half in self]

    def summaries(self) -> list[dict[str, Any]]:
        """Of both, which must end well."""
        outputs = self.outputs()
        codes = [half.returncode for half in self]
        assert codes == [0, 0], (codes, outputs)
        return [json.loads(out) for out, _ in outputs]


def start(
    cable: Cable, directory: Path, *words: str, launch: str = LAUNCH, record: bool = True, keys: Path | None = None
) -> Halves:
    """`berth run` on both, in a realm of their own, with keys if given; the laptop records and makes a report."""
    file = directory / "two.toml"
    realm = f"test/{directory.parent.name}-{directory.name}"
    file.write_text(launch.replace('"berth/sim2"', f'"{realm}"'), encoding="utf-8")
    there = f"{'tls' if keys else 'tcp'}/{ROBOT_ADDRESS}:7447"
    guard = ("--keys", str(keys)) if keys else ()
    alone = () if keys else ("--insecure",)
    recording = ("--record", str(directory / "laptop.mcap")) if record else ("--no-record",)
    common = ("--json", *recording, *guard, *words)
    robot = ("run", str(file), "--host", "robot", "--listen", there, *alone, *common)
    return Halves(cable.robot.berth(*robot), _laptop(cable, file, there, *common))


def rejoin(cable: Cable, directory: Path, halves: Halves, recording: Path) -> Halves:
    """Start the laptop again, which has ended; without keys."""
    words = ("--json", "--record", str(recording))
    return halves._replace(laptop=_laptop(cable, directory / "two.toml", f"tcp/{ROBOT_ADDRESS}:7447", *words))


def _laptop(cable: Cable, file: Path, there: str, *words: str) -> subprocess.Popen[str]:
    return cable.laptop.berth("run", str(file), "--host", "laptop", "--connect", there, *words)


def awaits_run_file(machine: Machine) -> None:
    """Until tools find the system that runs there."""
    assert wait_until(lambda: list(machine.home.glob("berth/*.run.json")), START_S)


class Echo:
    """`berth topic echo KEY` on a machine, as far as it has come."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def last(self) -> dict[str, Any]:
        """The newest whole line: the message's fields and its frame; only `frame` (-1) before the first."""
        line = self._file.read_text(encoding="utf-8").rpartition("\n")[0].rpartition("\n")[2]
        if not line:
            return {"frame": -1}
        table = json.loads(line)
        return {**table["message"], "frame": round(table["capture_s"] * 8)}


@contextmanager
def echoed(machine: Machine, key: str, file: Path) -> Iterator[Echo]:
    """What comes on a key, as heard on a machine."""
    with file.open("w", encoding="utf-8") as stream:
        machine.berth("topic", "echo", key, "--json", output=stream)
        yield Echo(file)
