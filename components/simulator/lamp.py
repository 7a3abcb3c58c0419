"""The room's lamp: what its colour and strength do to a camera of fixed white balance and exposure."""

from __future__ import annotations

BALANCE_K = 4000.0
"""The camera's white balance is fixed at this lamp: under it the scene looks as painted."""
GAMMA = 2.2
"""Of sRGB, about: pixel values are this root of the light."""


def gains(light: float, lamp_k: float) -> tuple[float, float, float]:
    """Factors on pixel values, blue, green, red, of `light` times the light from a lamp of this colour temperature."""
    lamp, balanced = _white(lamp_k), _white(BALANCE_K)
    blue, green, red = ((light * here / there) ** (1.0 / GAMMA) for here, there in zip(lamp, balanced, strict=True))
    return blue, green, red


def _white(lamp_k: float) -> tuple[float, float, float]:
    """Linear sRGB (blue, green, red) of a black body, brightness 1. Kim et al., US patent 7024034 (2006)."""
    t = 1e3 / lamp_k
    if lamp_k < 4000.0:
        x = -0.2661239 * t**3 - 0.2343589 * t**2 + 0.8776956 * t + 0.179910
    else:
        x = -3.0258469 * t**3 + 2.1070379 * t**2 + 0.2226347 * t + 0.240390
    if lamp_k < 2222.0:
        y = -1.1063814 * x**3 - 1.34811020 * x**2 + 2.18555832 * x - 0.20219683
    elif lamp_k < 4000.0:
        y = -0.9549476 * x**3 - 1.37418593 * x**2 + 2.09137015 * x - 0.16748867
    else:
        y = 3.0817580 * x**3 - 5.87338670 * x**2 + 3.75112997 * x - 0.37001483
    over, beyond = x / y, (1.0 - x - y) / y
    red = 3.2406 * over - 1.5372 - 0.4986 * beyond
    green = -0.9689 * over + 1.8758 + 0.0415 * beyond
    blue = 0.0557 * over - 0.2040 + 1.0570 * beyond
    return blue, green, red
