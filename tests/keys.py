"""Keys of a small system for a test, and of intruders."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

from cli.authority import Authority


def made(directory: Path, *hosts: str, age_days: float = 0.0, days: int = 30) -> Path:
    """A directory as `berth keys init` makes it; made so many days ago."""
    now = datetime.now(UTC) - timedelta(days=age_days)
    directory.mkdir(mode=0o700)
    authority = Authority.new(3653, now)
    authority.write(directory)
    for host in hosts:
        authority.admit(host, directory / host, days, now)
    return directory
