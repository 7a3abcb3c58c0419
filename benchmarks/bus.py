"""Bus lockstep with trivial components: frames a second, and CPU time of each process per frame.

python -m benchmarks.bus [FRAMES]
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

from runtime.launch import load
from runtime.supervise import Supervisor
from runtime.system import System

FRAME_S = 0.125
_TIMEOUT_S = 120.0


def ring(directory: Path, frames: int) -> System:
    """`launch/sim.toml` with every fold replaced by one that computes nothing, the recorder kept."""
    text = Path("launch/sim.toml").read_text(encoding="utf-8")
    text = text.replace('"components.', '"benchmarks.ring.').replace("benchmarks.ring.recorder", "components.recorder")
    lines = [line for line in text.splitlines() if not line.startswith(("params", "end =", "realm ="))]
    lines.insert(0, f'realm = "benchmark/{directory.name}"')
    lines.insert(lines.index("[session]") + 1, 'end = "simulator/end"')
    file = directory / "ring.toml"
    file.write_text("\n".join(lines), encoding="utf-8")
    return load(file, [f"simulator.frames={frames}"], recording=directory / "ring.mcap")


def cpu_s(pid: int) -> float:
    """User and system time of a process so far (Linux)."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100.0


def measure(frames: int = 2000) -> dict[str, float]:
    """Run the ring; numbers by name."""
    with tempfile.TemporaryDirectory() as name, Supervisor(ring(Path(name), frames)) as supervisor:
        began_s = time.monotonic()
        while supervisor.missing and supervisor.poll(0.01):
            pass
        ready_s = time.monotonic()
        before = {name: cpu_s(pid) for name, pid in supervisor.pids.items()}
        while supervisor.poll(0.05) and time.monotonic() < ready_s + _TIMEOUT_S:
            pass
        wall_s = time.monotonic() - ready_s
        after = {name: cpu_s(pid) for name, pid in supervisor.pids.items()}
        supervisor.stop()
    assert supervisor.end_reason == "all frames shown", supervisor.end_reason
    numbers = {
        "start_s": ready_s - began_s,
        "frames_per_s": frames / wall_s,
        "times_real_time": frames * FRAME_S / wall_s,
        "messages_per_frame": supervisor.messages / frames,
        "lost": float(supervisor.lost),
    }
    return numbers | {f"cpu_us_{name}": 1e6 * (after[name] - before[name]) / frames for name in after}


def main() -> None:
    """Print the numbers."""
    for name, value in measure(*map(int, sys.argv[1:2])).items():
        print(f"{name:24} {value:10.3f}")


if __name__ == "__main__":
    main()
