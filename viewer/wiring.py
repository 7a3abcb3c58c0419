"""Which topics are shown, where several have one schema: those that the launch file wires."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from runtime.recorded_launch import specs_of
from runtime.tap import LEAVE_OUT

_PORTS = {
    "image": "foxglove.CompressedImage",
    "view": "berth.View",
    "head": "berth.HeadState",
    "percept": "berth.Percept",
    "applied": "berth.Applied",
    "policy": "berth.Policy",
}
"""Input port -> schema: what a component reads under this name is what the robot goes by."""
STATUS = "berth.Status"
TRIAL, TRUTH = "berth.Trial", "berth.Truth"
SCHEMAS = frozenset({*_PORTS.values(), STATUS, TRIAL, TRUTH, "berth.SessionEnd"})
"""Everything that is looked at; a viewer need not listen to more."""


class Wiring:
    """The one topic of each schema; a schema that nothing is wired to is the first topic's that has it."""

    def __init__(self, launch: Mapping[str, Any]) -> None:
        """Read a resolved launch file of any release: nothing is taken for granted."""
        told = {TRIAL: launch.get("trial"), TRUTH: launch.get("truth")}
        self._keys = {schema: key for schema, key in told.items() if isinstance(key, str) and key}
        self.left_out = _left_out(launch)
        """What a recorder does not ask for, a viewer leaves alone, too: its preview is there."""
        for inputs in _inputs(launch):
            for port, schema in _PORTS.items():
                if isinstance(inputs.get(port), str) and inputs[port] not in self.left_out:
                    self._keys.setdefault(schema, inputs[port])

    def takes(self, topic: str, schema: str) -> bool:
        """Whether a message is to be shown."""
        if schema == STATUS:
            return True
        if schema not in SCHEMAS or topic in self.left_out:
            return False
        return self._keys.setdefault(schema, topic) == topic


def _left_out(launch: Mapping[str, Any]) -> frozenset[str]:
    lists = [params.get(LEAVE_OUT) for spec in specs_of(launch) if isinstance(params := spec.get("params"), Mapping)]
    return frozenset(key for keys in lists if isinstance(keys, list) for key in keys if isinstance(key, str))


def _inputs(launch: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [spec["inputs"] for spec in specs_of(launch)]
