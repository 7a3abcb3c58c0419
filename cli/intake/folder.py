"""A folder of images, in the order of the numbers in their names."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from cli.intake.found import Found, Picture, Useless
from cli.intake.picture import BYTES_MAX
from runtime.params import ConfigurationError

SUFFIXES = frozenset({".jpg", ".jpeg", ".png"})


def images(folder: Path) -> list[Path]:
    """The images, `frame2` before `frame10`.

    Raises:
        ConfigurationError: the folder can not be read.
    """
    try:
        return sorted((file for file in folder.iterdir() if file.suffix.lower() in SUFFIXES), key=natural)
    except OSError as error:
        raise ConfigurationError(f"{folder}: can not be read: {error.strerror}") from None


def natural(file: Path) -> list[tuple[int, str]]:
    """Sorting key that reads numbers as numbers."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"([0-9]+)", file.name)]


def read(files: Sequence[Path], hz: float) -> Iterator[Found]:
    """Each image, at a steady rate."""
    for number, file in enumerate(files):
        try:
            if file.stat().st_size > BYTES_MAX:
                yield Useless("too many bytes")
                continue
            yield Picture(round(number * 1e9 / hz), file.read_bytes())
        except OSError:
            yield Useless("can not be read")
