"""A TOML file, read."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from runtime.params import ConfigurationError

LARGEST_BYTES = 1_000_000
"""A launch file has 3 kB; what never ends is not read to its end."""


def read_toml(path: Path) -> dict[str, Any]:
    """The file's table.

    Raises:
        ConfigurationError: it can not be read, or is not TOML.
    """
    try:
        with path.open("rb") as stream:
            content = stream.read(LARGEST_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise ConfigurationError(f"{path}: can not be read: {reason}") from None
    if len(content) > LARGEST_BYTES:
        raise ConfigurationError(f"{path}: must be no larger than {LARGEST_BYTES} bytes")
    try:
        return tomllib.loads(content.decode())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ConfigurationError(f"{path}: is not TOML: {error}") from None
