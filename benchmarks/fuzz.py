"""Every reader under atheris, one after the other; needs `make fuzz`, which brings it.

python -m benchmarks.fuzz [NAME...] [--seconds S] [--findings DIRECTORY]
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from benchmarks.decoders import READERS

SECONDS = 60
_HANG_S = 10
_MEMORY_MB = 2048
_LARGEST_BYTES = 65536


class Found(NamedTuple):
    """What became of one reader."""

    executions: int
    bad: list[Path]
    """Inputs that crash it, hold it up or fill the memory."""
    last: str
    """What it said at the end."""


def fuzz(name: str, seconds: int, findings: Path) -> Found:
    """Run one reader, from its good bytes on."""
    findings.mkdir(parents=True, exist_ok=True)
    before = set(findings.iterdir())
    with tempfile.TemporaryDirectory() as corpus:
        for number, seed in enumerate(READERS[name].seeds()):
            (Path(corpus) / f"seed{number}").write_bytes(seed)
        limits = [f"-max_total_time={seconds}", f"-timeout={_HANG_S}", f"-rss_limit_mb={_MEMORY_MB}"]
        words = [f"-max_len={_LARGEST_BYTES}", f"-artifact_prefix={findings}/{name}-", "-print_final_stats=1", corpus]
        command = [sys.executable, "-m", "benchmarks.fuzz_one", name, *limits, *words]
        done = subprocess.run(command, capture_output=True, check=False)
    said = done.stderr.decode(errors="replace") + done.stdout.decode(errors="replace")
    count = re.search(r"number_of_executed_units: (\d+)", said) or re.search(r"Done (\d+) runs", said)
    bad = sorted(set(findings.iterdir()) - before)
    return Found(int(count[1]) if count else 0, bad, "" if done.returncode == 0 else said[-3000:])


def main() -> int:
    """Exit code 1 if anything was found."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fuzz", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(READERS))
    parser.add_argument("--seconds", type=int, default=SECONDS)
    parser.add_argument("--findings", type=Path, default=Path("build/fuzz"))
    options = parser.parse_args()
    failed = 0
    for name in options.names or READERS:
        found = fuzz(name, options.seconds, options.findings)
        print(
            f"{name:10} {found.executions:9} inputs, {len(found.bad)} bad {' '.join(map(str, found.bad))}", flush=True
        )
        failed += bool(found.last)
        sys.stderr.write(found.last)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
