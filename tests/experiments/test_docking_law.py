"""The docking law against the published values of its unit test."""

from __future__ import annotations

import numpy as np
import pytest

from experiments.docking_law import DockingLaw, polar

NAV2 = DockingLaw(
    k_phi=1.0,
    k_delta=10.0,
    speed_beta=0.2,
    speed_lambda=2.0,
    slowdown_radius_m=0.1,
    speed_max_mps=1.0,
    turn_rate_max_radps=1.0,
)
ORIGIN = tuple(np.zeros(1) for _ in range(3))


@pytest.mark.parametrize(
    ("target", "curvature", "v", "omega"),
    [
        ((0.0, 5.0, 0.0), 5.407042, 0.1460446, 0.7896695),
        ((4.5, -2.17, -0.785), -0.416228, 0.966512, -0.4022844),
    ],
)
def test_published_values_of_the_law(
    target: tuple[float, float, float], curvature: float, v: float, omega: float
) -> None:
    r, phi, delta = polar(target, ORIGIN)
    assert NAV2.curvature(r, phi, delta)[0] == pytest.approx(curvature, abs=1e-5)
    speed, turn = NAV2.toward(target, ORIGIN)
    assert (speed[0], turn[0]) == pytest.approx((v, omega), abs=1e-5)


def test_mirrored_targets_turn_the_other_way() -> None:
    rng = np.random.default_rng(1)
    pose = tuple(rng.uniform(-1, 1, (3, 20)))
    mirrored = (pose[0], -pose[1], -pose[2])
    v, omega = DockingLaw().toward((2.0, 0.0, 0.0), pose)
    v_mirrored, omega_mirrored = DockingLaw().toward((2.0, 0.0, 0.0), mirrored)
    assert v == pytest.approx(v_mirrored)
    assert omega == pytest.approx(-omega_mirrored)


@pytest.mark.parametrize("constant", [True, False])
def test_limits_hold_and_without_constant_speed_the_path_keeps_its_curvature(constant: bool) -> None:
    law = DockingLaw(constant_speed=constant)
    r, phi, delta = np.random.default_rng(2).uniform((0.01, -3, -3), (3, 3, 3), (500, 3)).T
    curvature = law.curvature(r, phi, delta)
    v, omega = law.command(r, curvature)
    assert np.abs(omega).max() <= law.turn_rate_max_radps
    assert v.min() >= 0.0
    assert v.max() <= law.speed_max_mps
    if constant:
        assert (v == law.speed_max_mps).all()
    else:
        assert omega == pytest.approx(v * curvature)


def test_at_the_target_itself_nothing_is_infinite() -> None:
    v, omega = DockingLaw().toward((0.0, 0.0, 0.0), ORIGIN)
    assert np.isfinite([v, omega]).all()
