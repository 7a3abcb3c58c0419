"""What one robot says of its frames, brought together. Several robots may share a learner; each has its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from components.learner.holding import Holding
from components.learner.join import Join
from components.learner.ports import Params
from docking.cells import Grid


@dataclass
class Chain:
    """One robot's frames that are not complete, the action that it holds, and how far it was learned from."""

    join: Join
    holding: Holding
    newest_ns: int = -1
    """Newest frame that was learned from; -1 = the robot has not been heard of."""

    @staticmethod
    def of(params: Params, grid: Grid) -> Chain:
        """A robot that has not been heard of."""
        return Chain(Join(params.join_frames), Holding(params, grid))

    def to_plain(self) -> dict[str, Any]:
        """As JSON can say it."""
        return {"join": self.join.to_plain(), "hold": self.holding.to_plain(), "newest_ns": self.newest_ns}

    def from_plain(self, plain: dict[str, Any]) -> None:
        """Take over what `to_plain` gave.

        Raises:
            KeyError, TypeError, ValueError: it is nothing of the kind.
        """
        self.join.from_plain(plain["join"])
        self.holding.from_plain(plain["hold"])
        self.newest_ns = int(plain["newest_ns"])
