"""Two machines: network namespaces with a cable or a bad radio between them (Linux, root, iproute2)."""

from __future__ import annotations

import json
import os
import secrets
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import IO

from benchmarks.watched import command_line
from benchmarks.wire import Quality, Wire

ROOT = Path(__file__).parent.parent
ROBOT_ADDRESS, LAPTOP_ADDRESS = "10.91.77.1", "10.91.77.2"


class NoMachines(Exception):  # noqa: N818  (says what is, not what failed)
    """Network namespaces, or what must lie between them, can not be made here."""


def ip(*words: str) -> str:
    """Run `ip` and return what it says."""
    return subprocess.run(["ip", *words], check=True, capture_output=True, text=True).stdout


class Machine:
    """One of the two, with run files of its own."""

    def __init__(self, host: str, tag: str, home: Path) -> None:
        """Nothing is made by this."""
        self.host = host
        self.name = f"berth-{host}-{tag}"
        self.device = f"v{host[0]}{tag}"
        self.home = home
        self.ahead_s = 0.0
        """Its clocks, the monotonic one and that on the wall, against this machine's."""
        self._started: list[subprocess.Popen[str]] = []

    def berth(self, *words: str, output: IO[str] | int = subprocess.PIPE) -> subprocess.Popen[str]:
        """Start a command of ours on this machine."""
        return self.run(*command_line(*words), output=output)

    def run(self, *words: str, output: IO[str] | int = subprocess.PIPE) -> subprocess.Popen[str]:
        """Start a program on this machine; its process is the one returned."""
        clock = ("unshare", "--time", "--monotonic", f"{self.ahead_s:.0f}") if self.ahead_s else ()
        wall = {"LD_PRELOAD": str(self._wall_clock()), "BERTH_AHEAD_S": f"{self.ahead_s:.0f}"} if self.ahead_s else {}
        process = subprocess.Popen(
            ["ip", "netns", "exec", self.name, *clock, *words],
            cwd=ROOT,
            env={**os.environ, "XDG_RUNTIME_DIR": str(self.home), **wall},
            stdin=subprocess.PIPE,
            stdout=output,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._started.append(process)
        return process

    def _wall_clock(self) -> Path:
        """The library that puts it ahead: there is no namespace for it."""
        if shutil.which("cc") is None:
            raise NoMachines("`cc`, a C compiler, is not installed")
        library = self.home / "wall_clock.so"
        if not library.exists():
            source = Path(__file__).with_name("wall_clock.c")
            words = ("cc", "-O2", "-shared", "-fPIC", "-o", str(library), str(source))
            subprocess.run(words, check=True, capture_output=True, text=True)
        return library

    def words(self) -> list[str]:
        """What the supervisor has noted: each line begins with its wall-clock time."""
        logs = list((self.home / "berth" / "logs").glob("*/supervisor.log"))
        return [line for log in logs for line in log.read_text(encoding="utf-8").splitlines()]

    def sent_bytes(self) -> int:
        """What has left by the cable so far."""
        (link,) = json.loads(ip("-n", self.name, "-s", "-j", "link", "show", self.device))
        return int(link["stats64"]["tx"]["bytes"])

    def connections(self) -> int:
        """TCP connections over the cable."""
        lines = Path(f"/proc/{self._started[0].pid}/net/tcp").read_text(encoding="ascii").splitlines()[1:]
        rows = [line.split() for line in lines]
        return sum(row[3] == "01" and not row[2].startswith("0100007F") for row in rows)

    def close(self) -> None:
        """End whatever was started."""
        for process in self._started:
            if process.poll() is None:
                process.kill()  # its children see the end of their input
            process.communicate()


class Cable:
    """Between the two; pulled out and put in again at the robot."""

    def __init__(self, robot: Machine, laptop: Machine, wire: Wire | None = None) -> None:
        """Both ends are plugged in."""
        self.robot = robot
        self.laptop = laptop
        self._wire = wire

    def become(self, quality: Quality) -> None:
        """Lose and delay packets from now on; a radio only."""
        assert self._wire is not None
        self._wire.become(quality)

    def narrow(self, bits_per_s: int) -> None:
        """Let so much through in each direction, with a queue of a tenth of a second before it (tc tbf)."""
        for machine in (self.robot, self.laptop):
            rate = ("rate", f"{bits_per_s}", "burst", "3200", "latency", "100ms")
            words = ("tc", "qdisc", "replace", "dev", machine.device, "root", "tbf", *rate)
            subprocess.run(["ip", "netns", "exec", machine.name, *words], check=True, capture_output=True, text=True)

    def cut(self) -> None:
        """Pull it out."""
        ip("-n", self.robot.name, "link", "set", self.robot.device, "down")

    def mend(self) -> None:
        """Put it in again."""
        ip("-n", self.robot.name, "link", "set", self.robot.device, "up")


@contextmanager
def two_machines(directory: Path, *, radio: bool = False) -> Iterator[Cable]:
    """Two machines with a cable (a veth pair), or a radio that can be bad, between them.

    Raises:
        NoMachines: they can not be made here; says why.
    """
    if shutil.which("ip") is None:
        raise NoMachines("`ip` (iproute2) is not installed")
    tag = secrets.token_hex(3)
    machines = []
    for host in ("robot", "laptop"):
        (directory / host).mkdir(mode=0o700)
        machines.append(Machine(host, tag, directory / host))
    try:
        with ExitStack() as stack:
            yield Cable(machines[0], machines[1], _plugged(machines, stack, radio=radio))
    except subprocess.CalledProcessError as error:
        raise NoMachines(f"network namespaces can not be made here: {error.stderr.strip()}") from error
    finally:
        for machine in machines:
            machine.close()
            subprocess.run(["ip", "netns", "del", machine.name], check=False, capture_output=True)


def _plugged(machines: list[Machine], stack: ExitStack, *, radio: bool) -> Wire | None:
    robot, laptop = machines
    for machine in machines:
        ip("netns", "add", machine.name)
        ip("-n", machine.name, "link", "set", "lo", "up")
    wire = None
    if radio:
        wire = _wire(robot.device, laptop.device, stack)
        for machine in machines:
            ip("link", "set", machine.device, "netns", machine.name)
    else:
        ends = ["link", "add", robot.device, "netns", robot.name, "type", "veth"]
        ip(*ends, "peer", "name", laptop.device, "netns", laptop.name)
    for machine, address in ((robot, ROBOT_ADDRESS), (laptop, LAPTOP_ADDRESS)):
        ip("-n", machine.name, "addr", "add", f"{address}/24", "dev", machine.device)
        ip("-n", machine.name, "link", "set", machine.device, "up")
    return wire


def _wire(near: str, far: str, stack: ExitStack) -> Wire:
    try:
        return stack.enter_context(Wire(near, far))
    except OSError as error:
        raise NoMachines(str(error)) from error
