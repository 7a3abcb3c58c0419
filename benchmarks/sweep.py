"""Planning: the compiled sweep against the same loop in C -O3, and how fast a robot learns with everything included.

python -m benchmarks sweep
"""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.figure import Figure
from components.learner.backup import sweep
from components.learner.methods.memory_sweep import MemorySweep
from components.learner.settings import Settings
from experiments.training import Protocol, Training

SWEEPS, ROUNDS = 100, 80
MINUTES = 60.0


def figures() -> list[Figure]:
    """Ratios of the best of interleaved rounds, and driven robot-seconds learned per core-second."""
    return [
        *(_against_c(model) for model in ("displacement", "exits")),
        *(_learning(m) for m in ("displacement", "exits")),
    ]


def _against_c(model: str) -> Figure:
    method = _trained(model, 20.0).method
    assert isinstance(method, MemorySweep)
    ours, theirs = _arguments(method), _arguments(method)
    compiled = _compile()
    best = {"ours": np.inf, "theirs": np.inf}
    for _ in range(ROUNDS):
        best["ours"] = min(best["ours"], _timed(lambda: sweep(SWEEPS, *ours)))
        best["theirs"] = min(best["theirs"], _timed(lambda: _call(compiled, theirs)))
    assert np.allclose(ours[1], theirs[1]), "the two kernels must compute the same values"
    return Figure(
        name=f"sweep, {model}: speed as a share of C -O3",
        value=best["theirs"] / best["ours"],
        at_least=0.6,
        note=f"{best['ours'] / SWEEPS * 1e6:.1f} us a sweep of {np.count_nonzero(method.known)} pairs; "
        f"C in the same run {best['theirs'] / SWEEPS * 1e6:.1f} us",
    )


def _learning(model: str) -> Figure:
    training = _trained(model, MINUTES)
    return Figure(
        name=f"learned, {model}: driven robot-seconds per core-second",
        value=training.driven_s / training.core_s,
        at_least=2000.0,
        note=f"{training.method.transitions} transitions, each simulated, filtered and swept for",
    )


def _trained(model: str, minutes: float) -> Training:
    """RL-LC for some robot minutes, after a trial that pays for compilation."""
    settings, protocol = Settings(model=model), Protocol(cycle=("lc", "random"))
    Training(settings=settings, protocol=protocol).trial()
    training = Training(settings=settings, protocol=protocol)
    for _ in training.checkpoints((minutes,)):
        pass
    return training


def _arguments(method: MemorySweep) -> tuple[Any, ...]:
    model = method.model
    names = ("successor", "weight", "degree", "reward")
    arrays = (getattr(model, name) for name in names)
    return (True, method.q.copy(), method.v.copy(), *arrays, method.rate, method.image)


def _compile() -> Callable[..., None]:
    source = Path(__file__).with_suffix(".c")
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / "sweep.so"
        subprocess.run(["cc", "-O3", "-shared", "-fPIC", "-o", library, source], check=True)
        function = ctypes.CDLL(str(library)).sweep
    function.restype = None
    return function


def _call(compiled: Callable[..., None], arguments: tuple[Any, ...]) -> None:
    mirror, q, v, successor, weight, degree, reward, rate, image = arguments
    sizes = [ctypes.c_int64(n) for n in (SWEEPS, mirror, v.size - 1, weight.shape[1], image.size)]
    q_, v_, successor_, weight_, degree_, reward_, rate_, image_ = (
        _pointer(array) for array in (q, v, successor, weight, degree, reward, rate, image)
    )
    compiled(*sizes[:2], q_, v_, sizes[2], successor_, weight_, sizes[3], degree_, reward_, rate_, image_, sizes[4])


def _pointer(array: NDArray[Any]) -> ctypes.c_void_p:
    assert array.flags.c_contiguous
    return ctypes.c_void_p(array.ctypes.data)


def _timed(call: Callable[[], None]) -> float:
    began = time.perf_counter()
    call()
    return time.perf_counter() - began
