"""The experiments, by name. A module is imported only when its experiment is asked for."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import cast

from experiments.campaign import Experiment
from runtime.params import ConfigurationError

EXPERIMENTS: Mapping[str, str] = {
    "ceiling": "experiments.ceiling",
    "paper-robot": "experiments.paper_robot",
    "docking-law": "experiments.law_comparison",
    "trajectories": "experiments.trajectories",
    "table2": "experiments.table2",
    "curves": "experiments.curves",
    "ablation": "experiments.ablation",
    "schools": "experiments.schools",
    "minutes": "experiments.minutes",
    "minutes-two-speeds": "experiments.minutes_two_speeds",
    "minutes-reverse": "experiments.minutes_reverse",
    "minutes-changed": "experiments.minutes_changed",
    "minutes-mid-session": "experiments.minutes_mid_session",
    "fleet": "experiments.fleet",
    "faults": "experiments.faults.experiment",
}
"""Name on the command line: module with `NAME`, `jobs`, `run` and `draw`."""


def load(name: str) -> Experiment:
    """The experiment of that name.

    Raises:
        ConfigurationError: no such name.
    """
    if name not in EXPERIMENTS:
        raise ConfigurationError(f"experiment must be one of {', '.join(EXPERIMENTS)}; got {name!r}")
    return cast("Experiment", importlib.import_module(EXPERIMENTS[name]))
