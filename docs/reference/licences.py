"""The licences of everything that is locked, as their authors state them.

python -m docs.reference.licences
"""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from importlib.metadata import PackageMetadata, PackageNotFoundError, metadata
from pathlib import Path
from typing import NamedTuple

from docs.reference.tables import table

REQUIREMENTS = Path(__file__).parents[2] / "requirements"
LOCKS = {
    "robot": "what runs on a robot, and nothing more: `pip install berth`",
    "lab": "what the demo and the experiments need: `make setup`",
    "view": "the viewers: `make setup-view`",
    "dev": "tests, lint and documentation: `make setup-dev`",
    "build": "what builds the wheel",
}
"""Each holds the one before; a package is told of where it comes in."""
REFUSED = re.compile(r"(?<!L)GPL|Affero|(?<!Lesser )General Public|SSPL|Commons Clause", re.IGNORECASE)
"""Licences that whoever passes Berth on could not keep under its own."""
READ = {
    "apsw": "any OSI-approved licence",
    "cyclonedds": "EPL-2.0 AND BSD-3-Clause",
    "eclipse-zenoh": "Apache-2.0 OR EPL-2.0",
    "pybag-sdk": "MIT",
}
"""Read in the package where its metadata says nothing, or not how two licences are meant."""
INSIDE = {
    "numpy, scipy, opencv-python-headless": "libgfortran (GPL-3.0 with the GCC Runtime Library Exception, which binds "
    "nothing that is linked with it) and libquadmath (LGPL-2.1), as files of their own",
    "opencv-python-headless": "FFmpeg (LGPL-2.1), as files of their own, which anybody may replace; and OpenSSL, which "
    "`make audit` does not see. Berth opens images and video files with it, and no address on a network",
    "matplotlib, pillow": "FreeType, under its own licence (the other one to choose would be the GPL)",
    "setuptools": "autocommand (LGPL-3.0); builds the wheel, and is not in it",
}
"""What wheels bring inside themselves under a licence that asks for more than to be named."""
_HEAD = """Berth is under the Apache licence 2.0. What it is locked to, and under which licence that comes, as its
authors state it; written from `requirements/*.lock` and the installed packages. None is under the GPL or the AGPL; a
test holds it. `make sbom` writes the same with all hashes as CycloneDX, `make audit` asks for known holes."""


class Package(NamedTuple):
    """One locked package."""

    name: str
    version: str
    lock: str
    """Where it comes in."""
    licence: str
    """Empty if it is not installed here, or says nothing."""
    only: str
    """On which machines it is needed at all; empty = all."""


def packages() -> list[Package]:
    """All of them, by lock and name."""
    found: dict[str, Package] = {}
    for lock in LOCKS:
        text = (REQUIREMENTS / f"{lock}.lock").read_text(encoding="utf-8")
        for name, version, only in re.findall(r"^([\w.-]+)==([^\s;\\]+)(?: ; ([^\\]+?))? \\$", text, re.MULTILINE):
            found.setdefault(name, Package(name, version, lock, licence(name), only))
    return list(found.values())


def licence(name: str) -> str:
    """Of an installed package; empty if it is not here."""
    if name in READ:
        return READ[name]
    try:
        return _stated(metadata(name))
    except PackageNotFoundError:
        return ""


def _stated(said: PackageMetadata) -> str:
    """The expression, else the classifiers, else the first line of the text."""
    fields: Mapping[str, str] = {key: said[key] for key in ("License-Expression", "License") if key in said}
    if "License-Expression" in fields:
        return fields["License-Expression"]
    prefix = "License :: OSI Approved :: "
    classifiers = [each.removeprefix(prefix) for each in said.get_all("Classifier", []) if each.startswith(prefix)]
    return " OR ".join(classifiers) or fields.get("License", "").strip().partition("\n")[0]


def page() -> str:
    """The page."""
    found = packages()
    parts = ["# Licences", _HEAD]
    for lock, what in LOCKS.items():
        rows = [(row.name, row.version, row.licence or "not installed here") for row in found if row.lock == lock]
        parts += [f"## {lock}", f"`requirements/{lock}.lock`: {what}.", table(("package", "version", "licence"), rows)]
    parts += [
        "## Inside",
        "Wheels bring libraries of others inside themselves. These ask for more than to be named:",
        table(("wheel", "brings"), list(INSIDE.items())),
    ]
    return "\n\n".join(parts)


if __name__ == "__main__":
    sys.stdout.write(page() + "\n")
