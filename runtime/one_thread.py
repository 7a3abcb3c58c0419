"""Results must not depend on the number of cores: what a shell says to the libraries before it runs a component."""

from __future__ import annotations

import gc
import os
import sys

from runtime.child import ENVIRONMENT

_YOUNG = 50_000
"""New objects between two looks at the young ones; the default 700 comes several times a frame."""


def limit_threads() -> None:
    """One thread for BLAS, numba and OpenCV. BLAS and numba listen only before they are imported."""
    os.environ.update(ENVIRONMENT)
    if "cv2" in sys.modules:
        sys.modules["cv2"].setNumThreads(1)


def keep_start_up_out_of_collections() -> None:
    """What the imports made lives as long as the process: looking through it again and again cost 8 % (measured)."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(_YOUNG)
