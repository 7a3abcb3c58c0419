"""What a machine must share with another for results to be equal to the bit."""

from __future__ import annotations

import platform
from importlib import metadata
from pathlib import Path

_LIBRARIES = (
    "berth",
    "eclipse-zenoh",
    "filterpy",
    "llvmlite",
    "mcap",
    "numba",
    "numpy",
    "opencv-python-headless",
    "protobuf",
    "scipy",
)


def fingerprint() -> dict[str, str]:
    """Python, processor features and library versions, by name. Absent libraries are left out."""
    found = {"python": platform.python_version(), "machine": platform.machine(), "processor": _processor()}
    for library in _LIBRARIES:
        try:
            found[library] = metadata.version(library)
        except metadata.PackageNotFoundError:
            continue
    return found


def _processor() -> str:
    """The processor's feature flags (Linux), or what the platform calls it."""
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith(("flags", "Features")):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor()
