"""The learning methods, one list in one place. Each learns from transitions and gives a policy table."""

from __future__ import annotations

from collections.abc import Mapping

from components.learner.methods.advantage import Advantage
from components.learner.methods.memory_sweep import MemorySweep
from components.learner.methods.prioritised import Prioritised
from components.learner.methods.q_learning import QLearning
from components.learner.methods.tabular import Tabular
from components.learner.settings import Settings
from docking.task import Task
from runtime.params import ConfigurationError

METHODS: Mapping[str, type[Tabular]] = {
    "memory-sweep": MemorySweep,
    "prioritised": Prioritised,
    "q-learning": QLearning,
    "advantage": Advantage,
}
"""By the name that `Settings.method` has."""


def make_method(task: Task, settings: Settings) -> Tabular:
    """The method of transitions that the settings name, knowing nothing yet.

    Raises:
        ConfigurationError: it is one of frames; see `methods.perceptual`.
    """
    if settings.method not in METHODS:
        raise ConfigurationError(f"learner.method must be one of {', '.join(METHODS)} here; got {settings.method!r}")
    return METHODS[settings.method](task, settings)
