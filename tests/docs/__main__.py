"""`make docs-check`: a fresh clone is made and set up, and every page is followed in it to the letter.

    python -m tests.docs [PAGE...]

Prints what each block took. Exit code 1 if a command failed or did not end.
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path

from tests.docs.page import ROOT, Block, blocks, pages, write_file

DEADLINE_S = 1800.0
STOP_S = 30.0
"""Longest time from Ctrl-C to the end."""
ACTIVATE = "[ ! -e .venv/bin/activate ] || source .venv/bin/activate\n"


def main() -> int:
    """Follow the named pages, or all."""
    with tempfile.TemporaryDirectory(prefix="berth-docs-") as name:
        clone = Path(name) / "berth"
        subprocess.run(["git", "clone", "--quiet", str(ROOT), str(clone)], check=True)
        chosen = [clone / name for name in sys.argv[1:]] or pages(clone)
        setup = [block for block in blocks(clone / "docs/tutorial.md") if block.mark == "setup"]
        kept = [*(run(block, clone) for block in setup), *(follow(page, clone) for page in chosen)]
    return 0 if all(kept) else 1


def follow(page: Path, clone: Path) -> bool:
    """Whether every command of a page succeeds."""
    say(f"{page.relative_to(clone)}")
    clean(clone)
    kept = []
    with ExitStack() as waiting:
        for block in blocks(page):
            if block.file:
                write_file(clone, block)
            elif block.mark == "in the background":
                waiting.callback(interrupt, start(block, clone))
            elif block.is_run and block.mark != "setup":
                kept.append(run(block, clone))
    return all(kept)


def clean(clone: Path) -> None:
    """What another page has made is gone, but for what setting up has."""
    for words in (["checkout", "--quiet", "."], ["clean", "-fdxq", "-e", ".venv", "-e", "__pycache__"]):
        subprocess.run(["git", *words], cwd=clone, check=True)


def run(block: Block, clone: Path) -> bool:
    """Run one block and tell about it."""
    stopped = re.fullmatch(r"stopped after (\d+) s", block.mark)
    began_s = time.monotonic()
    process = start(block, clone)
    try:
        code = process.wait(float(stopped[1]) if stopped else DEADLINE_S)
    except subprocess.TimeoutExpired:
        code = interrupt(process)
        code = code if stopped else -1
    state = "ok" if code == block.code else f"FAILED ({code})"
    say(f"  {state:11} {time.monotonic() - began_s:6.1f} s  {block.commands.splitlines()[0]}")
    if code != block.code:
        say((clone.parent / "said.log").read_text(errors="replace")[-4000:])
    return code == block.code


def start(block: Block, clone: Path) -> "subprocess.Popen[bytes]":
    """The block as a shell of its own, in the clone, without this process's environment of Python."""
    environment = {name: value for name, value in os.environ.items() if name not in ("VIRTUAL_ENV", "PYTHONPATH")}
    with (clone.parent / "said.log").open("wb") as log:
        return subprocess.Popen(
            ["bash", "-euc", ACTIVATE + block.commands],
            cwd=clone,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )


def interrupt(process: "subprocess.Popen[bytes]") -> int:
    """Ctrl-C; returns the exit code, -1 if there is none in time."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGINT)
    try:
        code = process.wait(STOP_S)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        return -1
    return 0 if code in (0, -signal.SIGINT, 128 + signal.SIGINT) else code


def say(text: str) -> None:
    """To whoever waits."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
