"""Memory of processes over time, and whether it stays flat."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple

_OWN = ("Private_Clean:", "Private_Dirty:")


class Sample(NamedTuple):
    """What a process had at one moment."""

    at_s: float
    mb: float


def private_mb(pid: int) -> float | None:
    """Memory that a process shares with nobody (Linux); None if it is gone.

    Resident memory also counts the pages of libraries that many processes share: a leak would hide among them.
    """
    try:
        lines = Path(f"/proc/{pid}/smaps_rollup").read_text(encoding="ascii").splitlines()
    except (FileNotFoundError, ProcessLookupError):
        return None
    return sum(int(line.split()[1]) for line in lines if line.startswith(_OWN)) / 1024


class Memory:
    """Series of samples, by the name of the process."""

    def __init__(self) -> None:
        """Nobody was looked at."""
        self.series: dict[str, list[Sample]] = {}

    def look(self, pids: Mapping[str, int], at_s: float) -> None:
        """Take one sample of each process that runs."""
        for name, pid in pids.items():
            mb = private_mb(pid)
            if mb is not None:
                self.series.setdefault(name, []).append(Sample(at_s, mb))

    def write(self, file: Path) -> None:
        """As CSV: process, time (s), private memory (MB)."""
        rows = [f"{name},{at_s:.1f},{mb:.2f}" for name, samples in self.series.items() for at_s, mb in samples]
        file.write_text("\n".join(["process,s,MB", *rows]) + "\n", encoding="ascii")


def quarter(samples: Sequence[Sample], number: int) -> float:
    """Median of a quarter of the time, 0 to 3; 0 if nobody looked then."""
    first_s, length_s = samples[0].at_s, samples[-1].at_s - samples[0].at_s
    found = [mb for at_s, mb in samples if min(3, int(4 * (at_s - first_s) / (length_s or 1.0))) == number]
    return median(found) if found else 0.0


def growth(samples: Sequence[Sample]) -> float:
    """How much more the last quarter has than the second, as a share; the first is warm-up.

    Medians, because one garbage collection is no leak; of a steady leak a series shows half.
    """
    before = quarter(samples, 1)
    return quarter(samples, 3) / before - 1.0 if before else float("inf")
