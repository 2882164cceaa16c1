"""Starts from observed quantities: a tilt, the time of one turn, a dip, a nutation period.

The formulas are in the kernel (`kernel/rule/starts.hpp`; docs/derivation.md, section 12).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from symtop_ros.base.refusals import (
    RefusedError,
    Words,
    refuse,
    require,
    show_limit,
    validate_names,
)
from symtop_ros.base.units import QUANTITIES
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.kernel.records import DEMANDS, QUESTIONS, SolutionsRecord
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import (
    LARGEST_ANGULAR_VELOCITY,
    LARGEST_MOMENT,
    validate_number,
    validate_one,
)

# The names of each question, in the order of the kernel, by what a caller gives in any order.
ROWS = {frozenset(each.split()): tuple(each.split()) for each in QUESTIONS}


@dataclass(frozen=True, slots=True)
class Solution:
    """A start with phi = psi = 0: tilt in rad, and rates in rad/s.

    Attributes
    ----------
    theta : float
        Tilt in rad.
    theta_dot, phi_dot, psi_dot : float
        Rates in rad/s; phi' is 0 on the vertical, where psi' is the whole spin.
    least, most : Solution or None
        The smallest and the largest value of each number within the given half-widths. None without
        half-widths. Also None if within them the number of starts changes, a rate of regular
        precession changes its sign, or p_phi is p_psi or -p_psi (phi' then has no bound).
    """

    theta: float
    theta_dot: float
    phi_dot: float
    psi_dot: float
    least: "Solution | None" = None
    most: "Solution | None" = None

    @property
    def state(self) -> State[float]:
        """The state of the start."""
        return State.from_euler(
            theta=self.theta,
            theta_dot=self.theta_dot,
            phi_dot=self.phi_dot,
            psi_dot=self.psi_dot,
        )


def solve_start(
    top: Top[float], *, half_widths: Mapping[str, float] | None = None, **known: float
) -> tuple[Solution, ...]:
    """Return all starts of a top whose motion has the given properties.

    ==============================  ==================================================
    known                           motion
    ==============================  ==================================================
    theta, precession_period        regular precession
    theta, psi_dot                  regular precession
    psi_dot, precession_period      regular precession
    theta, dip                      let go at rest; dip is the change of theta until
                                    the weight is lowest
    theta, nutation_period          let go at rest
    energy, p_phi, p_psi            any, at its turning angles
    alpha, a, b                     the same by Goldstein's constants (section 5.7):
                                    2 E/Ix - Iz omega_z^2/Ix, p_psi/Ix and p_phi/Ix;
                                    his beta is 2 Mgl/Ix
    ==============================  ==================================================

    Parameters
    ----------
    top : Top
        One top.
    half_widths : mapping of str to float, optional
        Half-widths of the intervals in which the known numbers lie, >= 0, in the units of the
        numbers. The solutions then have `least` and `most`, the extremes over all numbers in these
        intervals. Extremes between the ends of the intervals are found, too.
    **known : float
        The two or three numbers of one row, in rad, rad/s, s, J, N m s, 1/s^2 and 1/s. The time of
        one turn of phi, `precession_period`, has no sign: the top may go round in either direction.

    Returns
    -------
    tuple of Solution
        One to four solutions. The first ones have phi' > 0; for a top let go at rest, psi' > 0; for
        given constants, the smaller theta. If the given numbers are taken as exact, the error of
        each number is some EPS (2^-52). A nutation period that is up to 16 EPS longer than the
        longest possible one counts as the longest one. A period that is up to 16 EPS shorter than
        that of a pendulum, the limit without spin, counts as the pendulum's. Constants whose energy
        differs from the least possible energy by at most 64 EPS of its terms are those of a regular
        precession.

    Raises
    ------
    ValueError
        If the names are not those of one row, if a number is not finite or out of its range, or if
        there is no such motion: the message says what the number must be.

    Examples
    --------
    A class has seen one turn in 2.2 s, and asks for the spin.

    >>> import math
    >>> from symtop_ros.physics import Top, solve_start
    >>> top = Top(Ix=0.000264, Iz=0.00012, Mgl=0.165 * 9.8 * 0.04)
    >>> first, _ = solve_start(top, theta=math.pi / 2, precession_period=2.2)
    >>> round(first.psi_dot * 60 / (2 * math.pi))
    1802

    The turn was timed to 0.05 s:

    >>> seen = {"theta": math.pi / 2, "precession_period": 2.2}
    >>> first, _ = solve_start(top, half_widths={"precession_period": 0.05}, **seen)
    >>> assert first.least and first.most
    >>> f"{first.least.psi_dot:.0f} to {first.most.psi_dot:.0f} rad/s"
    '184 to 193 rad/s'
    """
    validate_one(top)
    names = ROWS.get(frozenset(known))
    if names is None:
        rows = " / ".join(", ".join(each) for each in ROWS.values())
        raise refuse("known", f"one of {rows}", Words(", ".join(known) or "nothing"))
    numbers = [validate_number(name, known[name], QUANTITIES[name]) for name in names]
    found = bindings.solve_start(top.moments, [*ROWS.values()].index(names), numbers)
    if found.number == 0:
        raise _refuse(top, names, numbers, found)
    starts = tuple(_read(each) for each in found.each[: int(found.number)])
    if half_widths is None:
        return starts
    validate_names(half_widths, names, "half_widths")
    widths = [_validate_width(name, half_widths.get(name, 0.0)) for name in names]
    spreads = bindings.find_spreads(top.moments, [*ROWS.values()].index(names), numbers, widths)
    if math.isnan(spreads.least[0].theta):
        return starts
    return tuple(
        replace(start, least=_read(least), most=_read(most))
        for start, least, most in zip(starts, spreads.least, spreads.most, strict=False)
    )


def _validate_width(name: str, value: float) -> float:
    width = validate_number(f"half_widths[{name}]", value, QUANTITIES[name])
    require(0 <= width < math.inf, f"half_widths[{name}]", f">= 0 {QUANTITIES[name]}", width)
    return width


def _read(each: Any) -> Solution:
    return Solution(each.theta, each.theta_dot, each.phi_dot, each.psi_dot)


def _show_range(found: SolutionsRecord) -> str:
    above = "" if math.isnan(found.least) else f"> {show_limit(found.least)} and "
    return f"{above}< {show_limit(found.most)}"


def _refuse(
    top: Top, names: tuple[str, ...], numbers: list[float], found: SolutionsRecord
) -> RefusedError:
    """Return the refusal in words: what the number, or the top, would have to be."""
    demand = DEMANDS[found.demand]
    if demand == "unequal":
        return refuse(
            "Ix", "other than Iz: else the time of one turn is the same at every tilt", top.Ix
        )
    if demand == "weight":
        return refuse("Mgl", "other than 0 J: without weight the axis stays at rest", top.Mgl)
    name, value = names[int(found.which)], numbers[int(found.which)]
    unit = QUANTITIES[name]
    others = " and ".join(
        f"{each} = {number:.6g} {QUANTITIES[each]}"
        for each, number in zip(names, numbers, strict=True)
        if each != name
    )
    conditions = {
        "finite": f"at most {LARGEST_MOMENT:g} {unit} in size",
        "between": f"> {show_limit(found.least)} and < {show_limit(found.most)} {unit}",
        "positive": f"> 0 {unit}",
        "least": f"at least {show_limit(found.least)} {unit} with {others}",
        "size": f"at least {show_limit(found.least)} {unit} in size with {others}",
        "range": f"{_show_range(found)} {unit} in size with {others}",
        "regular": f"such that the top can precess regularly with {others}",
        "spin": f"other than 0 {unit}: without weight every precession rate is then regular",
        "rates": f"such that no rate exceeds {LARGEST_ANGULAR_VELOCITY:g} rad/s with {others}",
    }
    condition = conditions[str(demand)]
    if demand == "positive" and math.isfinite(found.most):
        condition = f"> 0 and at most {show_limit(found.most)} {unit} with {others}"
    return refuse(name, condition, value)
