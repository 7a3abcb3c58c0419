"""How the help of every command is laid out: one line for the list, what it does, then an example to type.

A command's docstring says what it does and ends with `Example: berth ...`.
"""

from __future__ import annotations

import re
from typing import Any

WIDTH = 100
"""Columns at most."""
_CLAUSE = re.compile(r"(.*?)(?:[.;?](?:\s|$)|$)", re.DOTALL)


def laid_out(command: Any) -> Any:
    """The command, and those below it, with line, text and example each in its place."""
    words, _, example = (command.help or "").partition("Example:")
    if example:
        command.help = words.strip()
        command.epilog = "\b\nExample:\n" + "\n".join(f"  {line}" for line in lines_of(example))
    command.short_help = line_of(words)
    for below in getattr(command, "commands", {}).values():
        laid_out(below)
    return command


def line_of(words: str) -> str:
    """First clause, on one line."""
    found = _CLAUSE.match(" ".join(words.split()))
    return found[1] if found else ""


def lines_of(example: str) -> list[str]:
    """The commands of an example, one a line."""
    return [line.strip().removesuffix(".") for line in example.strip().splitlines() if line.strip()]
