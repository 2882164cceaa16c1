"""Perry's rule: "hurry on the precession, and the body rises in opposition to gravity".

One definition is used for a state, a kick and a map. The kicked top is compared with the same top
not kicked: phi' is multiplied by a factor while the spin rate or the spin momentum is held.

- factor > 1 (hurried): the rule holds if theta'' is lower with the kick.
- 0 <= factor < 1 (delayed): the rule holds if theta'' is higher with the kick.
- The rule says nothing (None) if phi' = 0, if the factor is 1 or negative, about an angular
  impulse, if theta'' is the same with the kick as without it, and on the vertical, where phi' is
  undefined.

These words mean the axis. The height of the centre of mass is cos(theta) times an arm of the sign
of Mgl, so for Mgl < 0 it moves the other way, and the answers name both.

At a root of regular precession theta'' is 0 without the kick, so the hurried axis rises if and only
if the rule holds there. This is the article's case. With two distinct roots s (slow) and f (fast)
of a p^2 - b p + Mgl = 0, Ix theta''/sin(theta) after a kick by k is

    (k - 1) Mgl (k s/f - 1)  from the slow root,    (k - 1) a f^2 (k - s/f)  from the fast one.

Since |s| < |f|, a small hurry on the slow root raises the centre of mass of every top, and lowers
the axis if and only if Mgl < 0. A hurry on the fast root raises the centre of mass if and only if
Mgl a < 0, where a = (Ix - Iz) cos(theta) if the spin rate is held and Ix cos(theta) if the spin
momentum is. docs/derivation.md has the derivation. Elsewhere the top may rise although the rule
fails, and the reverse. The answer to a kick says so.
"""

from dataclasses import dataclass
from decimal import Decimal, localcontext
from typing import Literal

import numpy as np

from symtop_ros.physics.exact.precise import PRECISE
from symtop_ros.physics.kicks import Hold
from symtop_ros.physics.precession import TiltQuadratic
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import EPS
from symtop_ros.wording import write

Direction = Literal["rises", "falls", "stays"]
Rule = Literal["holds", "fails"]
# What the words mean: the top, or for Mgl < 0 the axis, apart from the centre of mass.
Subject = Literal["top", "axis"]
PlaceKind = Literal["none", "only", "above", "below", "slow", "fast", "between", "outside"]
# Reasons why the rule says nothing about a change of phi', and about an axis on the vertical.
Silence = Literal["angular_impulse", "no_precession", "unchanged", "reversed", "no_effect"]
VerticalCase = Literal["undefined", "stable", "unstable"]
ReasonKind = Literal["hurried", "delayed", "if_hurried", "if_delayed"] | Silence | VerticalCase
ROUNDING = 4 * Decimal.from_float(EPS)  # of a sum of two products, relative to its terms
STATE_ROUNDING = 8 * EPS  # cos(theta) of a quaternion: four squares, each rounded, and its norm


@dataclass(frozen=True, slots=True)
class Place:
    """Place of a precession rate among the rates of regular precession.

    Attributes
    ----------
    kind : str
        "slow" or "fast": it is one of two; "between" or "outside" two; "only": it is the only one;
        "above" or "below" the only one; "none": no rate is regular.
    rate : float
        The rate in rad/s.
    regular_rates : tuple of float
        Rates of regular precession in rad/s, the slow one first.
    """

    kind: PlaceKind
    rate: float
    regular_rates: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Reason:
    """Why Perry's rule holds, fails or says nothing, with its numbers.

    Attributes
    ----------
    kind : str
        "hurried" or "delayed" for a kick, "if_hurried" or "if_delayed" for a kick that a verdict
        considers. All others are cases in which the rule says nothing.
    rule : {"holds", "fails"} or None
        The rule for the axis; None if it says nothing.
    subject : {"top", "axis"}
        "axis" for Mgl < 0: the rule is then the opposite for the centre of mass.
    before, after : float or None
        phi' without the kick and with it, in rad/s; None on the vertical.
    theta_ddot_without, theta_ddot : float or None
        theta'' without the kick and with it, in rad/s^2; None on the vertical.
    place : Place or None
        Place of phi' with a kick, or of the present phi' for a verdict; None on the vertical.
    """

    kind: ReasonKind
    rule: Rule | None
    subject: Subject
    before: float | None = None
    after: float | None = None
    theta_ddot_without: float | None = None
    theta_ddot: float | None = None
    place: Place | None = None

    def __str__(self) -> str:
        """Return the sentence on Perry's rule."""
        return write("reason", self)


@dataclass(frozen=True, slots=True)
class TiltAcceleration:
    """theta'' as a function of phi' at the tilt of one state.

    Parameters
    ----------
    quadratic : TiltQuadratic
    sine_per_moment : float
        sin(theta)/Ix, in 1/(kg m^2).
    """

    quadratic: TiltQuadratic
    sine_per_moment: float

    @classmethod
    def of(cls, top: Top, state: State, hold: Hold) -> "TiltAcceleration":
        """Return theta'' of a state; `hold` decides what is held while phi' varies.

        A state has cos(theta) and psi' to some EPS of 1 and of its rates. What is smaller is zero:
        else a horizontal axis without spin would rise or fall by the chance of its rounding.
        """
        gx, gy, gz = state.vertical.tolist()
        spin = float(state.angular_velocity[2])
        if hold == "spin_rate":
            spin = _find_rates(state)[1]
        if abs(gz) <= STATE_ROUNDING:
            gz = 0.0
        if abs(spin) <= STATE_ROUNDING * float(np.abs(state.angular_velocity).max()):
            spin = 0.0
        # Extended numbers: phi' of an axis next to the vertical has a square beyond all doubles.
        quadratic = TiltQuadratic.of(top, np.longdouble(gz), np.longdouble(spin), hold)
        return cls(quadratic, float(np.hypot(gx, gy)) / top.Ix)

    def at(self, phi_dot: float) -> float:
        """Return theta'' in rad/s^2; exactly 0 if it vanishes up to rounding."""
        if self.quadratic.is_balanced(phi_dot):
            return 0.0
        return float(self.sine_per_moment * self.quadratic.at(phi_dot))

    def place(self, phi_dot: float) -> Place:
        """Return the place of a rate among the rates of regular precession."""
        rates = self.quadratic.roots
        return Place(self._find_place(phi_dot, rates), float(phi_dot), rates)

    def _find_place(self, phi_dot: float, rates: tuple[float, ...]) -> PlaceKind:
        if not rates:
            return "none"
        if self.quadratic.is_balanced(phi_dot):
            if len(rates) == 1:
                return "only"
            return "slow" if abs(rates[0] - phi_dot) <= abs(rates[1] - phi_dot) else "fast"
        if len(rates) == 1:
            return "above" if phi_dot > rates[0] else "below"
        return "between" if min(rates) < phi_dot < max(rates) else "outside"


def find_change(
    top: Top, before: State, after: State, hold: Hold | None
) -> tuple[TiltAcceleration, float, float, float | None]:
    """Return the kick that leads from one state to another of the same attitude.

    It is theta'' at the tilt, phi' before and after the kick, and their quotient, or None for an
    angular impulse. The kick has rounded the angular velocity. A rate or a change of this size is
    no rate and no change: its sign would decide the verdict by chance.
    """
    was, now = find_precession(before), find_precession(after)
    sine = float(np.hypot(*before.vertical[:2]))
    rounding = 8 * EPS * float(np.hypot(*before.angular_velocity[:2])) / sine
    now = was if abs(now - was) <= rounding else 0.0 if abs(now) <= rounding else now
    if hold is None:
        return TiltAcceleration.of(top, after, "spin_rate"), was, now, None
    return TiltAcceleration.of(top, before, hold), was, now, now / was if was else 1.0


def explain_change(
    tilt: TiltAcceleration, before: float, after: float, factor: float | None, is_done: bool
) -> Reason:
    """Return Perry's rule for a change of phi'; `is_done` is False if it is only considered."""
    # of Ix theta''/sin(theta), which decides the rule, in N m
    change = float(tilt.quadratic.change(before, after))
    silence = _find_silence(before, factor, change)
    is_hurried = factor is not None and factor > 1
    kind: ReasonKind = "hurried" if is_hurried else "delayed"
    if not is_done:
        kind = "if_hurried" if is_hurried else "if_delayed"
    rule: Rule = "holds" if (change < 0) == is_hurried else "fails"
    return Reason(
        silence or kind,
        None if silence else rule,
        name_subject(tilt.quadratic.Mgl),
        before,
        after,
        tilt.at(before),
        tilt.at(after),
        tilt.place(after if is_done else before),
    )


def _find_silence(before: float, factor: float | None, change: float) -> Silence | None:
    """Return the reason why the rule says nothing; None if it says something."""
    if factor is None:
        return "angular_impulse"
    if before == 0:
        return "no_precession"
    if factor == 1:
        return "unchanged"
    if factor < 0:
        return "reversed"
    return None if change else "no_effect"


def find_precession(state: State) -> float:
    """Return phi' in rad/s; exactly 0 if it vanishes up to rounding of its two terms."""
    return _find_rates(state)[0]


def _find_rates(state: State) -> tuple[float, float]:
    """Return phi' and psi' of one state in rad/s, the nearest doubles to those of its doubles.

    Next to the vertical phi' is a quotient of small differences. With the rounding of doubles it
    has half of its digits there, and a large factor can take the kicked rate to a place where the
    others decide.
    """
    with localcontext(PRECISE):
        w, x, y, z = map(Decimal, state.given_orientation.tolist())
        wx, wy, wz = map(Decimal, state.angular_velocity.tolist())
        upper, lower = w * w + z * z, x * x + y * y
        along_x, along_y = wx * (x * z - w * y), wy * (y * z + w * x)
        if abs(along_x + along_y) <= ROUNDING * (abs(along_x) + abs(along_y)):
            return 0.0, float(wz)
        size = (upper + lower) / 2  # 1/2 but for the rounding of the quaternion
        phi_dot = (along_x + along_y) / upper / lower * size
        return float(phi_dot), float(wz - phi_dot * (upper - lower) / (upper + lower))


def name_subject(Mgl: float) -> Subject:
    """Return what the words mean for a gravity moment."""
    return "axis" if Mgl < 0 else "top"
