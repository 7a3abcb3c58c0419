"""Two machines for tests; a test that needs them is skipped, with the reason, where they can not be made."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from benchmarks import machines
from benchmarks.machines import ROBOT_ADDRESS, ROOT, Cable, Machine, NoMachines

__all__ = ["ROBOT_ADDRESS", "ROOT", "Cable", "Machine", "two_machines"]


@contextmanager
def two_machines(directory: Path, *, radio: bool = False) -> Iterator[Cable]:
    """As `benchmarks.machines.two_machines`."""
    try:
        with machines.two_machines(directory, radio=radio) as cable:
            yield cable
    except NoMachines as reason:
        pytest.skip(str(reason))
