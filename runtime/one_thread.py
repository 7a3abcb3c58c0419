"""Results must not depend on the number of cores: what a shell says to the libraries before it runs a component."""

from __future__ import annotations

import os
import sys

from runtime.child import ENVIRONMENT


def limit_threads() -> None:
    """One thread for BLAS, numba and OpenCV. BLAS and numba listen only before they are imported."""
    os.environ.update(ENVIRONMENT)
    if "cv2" in sys.modules:
        sys.modules["cv2"].setNumThreads(1)
