"""One picture of a learned session: what the robot sees, where it drove, what it learned, how well."""

from __future__ import annotations

import math
from pathlib import Path

import cv2
import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from report.comparison import Comparison
from report.pictures import COLOURS, STYLE, draw_paths, draw_policy
from report.session import Session
from runtime.recorded_launch import number_of


def write(session: Session, comparison: Comparison, file: Path) -> None:
    """Draw the picture.

    Args:
        session: with an evaluation and at least one policy.
        comparison: its policies on the bare plant.
        file: PNG to write.
    """
    with mpl.rc_context(STYLE):
        figure, axes = plt.subplots(1, 4, figsize=(13.5, 3.3), layout="constrained", width_ratios=(1.25, 1.1, 1, 1.3))
    _draw_camera(axes[0], session)
    evaluation = [trial for trial in session.trials if trial.phase == "EVALUATE"]
    docked = sum(trial.docked for trial in evaluation)
    draw_paths(axes[1], evaluation, number_of(session.launch, "edge_offset_m", 0.05))
    axes[1].set_title(f"evaluation: {docked} of {len(evaluation)} docked")
    draw_policy(axes[2], session.policies[-1][1])
    axes[2].set_title("learned: turn left / right")
    _draw_curve(axes[3], comparison)
    figure.savefig(file, dpi=100)
    plt.close(figure)


def _draw_camera(axes: Axes, session: Session) -> None:
    data = session.pictures.get("APPROACH", b"") or next(iter(session.pictures.values()), b"")
    image = cv2.imdecode(np.frombuffer(data or b"\0", np.uint8), cv2.IMREAD_COLOR)
    if image is not None:
        axes.imshow(cv2.cvtColor(image, cv2.COLOR_BGR2RGB))
    axes.set_title("what the robot sees")
    axes.axis("off")


def _draw_curve(axes: Axes, comparison: Comparison) -> None:
    axes.plot(*zip(*comparison.curve, strict=True), color=COLOURS["docked"], linewidth=1.8)
    axes.axhline(comparison.ceiling_percent, color="#57606a", linestyle="--", linewidth=1)
    last_min = math.ceil(comparison.curve[-1][0])
    axes.set(
        xlabel="robot minutes", ylabel="%", ylim=(0, 103), xlim=(0, last_min), title="goal cell reached, bare plant"
    )
