"""Learned controllers as files, to be asked from Python.

policy = load_policy("policies/table2-geometric-RL-LC-0.policy")
v_mps, omega_radps = policy.act(beta_rad, alpha_rad, d_m)
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from docking.linear import BEST_TUNED, Linear, teacher_action
from docking.policy import PolicyTable


@dataclass(frozen=True)
class Policy:
    """A learned policy, asked about a state relative to the goal."""

    table: PolicyTable

    def act(self, beta_rad: float, alpha_rad: float, d_m: float) -> tuple[float, float]:
        """Speed (m/s) and turn rate (rad/s, positive to the left) for a state.

        The table does not know the distance. In a cell where nothing was learned the best-tuned linear law decides;
        outside the ranges the robot stands.
        """
        del d_m
        table = self.table
        cell = table.grid.cell(beta_rad, alpha_rad)
        if cell < 0:
            return 0.0, 0.0
        action = table.act_in(cell)
        if action is None:
            fastest = max(omega for _, omega in table.actions)
            action = teacher_action(Linear(*BEST_TUNED, fastest), table.grid, cell, table.actions)
        return table.actions[action]


def export(table: PolicyTable, folder: Path, name: str) -> Path:
    """Write a table to `folder/NAME.policy`; returns its path."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name.replace(',', '').replace(' ', '_')}.policy"
    path.write_bytes(table.to_bytes())
    return path


def load_policy(path: str | Path) -> Policy:
    """Read what `export` or `berth relearn` wrote.

    Raises:
        ValueError: the file is no policy; says why.
        OSError: it can not be read.
    """
    return Policy(PolicyTable.from_bytes(Path(path).read_bytes()))
