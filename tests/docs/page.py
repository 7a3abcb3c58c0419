"""A page of the documentation as its blocks: commands to type, and files to write.

A comment right above a block of commands says how the checks treat it:
`<!-- shortened: A => B; C => D -->` the suite puts B for A; `make docs-check` runs it as it stands;
`<!-- setup -->` needs a fresh clone, so only `make docs-check` runs it;
`<!-- stopped after 20 s -->` it goes on until Ctrl-C, which comes then;
`<!-- in the background -->` it goes on until the page is done;
`<!-- exit code 1: why -->` it ends with that;
`<!-- not run: why -->` it is only parsed.
"""

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
_BLOCK = re.compile(
    r"(?:^<!-- (?P<mark>[^\n]*?) -->\n)?^```(?P<kind>\w+)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL
)
_FILE = re.compile(r"(?:#|//) ([\w/]+\.(?:py|proto|toml))\n")
MARKS = ("shortened: ", "setup", "stopped after ", "in the background", "exit code ", "not run: ")
STANDS_FOR = {
    "recordings/SESSION.mcap": "recordings/docking.mcap",
    "tcp/ROBOT:": "tcp/127.0.0.1:",
    "tls/ROBOT:": "tls/127.0.0.1:",
}
"""Words in capitals that the reader replaces -> what the checks put there."""


@dataclass(frozen=True)
class Block:
    """One fenced block."""

    mark: str
    kind: str
    text: str

    @property
    def file(self) -> str:
        """Path that its first line names, of a block that is a file's content; else empty."""
        found = _FILE.match(self.text) if self.kind in {"python", "proto", "toml"} else None
        return found[1] if found else ""

    @property
    def is_run(self) -> bool:
        return self.kind == "sh" and not self.mark.startswith("not run")

    @property
    def code(self) -> int:
        """Exit code to be had."""
        found = re.match(r"exit code (\d)", self.mark)
        return int(found[1]) if found else 0

    @property
    def commands(self) -> str:
        """The commands, whole."""
        text = self.text
        for word, stands in STANDS_FOR.items():
            text = text.replace(word, stands)
        return text

    @property
    def shortened(self) -> str:
        """The commands with the stated substitutions; each must find what it replaces."""
        text = self.commands
        for change in self.mark.removeprefix("shortened: ").split("; ") if self.mark.startswith("shortened: ") else ():
            old, new = change.split(" => ")
            assert old in text, f"{self.mark}: {old} must stand below"
            text = text.replace(old, new)
        return text

    @property
    def calls(self) -> list[list[str]]:
        """Words of each call of `berth`."""
        lines = self.commands.replace("\\\n", " ").splitlines()
        return [shlex.split(line, comments=True)[1:] for line in lines if line.startswith("berth ")]


def blocks(page: Path) -> list[Block]:
    """The blocks of a page, in order."""
    text = page.read_text(encoding="utf-8")
    return [Block(found["mark"] or "", found["kind"], found["text"]) for found in _BLOCK.finditer(text)]


def pages(root: Path = ROOT) -> list[Path]:
    """Every page that a person reads commands in."""
    return [root / "README.md", *sorted((root / "docs").rglob("*.md"))]


def write_file(folder: Path, block: Block) -> None:
    """Write a block that is a file."""
    target = folder / block.file
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(block.text, encoding="utf-8")
