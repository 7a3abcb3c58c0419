"""A TOML file, read."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from runtime.params import ConfigurationError


def read_toml(path: Path) -> dict[str, Any]:
    """The file's table.

    Raises:
        ConfigurationError: it can not be read, or is not TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigurationError(f"{path}: can not be read: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ConfigurationError(f"{path}: is not TOML: {error}") from None
