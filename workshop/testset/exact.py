"""Exact motions as the test set and the tests compare with them, and what roundings do to them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

from mpmath import mp, mpf

from symtop_ros.physics.reference import ClosedForm, Inputs, Series

DIGITS = 80


def returning_series(inputs: Inputs, digits: int) -> Series:
    """Return the Taylor series under gravity alone, for all times if the height has a period."""
    period = ClosedForm(inputs, digits + 20).period
    return Series(inputs, digits, period=period if mp.isfinite(period) else None)


def distance(a: Sequence[Any], b: Sequence[Any]) -> Any:
    """Distance of two quaternions, q and -q being the same attitude."""
    minus, plus = zip(*((x - y, x + y) for x, y in zip(a, b, strict=True)), strict=True)
    return min(mp.norm(minus), mp.norm(plus))


def perturb(inputs: Inputs, eps: float = 2.0**-52) -> Iterator[Inputs]:
    """Each input in turn, larger by half an ulp, which is eps/2: of doubles if it is not given."""
    Ix, Iz, Mgl, q, omega = inputs
    flat = [Ix, Iz, Mgl, *q, *omega]
    for i, value in enumerate(flat):
        if value:
            moved = [*flat[:i], value * (1 + Fraction(eps) / 2), *flat[i + 1 :]]
            Ix, Iz, Mgl, *state = moved
            yield Inputs(Ix, Iz, Mgl, tuple(state[:4]), tuple(state[4:]))


def error_and_limit(
    inputs: Inputs, t: Any, orientation: Sequence[Any], angular_velocity: Sequence[Any]
) -> tuple[float, float, float]:
    """Errors of a computed state, and what half an ulp of every input does to the exact one.

    Returns the error of the orientation up to sign, that of the angular velocity relative to its
    size, and the limit: the root of the sum of squares over the ten inputs.
    """
    exact, rates = ClosedForm(inputs, DIGITS).at(t)
    with mp.workdps(DIGITS):
        error = distance(exact, [mpf(float(c)) for c in orientation])
        parts = zip(rates, angular_velocity, strict=True)
        rate_error = mp.norm([a - mpf(float(b)) for a, b in parts]) / (mp.norm(rates) or 1)
        moved = (ClosedForm(each, DIGITS).at(t) for each in perturb(inputs))
        changes = [distance(exact, each.orientation) for each in moved]
        return float(error), float(rate_error), float(mp.norm(changes))
