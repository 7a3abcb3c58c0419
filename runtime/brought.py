"""The launch files that Berth brings, for whoever has no checkout."""

from __future__ import annotations

import os
from pathlib import Path

FOLDER = Path(__file__).parent.parent / "launch"
"""Beside the packages, in a checkout and where a wheel was installed."""


def launch_file(name: str | Path) -> Path:
    """A launch file by its path; where there is none, one that Berth brings: `sim`, or `launch/sim.toml`."""
    path = Path(name)
    brought = FOLDER / f"{path.stem}.toml"
    is_ours = path in (Path(path.stem), Path("launch", brought.name))
    return brought if is_ours and not os.path.isfile(path) and os.path.isfile(brought) else path  # noqa: PTH113
