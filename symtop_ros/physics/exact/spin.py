"""Reversal of the spin: whether psi' has both signs in a nutation, decided without sampling.

With Goldstein's a and b (see `nutation`) and the constant omega_z

    sin^2(theta) psi' = h(u) = omega_z (1 - u^2) - u (b - a u),        u = cos(theta),

which is quadratic in u. Its largest and smallest values between the turning points lie at the
turning points, or at its vertex if that is between them.
"""

from collections.abc import Sequence
from decimal import Decimal
from typing import Any

from symtop_ros.physics.exact.elementary import cosine_and_sine, to_floats
from symtop_ros.physics.exact.kind import ROUNDING, largest_precession
from symtop_ros.physics.exact.nutation import Nutation, Roots
from symtop_ros.physics.exact.quotients import Zeros
from symtop_ros.physics.values import START_ROUNDING


def spin_reverses(nutation: Nutation, roots: Roots, zeros: Zeros, omega_z: float) -> bool:
    """Return True if psi' takes both signs in a motion whose axis moves under gravity.

    A psi' that differs from zero by rounding of the start alone has no sign: a top that is started
    with psi' = 0 at a turning point does not reverse there.
    """
    spin, below, above = Decimal(omega_z), zeros.A, zeros.B
    ends = [
        spin * below.from_u1 * above.from_u1
        - (nutation.u + roots.s1) * nutation.b_minus_au_at(roots.s1),
        spin * below.from_u2 * above.from_u2
        - (nutation.u + roots.s2) * nutation.b_minus_au_at(roots.s2),
    ]
    b = nutation.b_minus_au + nutation.a * nutation.u
    vertex = _find_vertex(spin, nutation.a, b, nutation.u + roots.s1, nutation.u + roots.s2)
    size = abs(spin) * zeros.largest_sine_squared + largest_precession(nutation, zeros)
    return _has_both_signs([*ends, *vertex], ROUNDING * size)


def spin_reverses_free(tilt_of_momentum: float, cone: float, rate: float, omega_z: float) -> bool:
    """Return True if psi' takes both signs in a motion without torque."""
    near = to_floats(cosine_and_sine(tilt_of_momentum - cone))
    far = to_floats(cosine_and_sine(tilt_of_momentum + cone))
    half = to_floats(cosine_and_sine(cone))
    # b - a u at the ends, with b = rate cos(tilt) and a = rate cos(cone), by the addition theorem:
    # the difference would cancel for a narrow cone.
    across = rate * half[1]
    ends = [
        omega_z * (far[1] * far[1]) - far[0] * across * far[1],
        omega_z * (near[1] * near[1]) + near[0] * across * near[1],
    ]
    a, b = rate * half[0], rate * float(cosine_and_sine(tilt_of_momentum)[0])
    vertex = _find_vertex(omega_z, a, b, far[0], near[0])
    return _has_both_signs([*ends, *vertex], START_ROUNDING * (abs(omega_z) + rate))


def _find_vertex(spin: Any, a: Any, b: Any, low: Any, high: Any) -> list[Any]:
    """Return the extreme value of spin - b u + (a - spin) u^2 if it lies between two heights."""
    bend = 2 * (a - spin)
    if bend and low < b / bend < high:
        return [spin - b * b / (2 * bend)]
    return []


def _has_both_signs(values: Sequence[Any], rounding: Any) -> bool:
    return bool(min(values) < -rounding and max(values) > rounding)
