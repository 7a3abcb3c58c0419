"""What a recording's resolved launch file says: of any release and from anybody, so nothing is taken for granted."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

_TABLES = ("params", "inputs", "outputs")


def specs_of(launch: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Its components; `params`, `inputs` and `outputs` of each are tables, empty where the file has none."""
    specs = launch.get("components")
    rows = [spec for spec in specs if isinstance(spec, dict)] if isinstance(specs, list) else []
    return [{**row, **{key: _table(row.get(key)) for key in _TABLES}} for row in rows]


def number_of(launch: Mapping[str, Any], name: str, default: float) -> float:
    """A parameter of the component that has it; the default if it is absent or no finite number."""
    value = next((spec["params"][name] for spec in specs_of(launch) if name in spec["params"]), default)
    return float(value) if isinstance(value, int | float) and abs(value) <= sys.float_info.max else default


def _table(value: Any) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
