"""Regular precession: the rates at which the tilt stays as it is."""

from __future__ import annotations

import math

from symtop_ros.physics.top import Top


def regular_precession_rates(top: Top, theta: float, psi_dot: float) -> tuple[float, ...]:
    """Rates phi' (rad/s) of regular precession at tilt theta (rad) and spin rate psi' (rad/s).

    Returns
    -------
    tuple of float
        (slow, fast) with |slow| <= |fast|, one rate where the equation is linear, or none where
        the spin is too small. Roots of (Ix - Iz) cos(theta) p^2 - Iz psi' p + Mgl = 0, formed
        without cancellation.
    """
    for name, value in (("theta", theta), ("psi_dot", psi_dot)):
        if not math.isfinite(value):
            msg = f"{name}: got {value}, allowed is a finite number"
            raise ValueError(msg)
    return quadratic_roots((top.Ix - top.Iz) * math.cos(theta), top.Iz * psi_dot, top.Mgl)


def quadratic_roots(a: float, b: float, c: float) -> tuple[float, ...]:
    """Real roots of a p^2 - b p + c = 0, the smaller one in size first."""
    if a == 0:
        return _finite(c / b) if b else ()
    half = b / 2
    discriminant = half * half - a * c
    if discriminant < 0:
        return ()
    q = half + math.copysign(math.sqrt(discriminant), half)
    if q == 0:
        return (0.0, 0.0)
    return tuple(sorted(_finite(c / q, q / a), key=abs))


def _finite(*roots: float) -> tuple[float, ...]:
    """Roots that doubles can hold."""
    return tuple(root for root in roots if math.isfinite(root))
