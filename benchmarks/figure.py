"""One number that a benchmark claims, beside what it must be."""

from __future__ import annotations

from typing import NamedTuple


class Figure(NamedTuple):
    """A measured number."""

    name: str
    value: float
    unit: str = ""
    at_least: float | None = None
    at_most: float | None = None
    note: str = ""
    """The floor or the reason, in words."""

    @property
    def kept(self) -> bool | None:
        """Whether the number is what it must be; None if nothing is asked of it."""
        if self.at_least is None and self.at_most is None:
            return None
        low = self.at_least is None or self.value >= self.at_least
        return low and (self.at_most is None or self.value <= self.at_most)

    @property
    def rule(self) -> str:
        """What it must be, in words."""
        words = []
        if self.at_least is not None:
            words.append(f">= {self.at_least:g}")
        if self.at_most is not None:
            words.append(f"<= {self.at_most:g}")
        return " and ".join(words)
