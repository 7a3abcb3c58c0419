"""`berth keys`: make the keys by which the hosts of a system know one another."""

from __future__ import annotations

import importlib.util
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from runtime.params import ConfigurationError

if TYPE_CHECKING:
    from cli.authority import Authority

_HOST = re.compile(r"[a-z][a-z0-9_]*")
HOSTS = Annotated[list[str], typer.Option("--host", help="Host of the launch file; once for each.")]
OUT = Annotated[Path, typer.Option("-o", "--output", help="Directory to make, or that `init` has made.")]
DAYS = Annotated[int, typer.Option(help="Days that a host's certificate is valid.")]
_AUTHORITY_DAYS = 3653

keys = typer.Typer(add_completion=False, no_args_is_help=True, rich_markup_mode=None)


@keys.callback()
def _keys() -> None:
    """Make the keys by which the hosts of a system know one another."""


@keys.command()
def init(hosts: HOSTS = ["robot", "laptop"], output: OUT = Path("keys"), days: DAYS = 730) -> None:  # noqa: B006
    """Make an authority and the keys of its hosts. Example: berth keys init --host robot --host laptop -o keys."""
    _check(hosts, days)
    from cli.authority import SIGNING_KEY, Authority, check_free  # noqa: PLC0415
    from runtime.credentials import AUTHORITY  # noqa: PLC0415

    check_free([output / name for name in (AUTHORITY, SIGNING_KEY, *hosts)])
    authority = Authority.new(_AUTHORITY_DAYS, datetime.now(UTC))
    with _written_to(output):
        output.mkdir(mode=0o700, parents=True, exist_ok=True)
        authority.write(output)
        _admit(authority, hosts, output, days)


@keys.command()
def add(hosts: HOSTS, output: OUT = Path("keys"), days: DAYS = 730) -> None:
    """Make keys for more hosts of the same authority. Example: berth keys add --host desk -o keys."""
    _check(hosts, days)
    from cli.authority import Authority, check_free  # noqa: PLC0415

    check_free([output / host for host in hosts])
    authority = Authority.read(output)
    with _written_to(output):
        _admit(authority, hosts, output, days)


def _admit(authority: Authority, hosts: list[str], output: Path, days: int) -> None:
    for host in hosts:
        authority.admit(host, output / host, days, datetime.now(UTC))
        sys.stdout.write(f"{output / host}  copy it to {host}; valid for {days} days\n")
    sys.stdout.write(f"{output}  keep the rest to yourself: with it anybody can make more keys\n")


@contextmanager
def _written_to(output: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise ConfigurationError(f"{output}: can not be written: {error.strerror}") from None


def _check(hosts: list[str], days: int) -> None:
    if importlib.util.find_spec("cryptography") is None:
        raise ConfigurationError("berth keys: the package `cryptography` must be installed: pip install 'berth[keys]'")
    for host in hosts:
        if not _HOST.fullmatch(host):
            raise ConfigurationError(f"--host must be a lower-case word, as in the launch file; got {host[:80]!r}")
    if len(set(hosts)) != len(hosts):
        raise ConfigurationError(f"--host must be given once for each host; got {', '.join(hosts)}")
    if not 1 <= days <= _AUTHORITY_DAYS:
        raise ConfigurationError(f"--days must be between 1 and {_AUTHORITY_DAYS}; got {days}")
