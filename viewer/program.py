"""Rerun's own program, which the wheel brings, as a child process: the native viewer, or what serves a browser.

It listens on 127.0.0.1 alone (by default it would listen everywhere), and tells nobody that it was used.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Self

import rerun_cli  # type: ignore[import-untyped]

from runtime.params import ConfigurationError
from viewer.loopback import HOST, free_port

_READY_S = 30.0
_POLL_S = 0.02
_GRACE_S = 3.0
_TIED = """
import ctypes, os, signal, sys
ctypes.CDLL(None).prctl(1, signal.SIGTERM)
os.execv(sys.argv[1], sys.argv[1:])
"""
"""Linux ends it when this process ends, however that ends (PR_SET_PDEATHSIG)."""


class Program:
    """The running program. Use as a context manager."""

    def __init__(self, words: Sequence[str], memory_limit: str) -> None:
        """Start it.

        Args:
            words: of its command line, without ports and limits.
            memory_limit: most that it keeps, in Rerun's words ("1GB"); the oldest goes first.

        Raises:
            ConfigurationError: it is not there or does not get ready.
        """
        self.port = free_port()
        with ExitStack() as stack:
            home = stack.enter_context(tempfile.TemporaryDirectory(prefix="berth-view-"))
            limits = [f"--memory-limit={memory_limit}", f"--server-memory-limit={memory_limit}"]
            ends = [f"--bind={HOST}", f"--port={self.port}"]
            self._log = Path(home) / "rerun.log"
            with self._log.open("wb") as log:
                self._process = subprocess.Popen(  # noqa: S603  (the wheel's own program)
                    [sys.executable, "-c", _TIED, str(_program()), *words, *ends, *limits, "--hide-welcome-screen"],
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=subprocess.STDOUT,
                    env={**os.environ, **_silence(Path(home))},
                    process_group=0,
                )
            stack.callback(self._stop)
            self._await(self.port)
            self._stack = stack.pop_all()

    def _await(self, port: int) -> None:
        deadline_s = time.monotonic() + _READY_S
        while not self.is_over and time.monotonic() < deadline_s:
            with socket.socket() as probe:
                if probe.connect_ex((HOST, port)) == 0:
                    return
            time.sleep(_POLL_S)
        raise ConfigurationError(f"the viewer does not start: {self.complaint}")

    @property
    def pid(self) -> int:
        """Of the process."""
        return self._process.pid

    @property
    def url(self) -> str:
        """Where recordings are sent."""
        return f"rerun+http://{HOST}:{self.port}/proxy"

    @property
    def is_over(self) -> bool:
        """Whether it has ended because a person has closed it.

        Raises:
            ConfigurationError: it has failed.
        """
        code = self._process.poll()
        if code:
            raise ConfigurationError(f"the viewer has ended: {self.complaint}; --web and --save need no display")
        return code is not None

    @property
    def complaint(self) -> str:
        """What it says of its failure."""
        text = self._log.read_text(errors="replace") if self._log.exists() else ""
        lines = [line.strip() for line in text.splitlines() if line.strip()]
        worst = next((line for line in lines if line.startswith("Error") or "panicked" in line), "")
        return (worst or (lines or ["it says nothing"])[-1])[:300]

    def _stop(self) -> None:
        self._process.terminate()
        try:
            self._process.wait(_GRACE_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def __enter__(self) -> Self:
        """It runs already."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End it."""
        self._stack.close()


def native(memory_limit: str) -> Program:
    """The viewer in a window of its own.

    Raises:
        ConfigurationError: there is no display.
    """
    if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise ConfigurationError("berth view: there is no display here; use --web, --foxglove or --save FILE.rrd")
    return Program(["--expect-data-soon"], memory_limit)


def served(memory_limit: str) -> tuple[Program, int]:
    """What the viewer in a browser is made of and reads from: (program, port of its pages)."""
    pages = free_port()
    return Program(["--serve-web", f"--web-viewer-port={pages}"], memory_limit), pages


def _program() -> Path:
    return Path(rerun_cli.__file__).parent / "rerun"


def _silence(home: Path) -> dict[str, str]:
    """Environment in which it sends no usage data: it has no option for that, only a file."""
    folder = home / "rerun"
    folder.mkdir()
    table = {
        "analytics_enabled": False,
        "analytics_id": "",
        "metadata": {},
        "config_file_path": str(folder / "analytics.json"),
        "data_dir_path": str(home),
    }
    (folder / "analytics.json").write_text(json.dumps(table), encoding="utf-8")
    return {"XDG_CONFIG_HOME": str(home), "TELEMETRY_ENABLED": "false", "NO_COLOR": "1", "RUST_LOG": "warn"}
