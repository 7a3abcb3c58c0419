"""Two machines for tests: network namespaces with a cable between them (Linux, root, iproute2)."""

from __future__ import annotations

import json
import os
import secrets
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

import pytest

from benchmarks.watched import command_line

ROOT = Path(__file__).parent.parent
ROBOT_ADDRESS, LAPTOP_ADDRESS = "10.91.77.1", "10.91.77.2"


def ip(*words: str) -> str:
    return subprocess.run(["ip", *words], check=True, capture_output=True, text=True).stdout


class Machine:
    """One of the two, with run files of its own."""

    def __init__(self, name: str, device: str, home: Path) -> None:
        self.name = name
        self.device = device
        self.home = home
        self._started: list[subprocess.Popen[str]] = []

    def berth(self, *words: str, output: IO[str] | int = subprocess.PIPE) -> subprocess.Popen[str]:
        """Start a command of ours on this machine."""
        process = subprocess.Popen(
            ["ip", "netns", "exec", self.name, *command_line(*words)],
            cwd=ROOT,
            env={**os.environ, "XDG_RUNTIME_DIR": str(self.home)},
            stdout=output,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._started.append(process)
        return process

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

    def __init__(self, robot: Machine, laptop: Machine) -> None:
        self.robot = robot
        self.laptop = laptop

    def cut(self) -> None:
        ip("-n", self.robot.name, "link", "set", self.robot.device, "down")

    def mend(self) -> None:
        ip("-n", self.robot.name, "link", "set", self.robot.device, "up")


@contextmanager
def two_machines(directory: Path) -> Iterator[Cable]:
    """Skips the test, with the reason, where namespaces can not be made."""
    if shutil.which("ip") is None:
        pytest.skip("`ip` (iproute2) is not installed")
    tag = secrets.token_hex(3)
    machines = []
    try:
        for host, address in (("robot", ROBOT_ADDRESS), ("laptop", LAPTOP_ADDRESS)):
            home = directory / host
            home.mkdir(mode=0o700)
            machines.append(Machine(f"berth-{host}-{tag}", f"v{host[0]}{tag}", home))
            _plug(machines, address)
        yield Cable(*machines)
    except subprocess.CalledProcessError as error:
        pytest.skip(f"network namespaces can not be made here: {error.stderr.strip()}")
    finally:
        for machine in machines:
            machine.close()
            subprocess.run(["ip", "netns", "del", machine.name], check=False, capture_output=True)


def _plug(machines: list[Machine], address: str) -> None:
    own = machines[-1]
    ip("netns", "add", own.name)
    ip("-n", own.name, "link", "set", "lo", "up")
    if len(machines) == 1:
        return
    robot = machines[0]
    ends = ["link", "add", robot.device, "netns", robot.name, "type", "veth"]
    ip(*ends, "peer", "name", own.device, "netns", own.name)
    for machine, there in ((robot, ROBOT_ADDRESS), (own, address)):
        ip("-n", machine.name, "addr", "add", f"{there}/24", "dev", machine.device)
        ip("-n", machine.name, "link", "set", machine.device, "up")
