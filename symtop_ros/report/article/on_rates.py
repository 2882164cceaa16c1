"""Claims on precession rates: the two roots, the six rates, the parabola, Perry's rule."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics import Motion, Top, hurry, motion, perry, regular_precession_rates
from symtop_ros.report.article.claim import Claim
from symtop_ros.report.article.departure import Departure
from symtop_ros.report.article.difference import slope
from symtop_ros.report.article.motions import PRINTED, PSI_DOT, THETA, Hurried, Rate, start

Real = NDArray[np.float64]
STILL = 1e-3  # rad; a root of three digits moves the top by less
FITTED = 1e-9  # of the largest theta''; differences and the fit are good to 1e-11
HURRIED = 1.4
PARABOLA = np.linspace(-10.0, 90.0, 41)  # rad/s


def roots_are_as_printed(top: Top) -> Claim:
    """The rates of regular precession, to the digits that the article prints."""
    roots = _roots(top)
    digits = [len(printed.partition(".")[2]) for printed in PRINTED]
    rounded = [f"{root:.{n}f}" for root, n in zip(roots, digits, strict=False)]
    return Claim(
        f"At theta = {THETA} rad and psi' = {PSI_DOT:g} rad/s regular precession has phi' = "
        f"{PRINTED[0]} and {PRINTED[1]} rad/s.",
        f"roots {' and '.join(f'{root:.6f}' for root in roots) or 'none'} rad/s",
        rounded == list(PRINTED),
    )


def printed_roots_keep_the_tilt(top: Top) -> Claim:
    """The article's digits are enough to see no nutation."""
    widths = []
    for printed in PRINTED:
        low, high = motion(top, start(float(printed))).turning_angles
        widths.append(high - low)
    return Claim(
        "Started with just these digits, the top precesses regularly as far as can be seen.",
        f"theta changes by {widths[0]:.1e} and {widths[1]:.1e} rad in all (allowed: {STILL:g})",
        max(widths) < STILL,
    )


def rate_decides(top: Top, rate: Rate) -> Claim:
    """One of the six rates: what the article says of it, by the equation and by the motion."""
    departure = Departure.of(top, start(rate.phi_dot))
    return Claim(
        f"With phi'(0) = {rate.phi_dot:.4g} rad/s, {rate.place}, the top {rate.follows}.",
        str(departure),
        departure.directions == (rate.follows,) * 3,
    )


def acceleration_is_a_parabola(top: Top) -> Claim:
    """The theta'' of motions with theta'(0) = 0, against phi'(0): one through both roots."""
    measured = measured_accelerations(top, PARABOLA)
    parabola = np.polynomial.Polynomial.fit(PARABOLA, measured, 2)
    off = np.abs(parabola(PARABOLA) - measured).max() / np.abs(measured).max()
    zeros, roots = np.sort(parabola.roots().real), _roots(top)
    missed = np.abs(zeros - roots).max() if len(roots) == len(zeros) else np.inf
    return Claim(
        "theta'' of the motion, at theta' = 0 against phi', is a parabola through zero at both "
        "roots.",
        f"{len(PARABOLA)} motions lie within {off:.0e} of their largest theta'' from a parabola; "
        f"its zeros {' and '.join(f'{zero:.6f}' for zero in zeros)} rad/s are the roots within "
        f"{missed:.0e}",
        bool(off < FITTED and missed < FITTED * PARABOLA[-1]),
    )


def measured_accelerations(top: Top, phi_dots: Real) -> Real:
    """The theta'' (n,) in rad/s^2 with which motions begin, by differentiating theta'."""
    return np.array([_acceleration(motion(top, start(rate))) for rate in phi_dots.tolist()])


def _acceleration(path: Motion) -> float:
    return float(slope(lambda t: np.asarray(path.at(t).euler_rates.theta), np.zeros(1)).values[0])


def hurrying(top: Top, case: Hurried) -> Claim:
    """What becomes of a top when regular precession is hurried, and what `perry` says of it."""
    holds = case.follows == "rises"
    sentence = (
        f'Perry\'s rule "hurry on the precession, and the body rises" '
        f"{'holds' if holds else 'fails'} {case.place}: the hurried top {case.follows}."
    )
    roots = _roots(top, case.psi_dot)
    if not roots:
        return Claim(sentence, "no regular precession", holds=False)
    before = start(roots[case.root], case.psi_dot)
    departure = Departure.of(top, hurry(top, before, HURRIED))
    return Claim(
        sentence,
        f"phi' {roots[case.root]:.4g} -> {HURRIED * roots[case.root]:.4g} rad/s: {departure}",
        departure.directions == (case.follows,) * 3 and perry(top, before).rule_holds is holds,
    )


def _roots(top: Top, psi_dot: float = PSI_DOT) -> tuple[float, ...]:
    return regular_precession_rates(top, THETA, psi_dot)
