"""Perry's rule: "hurry on the precession, and the body rises in opposition to gravity".

With theta' = 0 the top rises where theta'' < 0, and Ix theta''/sin(theta) is a quadratic in phi':
a phi'^2 - b phi' + Mgl, whose roots are the rates of regular precession. With the spin rate held
a = (Ix - Iz) cos(theta), b = Iz psi' (the article's comparison); with the axial momentum held
a = Ix cos(theta), b = p_psi. The rule holds where theta'' sinks as |phi'| grows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from symtop_ros.physics.kicks import Hold
from symtop_ros.physics.motion import Motion, motion
from symtop_ros.physics.precession import quadratic_roots
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top

Direction = Literal["rises", "falls", "stays"]
ROUNDING = 64 * 2.0**-52


@dataclass(frozen=True, slots=True)
class Verdict:
    """What a state leads to, and whether hurrying its precession would raise the top.

    Attributes
    ----------
    direction : {"rises", "falls", "stays"}
        By theta', or by theta'' where theta' = 0.
    turning_angles : (float, float)
        Smallest and largest theta in rad from here on.
    regular_rates : tuple of float
        Rates of regular precession at this tilt, the spin rate (or axial momentum) as it is.
    rule_holds : bool or None
        Whether theta'' sinks as |phi'| grows; None on the vertical, where phi' is undefined.
    reason : str
        In one sentence, why.
    """

    direction: Direction
    turning_angles: tuple[float, float]
    regular_rates: tuple[float, ...]
    rule_holds: bool | None
    reason: str

    def __str__(self) -> str:
        """Return direction, turning angles, and the rule with its reason."""
        low, high = self.turning_angles
        return f"the top {self.direction}, theta {low:.3f} .. {high:.3f} rad; {self.reason}"


@dataclass(frozen=True, slots=True)
class _Balance:
    """theta'' as a function of phi' at one tilt: (sin(theta)/Ix) (a phi'^2 - b phi' + Mgl)."""

    a: float
    b: float
    Mgl: float
    phi_dot: float

    @classmethod
    def of(cls, top: Top, state: State, hold: Hold) -> _Balance:
        cosine, rates = float(state.vertical[2]), state.euler_rates
        if hold == "spin_momentum":
            spin = float(top.axial_momentum(state))
            return cls(top.Ix * cosine, spin, top.Mgl, rates.phi)
        return cls((top.Ix - top.Iz) * cosine, top.Iz * rates.psi, top.Mgl, rates.phi)

    @property
    def rates(self) -> tuple[float, ...]:
        return quadratic_roots(self.a, self.b, self.Mgl)

    @property
    def direction(self) -> Direction:
        """Sign of theta'', nothing where rounding hides it."""
        p = abs(self.phi_dot)
        terms = (abs(self.a) * p + abs(self.b)) * p + abs(self.Mgl)
        if abs(self.value) <= ROUNDING * terms:
            return "stays"
        return "rises" if self.value < 0 else "falls"

    @property
    def value(self) -> float:
        """Ix theta''/sin(theta), N m."""
        return (self.a * self.phi_dot - self.b) * self.phi_dot + self.Mgl

    @property
    def sense(self) -> float:
        """Sign of phi'; for phi' = 0 that of the slow root, towards which one would hurry."""
        return math.copysign(1.0, self.phi_dot or (self.rates[0] if self.rates else self.b))

    @property
    def slope(self) -> float:
        """Change of Ix theta''/sin(theta) with |phi'|."""
        return (2 * self.a * self.phi_dot - self.b) * self.sense


def perry(top: Top, state: State, hold: Hold = "spin_rate") -> Verdict:
    """Return what follows from a state, and whether Perry's rule holds there and why.

    Parameters
    ----------
    top : Top
    state : State
        One state.
    hold : {"spin_rate", "spin_momentum"}
        What hurrying is understood to leave as it is.
    """
    path = motion(top, state)
    if path.kind == "sleeping":
        stability = "stable" if top.sleeping_is_stable(state) else "unstable"
        reason = f"the axis sleeps on the vertical, where it is {stability}"
        return Verdict("stays", path.turning_angles, (), None, reason)
    if _vertical(state):
        reason = "the axis is vertical, where the precession rate is undefined"
        return Verdict(_departure(state), path.turning_angles, (), None, reason)
    balance = _Balance.of(top, state, hold)
    holds = balance.slope < 0
    return Verdict(
        _direction(state, balance),
        path.turning_angles,
        balance.rates,
        holds,
        f"{_place(balance)}; Perry's rule {'holds' if holds else 'fails'} here: "
        f"{_condition(balance, hold)}",
    )


def kick_verdict(path: Motion, before: State, hold: Hold = "spin_rate") -> str:
    """Return in one sentence what a kick asked for, what follows and whether Perry was right.

    Parameters
    ----------
    path : Motion
        From the state after the kick.
    before : State
    hold : {"spin_rate", "spin_momentum"}
    """
    top, after = path.top, path.start
    low, high = path.turning_angles
    if _vertical(before):
        return f"kicked off the vertical: {path.kind}, theta {low:.3f} .. {high:.3f} rad"
    was, now = _Balance.of(top, before, hold), _Balance.of(top, after, hold)
    direction, effect = now.direction, f"the top {now.direction}"
    if _moving(after):
        direction = "rises" if now.value < was.value else "falls"
        effect = f"the moving top is {'lifted' if direction == 'rises' else 'pressed down'}"
    return (
        f"precession {was.phi_dot:.2f} -> {now.phi_dot:.2f} rad/s ({_regular(now.rates)}): "
        f"{effect}, theta {low:.3f} .. {high:.3f} rad; {_judgement(was, now, direction)}"
    )


def _judgement(was: _Balance, now: _Balance, direction: Direction) -> str:
    """Compare what the rule says of a kick with what the top does."""
    if now.phi_dot == was.phi_dot:
        return "the precession was not changed, and Perry's rule says nothing"
    if now.phi_dot * was.phi_dot < 0:
        return "the precession was reversed, of which Perry's rule says nothing"
    if direction == "stays":
        return "regular precession, neither hurried nor delayed"
    hurried = abs(now.phi_dot) > abs(was.phi_dot)
    holds = (direction == "rises") == hurried
    words = "" if hurried else "delayed: "
    return f"{words}Perry's rule {'holds' if holds else 'fails'} here ({_place(now)})"


def _vertical(state: State) -> bool:
    x, y, _ = state.vertical
    return bool(x == 0 and y == 0)


def _departure(state: State) -> Direction:
    """A moving axis leaves the upper pole downwards and the lower one upwards."""
    return "falls" if state.vertical[2] > 0 else "rises"


def _direction(state: State, balance: _Balance) -> Direction:
    if _moving(state):
        return "rises" if state.euler_rates.theta < 0 else "falls"
    return balance.direction


def _moving(state: State) -> bool:
    """Whether theta' is more than rounding."""
    theta_dot = float(state.euler_rates.theta)
    return abs(theta_dot) > ROUNDING * float(abs(state.angular_velocity).max())


def _regular(rates: tuple[float, ...]) -> str:
    if not rates:
        return "no regular precession"
    return "regular at " + " and ".join(f"{rate:.2f}" for rate in rates)


def _place(balance: _Balance) -> str:
    """Where phi' lies among the rates of regular precession."""
    rate = f"phi' = {balance.phi_dot:.2f}"
    if not balance.rates:
        return f"{rate} rad/s, and no rate is regular at this tilt and spin"
    roots = " and ".join(f"{root:.2f}" for root in balance.rates)
    if balance.direction == "stays":
        nearest = min(
            range(len(balance.rates)), key=lambda i: abs(balance.rates[i] - balance.phi_dot)
        )
        name = ("slow", "fast")[nearest] if len(balance.rates) == 2 else "only"
        return f"{rate} is the {name} rate of regular precession of {roots} rad/s"
    if len(balance.rates) == 1:
        side = "above" if balance.phi_dot > balance.rates[0] else "below"
        return f"{rate} is {side} the only root {roots} rad/s"
    inside = min(balance.rates) < balance.phi_dot < max(balance.rates)
    return f"{rate} is {'between' if inside else 'outside'} the roots {roots} rad/s"


def _condition(balance: _Balance, hold: Hold) -> str:
    """The sign condition behind the rule."""
    left, right = ("2 (Ix - Iz) cos(theta) phi'", "Iz psi'")
    if hold == "spin_momentum":
        left, right = "2 Ix cos(theta) phi'", "p_psi"
    sign = "<" if 2 * balance.a * balance.phi_dot < balance.b else ">="
    way = "phi' >= 0" if balance.sense > 0 else "phi' < 0"
    effect = "lowers" if balance.slope < 0 else "raises"
    return f"{left} {sign} {right} with {way}, so that more |phi'| {effect} theta''"
