"""A folder that looks like a fresh clone and shares its code with this one."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from tests.docs.page import ROOT, Block

_OWN = ("schemas", "recordings", "launch")
"""Folders that the pages write into."""
_SHARED = ("components", "docking", "runtime", "cli", "experiments", "report", "viewer")


class Sandbox:
    """Runs blocks of commands there, with this interpreter's programs."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name in _SHARED:
            (folder / name).symlink_to(ROOT / name)
        for name in _OWN:
            shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("sim-*", "__pycache__"))
        programs = Path(sys.executable).parent
        self._environment = {
            **os.environ,
            "PATH": f"{programs}:{os.environ['PATH']}",
            "PYTHONPATH": str(folder),
            "XDG_RUNTIME_DIR": str(folder),
        }

    def run(self, block: Block, deadline_s: float) -> str:
        """Run the block's commands, shortened, one after another until one fails; returns all that they said."""
        done = subprocess.run(
            ["bash", "-euc", block.shortened],
            cwd=self.folder,
            env=self._environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=deadline_s,
            check=False,
        )
        assert done.returncode == block.code, f"{block.shortened}\n{done.stdout}\n{done.stderr}"
        return done.stdout + done.stderr
