"""What every learning method can be told: the paper's parameters and our switches, with their sources."""

from __future__ import annotations

from dataclasses import dataclass

from docking.angles import DEG
from runtime.params import between, not_negative, one_of, positive

PERCEPTUAL = ("structure-given", "structure-learned")
"""Methods that learn from percepts frame by frame, not from transitions between cells."""


@dataclass(frozen=True)
class Settings:
    """Parameters of the learning methods. Section numbers are of Martinez-Marin and Duckett 2005."""

    method: str = one_of("memory-sweep", "memory-sweep", "prioritised", "q-learning", "advantage", *PERCEPTUAL)
    """Which of `components.learner.methods`. Ours regress how the percept moves and plan with it: `structure-given` is
    told that the camera is on a rigid robot on a floor, `structure-learned` is told nothing. docs/method.md."""
    model: str = one_of("displacement", "displacement", "exits")
    """What the model's filter averages: the change of the continuous state, or which neighbouring cell was entered."""
    adjoining_cells: int = between(1, 1, 8)
    """k: a transition counts only if the cell changes by exactly this (eq. 5). Table I."""
    hold_periods: int = not_negative(0)
    """0: hold an action until the cell changes. Otherwise hold it so many sampling periods and count every successor:
    learning without the adjoining property."""
    sweeps: int = not_negative(1)
    """N: backups of all known (cell, action) after each transition. Section IV."""
    backups: int = positive(20)
    """Prioritised sweeping only: backups after each transition."""
    mirror: bool = True
    """Every transition also counts for the mirrored cell and action. Section V."""
    learning_rate: str = one_of("full", "full", "inverse")
    """Of a backup from the model: 1, since the model averages already, or 1/visits once more. Learning without a model
    always has 1/visits. Table I."""
    process_noise: float = not_negative(0.0)
    """Of the model's filter per visit, in units of the measurement's variance. 0 = running average, as in the paper."""
    goal_reward: float = positive(300.0)
    """Table I."""
    sink_reward: float = between(-50.0, -1e6, 1e6)
    """Table I."""
    too_close: str = one_of("ignored", "ignored", "sink")
    """What reaching the tilt limit inside the ranges teaches: nothing, or that it is a sink (section V, on the robot).
    The distance is hidden from the cells: the same cell further away is none, and calling it one costs 12 points of
    controllability (RL-LC, 40 robot-minutes, 12 seeds: 36 instead of 48 %)."""
    unknown_value: float = between(0.0, -1e6, 1e6)
    """Q of a (cell, action) never tried. 0 as in the paper; the goal's reward makes exploration optimistic."""
    advantage_scale: float = between(0.3, 0.01, 1.0)
    """Advantage learning only (Baird 1993): 1 is Q-learning; smaller spreads the values of actions apart."""
    goal: str = one_of("dock", "dock", "cell")
    """Ours only: what is planned for, the pick-up pose or the paper's goal cell at any distance."""
    grid_angle_rad: float = between(1.5 * DEG, 0.2 * DEG, 10 * DEG)
    """Ours only: spacing of the plan's nodes in beta and alpha. Finer gains nothing, 2 deg costs 2 points."""
    grid_distance_share: float = between(0.107, 0.02, 1.0)
    """Ours only: spacing of the plan's nodes in distance, as a share of the distance at the pick-up: 3 cm."""
    layers_per_frame: int = between(16, 1, 1000)
    """Ours only: layers of the plan's grid that are swept between two frames. One is at most 60 x 2 x 9,300 backups."""
    memory_s: float = positive(600.0)
    """Ours only: time constant of forgetting."""
    surprise: float = positive(9.0)
    """Ours only: motion whose mean square error is so many times the expected one makes it forget what was before, and
    so do smaller errors that last."""
    trust_per_s: float = positive(0.3)
    """Ours only: rates (rad/s; share of the distance per second) known within this are trusted; else the linear
    controller drives."""
    known_per_s: float = positive(0.03)
    """Ours only: where they are not known within this, training tries the least known action if that is safe."""
    room_beta_rad: float = between(80 * DEG, 0.01, 1.55)
    """Ours only: plans may leave the task's range of beta, up to this. The edge is read as well there."""
    room_alpha_rad: float = between(95 * DEG, 0.01, 3.14)
    """As above, for the bearing: 5 deg before the head's end."""
    back_samples: int = between(12, 0, 32)
    """Ours only: driving backwards is planned, and done, for so many frames at a time. If it could change its mind at
    once, motors that follow at once would be sent to and fro between two nodes: docked from 59 instead of 99 %."""
    explore: bool = True
    """Ours only: try the least known action."""


@dataclass(frozen=True, slots=True)
class Rewards:
    """Discount is 1. Per sampling period -1, unless the goal or the sink is entered."""

    goal: float
    sink: float

    def of(self, next_cell: int, goal: int, periods: float) -> float:
        """Reward of one transition (paper, section V)."""
        if next_cell == goal:
            return self.goal
        return self.sink if next_cell < 0 else -periods
