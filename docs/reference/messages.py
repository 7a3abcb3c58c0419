"""The page of the messages: every message of schemas/, with its comments."""

from __future__ import annotations

import re
from collections.abc import Iterator

from docs.reference.components import ROOT

_MESSAGE = re.compile(r"^message (\w+) \{", re.MULTILINE)


HEAD = """# Messages

Written from `schemas/*.proto`. Names tell units (`_m`, `_rad`, `_radps`, `_px`, `_ns`); angles are positive to the
left, tilt downwards; pixels count to the right and down from the image centre. A field that is not set is 0, false or
empty. A recording holds these schemas, so any MCAP reader decodes it.
"""


def page() -> str:
    """The page."""
    texts = [file.read_text(encoding="utf-8") for file in sorted((ROOT / "schemas").glob("*.proto"))]
    return "\n".join([HEAD, *(part for text in texts for part in _file(text))])


def _file(text: str) -> Iterator[str]:
    """Each message at the top level of one file, with the comment above it."""
    for found in _MESSAGE.finditer(text):
        end = text.index("\n}", found.start()) + 2
        yield f"## {found[1]}\n"
        if words := _comment_above(text, found.start()):
            yield words + "\n"
        yield f"```proto\n{text[found.start() : end]}\n```\n"


def _comment_above(text: str, start: int) -> str:
    lines: list[str] = []
    for line in reversed(text[:start].splitlines()):
        if not line.startswith("//"):
            break
        lines.insert(0, line.removeprefix("//").strip())
    return " ".join(lines)
