"""Run files: which systems run on this host, for the commands that look for one.

A run file is locked by its supervisor as long as it lives, so a stale one is never believed.
"""

from __future__ import annotations

import fcntl
import json
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

from runtime.params import ConfigurationError

_LOGS_KEPT = 16
"""Directories of ended runs that stay for `berth logs`."""


@dataclass(frozen=True)
class Run:
    """A running system, as its run file tells."""

    realm: str
    pid: int
    """Of the supervisor."""
    endpoint: str
    """Of the host's router."""
    started: str
    """Wall-clock time, ISO 8601."""
    launch: str
    """Path of the launch file."""
    directory: str
    """Holds one log per component."""
    components: tuple[str, ...]
    topics: Mapping[str, str]
    """Key below the realm -> full name of its schema, for everything that may come on the bus."""


def private_directory() -> Path:
    """The user's directory for run files and logs: nobody else may look into it or write there.

    Raises:
        ConfigurationError: it exists and belongs to somebody else, or is open to others.
    """
    base = os.environ.get("XDG_RUNTIME_DIR")
    path = Path(base) / "berth" if base else Path(tempfile.gettempdir()) / f"berth-{os.getuid()}"
    path.mkdir(mode=0o700, parents=True, exist_ok=True)
    status = path.lstat()
    if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.getuid() or status.st_mode & 0o077:
        raise ConfigurationError(f"{path}: must be a directory of this user alone (chmod 700)")
    return path


@contextmanager
def claim(
    realm: str, endpoint: str, started: str, launch: str, components: tuple[str, ...], topics: Mapping[str, str]
) -> Iterator[Run]:
    """Hold a realm on this host.

    Raises:
        ConfigurationError: a system of this realm runs already.
    """
    home = private_directory()
    path = _path(home, realm)
    handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
    try:
        if not _lock(handle) or os.fstat(handle).st_ino != _inode(path):
            raise ConfigurationError(f"{launch}: realm must not run yet; got {realm!r}, see `berth ps`")
        _prune(home)
        directory = tempfile.mkdtemp(prefix=f"{_slug(realm)}.", dir=_logs(home))
        run = Run(realm, os.getpid(), endpoint, started, launch, directory, components, topics)
        os.ftruncate(handle, 0)
        os.pwrite(handle, json.dumps(asdict(run)).encode(), 0)
        try:
            yield run
        finally:
            path.unlink(missing_ok=True)
    finally:
        os.close(handle)


def running() -> list[Run]:
    """All systems that run on this host under this user."""
    found = (_read(path) for path in sorted(private_directory().glob("*.run.json")))
    return [run for run in found if run is not None]


def find(realm: str = "") -> Run:
    """The one running system, or the one of this realm.

    Raises:
        ConfigurationError: there is none, or more than one to choose from.
    """
    runs = [run for run in running() if realm in {"", run.realm}]
    if not runs:
        raise ConfigurationError(f"realm {realm} must be running; see `berth ps`" if realm else "nothing is running")
    if len(runs) > 1:
        raise ConfigurationError(f"--realm must be one of {', '.join(run.realm for run in runs)}")
    return runs[0]


def newest_logs(realm: str = "") -> Path:
    """Directory of the newest run's logs, running or ended.

    Raises:
        ConfigurationError: there is none.
    """
    pattern = f"{_slug(realm)}.*" if realm else "*"
    found = sorted(_logs(private_directory()).glob(pattern), key=_modified_s)
    if not found:
        raise ConfigurationError(f"realm {realm or 'of any name'} must have run on this host; there are no logs")
    return found[-1]


def _read(path: Path) -> Run | None:
    """The run of a file whose supervisor lives."""
    try:
        with path.open("rb") as stream:
            if _lock(stream.fileno(), fcntl.LOCK_SH):
                return None
            table = json.load(stream)
        return Run(**{**table, "components": tuple(table["components"])})
    except (OSError, ValueError, TypeError, KeyError):
        return None


def _lock(handle: int, kind: int = fcntl.LOCK_EX) -> bool:
    try:
        fcntl.flock(handle, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _inode(path: Path) -> int:
    try:
        return path.stat().st_ino
    except FileNotFoundError:
        return -1


def _modified_s(path: Path) -> float:
    """When a directory was last written; 0 if another supervisor has removed it meanwhile."""
    try:
        return path.stat().st_mtime
    except FileNotFoundError:
        return 0.0


def _slug(realm: str) -> str:
    return realm.replace("/", "+")


def _path(home: Path, realm: str) -> Path:
    return home / f"{_slug(realm)}.run.json"


def _logs(home: Path) -> Path:
    path = home / "logs"
    path.mkdir(mode=0o700, exist_ok=True)
    return path


def _prune(home: Path) -> None:
    """Remove the oldest log directories, never one of a running system."""
    busy = {run.directory for run in running()}
    ended = sorted((path for path in _logs(home).iterdir() if str(path) not in busy), key=_modified_s)
    for path in ended[: -_LOGS_KEPT or None]:
        shutil.rmtree(path, ignore_errors=True)
