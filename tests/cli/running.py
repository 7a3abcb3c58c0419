"""The command as a process, and what is heard beside it, for the tests of `berth record` and `play`."""

import json
import subprocess
import sys
import threading
from pathlib import Path

from runtime.listener import Listener
from runtime.recording import Logged, Recording
from tests.runtime.system import DEADLINE_S


def berth(*words, stdin=subprocess.DEVNULL) -> subprocess.Popen:
    """The command as a process of its own."""
    command = [sys.executable, "-m", "cli.main", *map(str, words)]
    return subprocess.Popen(command, stdin=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def finish(process: subprocess.Popen) -> tuple[int, str, str]:
    """Exit code, standard output and standard error of a process that ends soon."""
    out, err = process.communicate(timeout=DEADLINE_S)
    return process.returncode, out, err


def told(process: subprocess.Popen) -> dict:
    """The JSON object of a process that succeeds."""
    code, out, err = finish(process)
    assert code == 0, err
    return json.loads(out.splitlines()[-1])


def messages(file: Path) -> list[Logged]:
    return list(Recording(file).messages())


def by_key(rows) -> dict[str, list[Logged]]:
    found: dict[str, list[Logged]] = {}
    for row in rows:
        found.setdefault(row.topic, []).append(row)
    return found


def is_growing(file: Path):
    """A condition: the file holds more than its head, and more than when asked first."""
    sizes: list[int] = []

    def condition() -> bool:
        sizes.append(file.stat().st_size if file.exists() else 0)
        return sizes[-1] > max(8192, next((size for size in sizes if size), 0))

    return condition


class Ear(threading.Thread):
    """Listens on a thread of its own."""

    def __init__(self, run, keys):
        super().__init__(daemon=True)
        self._listener = Listener(run, keys, block=True)
        self.rows: list[Logged] = []
        self._done = threading.Event()

    def run(self):
        quiet = 0
        while not (self._done.is_set() and quiet > 2):
            heard = self._listener.take(0.05)
            quiet = quiet + 1 if heard is None else 0
            if heard is not None:
                self.rows.append(Logged(heard.key, heard.schema, heard.payload, *heard.stamp, 0))

    def finish(self):
        self._done.set()
        self.join(DEADLINE_S)
        with self._listener:
            assert (self._listener.dropped, self._listener.refused) == (0, 0)
