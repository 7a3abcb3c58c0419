"""Puts into the documentation, whenever it is built, what is written elsewhere: the reference, from the code."""

from __future__ import annotations

from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

from docs.reference import commands, components, licences, messages  # the root is where `python -m mkdocs` is called

ROOT = Path(__file__).parents[1]


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that no file in docs/ holds."""
    pages = {
        "reference/commands.md": commands.page(),
        "reference/components.md": components.page(),
        "reference/messages.md": messages.page(),
        "reference/licences.md": licences.page(),
        "explanation/decisions.md": (ROOT / "DECISIONS.md").read_text(encoding="utf-8"),
        "explanation/changelog.md": (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"),
    }
    for uri, content in pages.items():
        files.append(File.generated(config, uri, content=content))
    return files
