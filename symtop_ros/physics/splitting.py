"""The top under friction and an applied torque: a composition of two flows that are each exact.

- *Turn*: no torque acts. The body turns about L by |L| h/Ix, and about its axis by
  omega_z (1 - Iz/Ix) h. The second turn commutes with everything, friction and weight being the
  same all round the axis; so it is only counted, as an angle, and the spin needs no small steps.
- *Push*: the attitude is held. Gravity's and the applied torque are constant in the body, friction
  makes each rate go exponentially to what they drive it to.

The composition is symmetric, of order 8 with 17 stages (Kahan & Li, Math. Comp. 66 (1997) 1089;
coefficients as in Hairer, Lubich & Wanner, Geometric Numerical Integration, V.3.2).
"""

from __future__ import annotations

from math import cos, expm1, hypot, inf, pi, remainder, sin, sqrt
from typing import NamedTuple

from symtop_ros.physics.friction import Friction
from symtop_ros.physics.top import Top

ORDER = 8
HALF_OF_STAGES = (
    0.13020248308889008087881763,
    0.56116298177510838456196441,
    -0.38947496264484728640807860,
    0.15884190655515560089621075,
    -0.39590389413323757733623154,
    0.18453964097831570709183254,
    0.25837438768632204729397911,
    0.29501172360931029887096624,
)
TURNS = (*HALF_OF_STAGES, -0.60550853383003451169892108, *reversed(HALF_OF_STAGES))
PUSHES = tuple((a + b) / 2 for a, b in zip((0.0, *TURNS), (*TURNS, 0.0), strict=True))
TURNS_AFTER = (*TURNS, 0.0)
STEP = 0.4  # rad of `Splitting.rate`: leaves an error of about 1e-14 a step, 1e-13 at worst
LARGEST_RATE = 1e150  # rad/s; squares of it stay finite
TURN = 2 * pi

Three = tuple[float, float, float]
Decay = tuple[float, float]


class Point(NamedTuple):
    """A state on the way, as the composition handles it.

    Attributes
    ----------
    t : float
        s.
    A, B : complex
        w + i z and x + i y of the attitude, but for the turn about the axis.
    across : complex
        omega_x + i omega_y, rad/s, in that frame.
    spin : float
        omega_z, rad/s.
    half_turn : float
        Half the angle of the turn about the axis, rad.
    """

    t: float
    A: complex
    B: complex
    across: complex
    spin: float
    half_turn: float = 0.0

    @property
    def attitude(self) -> tuple[complex, complex]:
        """A and B of the body."""
        turn = complex(cos(self.half_turn), sin(self.half_turn))
        return self.A * turn, self.B * turn.conjugate()

    @property
    def rates(self) -> Three:
        """Angular velocity in the body frame, rad/s."""
        turn = complex(cos(2 * self.half_turn), -sin(2 * self.half_turn))
        across = self.across * turn
        return across.real, across.imag, self.spin


class Splitting:
    """Steps of any length from any point.

    Parameters
    ----------
    top : Top
    friction : Friction
    torque : (3,) of float
        Applied torque in the world frame, N m.
    """

    def __init__(self, top: Top, friction: Friction, torque: Three) -> None:
        x, y, z = torque
        self._ratio = top.Iz / top.Ix
        self._half_turn_rate = (top.Ix - top.Iz) / top.Ix / 2
        self._weight = 2 * top.Mgl / top.Ix
        self._applied = x != 0 or y != 0 or z != 0
        self._level, self._upward = complex(x, y) / top.Ix, z / top.Ix
        self._across_decay, self._spin_decay = friction.transverse / top.Ix, friction.axial / top.Iz
        self._strongest = max(abs(top.Mgl) / top.Ix, hypot(x, y, z) / min(top.Ix, top.Iz))

    def next_time(self, point: Point, direction: int) -> float:
        """Return the time of the point after this one; the motion alone decides.

        Raises
        ------
        ValueError
            Where the motion has become too fast for doubles.
        """
        rate = self.rate(point)
        t = point.t + direction * STEP / rate if rate else direction * inf
        if not rate < LARGEST_RATE or t == point.t:
            msg = f"t: the motion is too fast to be followed further than {point.t:g} s"
            raise ValueError(msg)
        return t

    def rate(self, point: Point) -> float:
        """Rate in rad/s that a step resolves.

        Pushes of the size swing^2 on a top that nutates at |L|/Ix leave an error in proportion to
        (h |L|/Ix)^8 (swing Ix/|L|)^2: the faster the top, the longer the step in radians.
        """
        nutation = hypot(abs(point.across), self._ratio * point.spin)
        decay = max(self._across_decay, self._spin_decay)
        swing = sqrt(self._strongest + decay * nutation)
        return sqrt(nutation * sqrt(nutation * swing)) + 2 * swing + decay

    def step(self, point: Point, t: float) -> Point:
        """Return the point at another time, not further off than a step of the grid."""
        h = t - point.t
        _, A, B, across, spin, _ = point
        ratio, weight, angle = self._ratio, self._weight, 0.0
        for (decay, gain), (spin_decay, spin_gain), turn in self._parts(h):
            push = weight * (A.conjugate() * B)
            spin = spin_decay * spin
            if self._applied:
                level, twist = self._applied_push(A, B)
                push, spin = push + level, spin + spin_gain * twist
            across = decay * across + gain * push
            # turned about L by the rate |L|/Ix; written out, it takes two thirds of the time
            axial = ratio * spin
            rate = sqrt(across.real * across.real + across.imag * across.imag + axial * axial)
            sine = sin(rate * turn / 2) / rate if rate else 0.0
            along, over = complex(cos(rate * turn / 2), sine * axial), sine * across
            A, B = A * along - B * over.conjugate(), A * over + B * along.conjugate()
            angle += spin * turn
        off = (1 - (A * A.conjugate()).real - (B * B.conjugate()).real) / 2
        half_turn = remainder(point.half_turn + self._half_turn_rate * angle, TURN)
        return Point(t, A + off * A, B + off * B, across, spin, half_turn)

    def _parts(self, h: float) -> list[tuple[Decay, Decay, float]]:
        """What is left of the rates across and along the axis, and gained, and the turn then."""
        half = [
            (_decay(self._across_decay, push * h), _decay(self._spin_decay, push * h))
            for push in PUSHES[: len(PUSHES) // 2]
        ]
        pushes = (*half, *reversed(half))
        return [(*push, turn * h) for push, turn in zip(pushes, TURNS_AFTER, strict=True)]

    def _applied_push(self, A: complex, B: complex) -> tuple[complex, float]:
        """What the applied torque changes the rates by, across and along the axis, rad/s^2."""
        up, level = self._upward, self._level
        across = A.conjugate() * (A.conjugate() * level + 2j * up * B) + B * B * level.conjugate()
        upright = (A * A.conjugate()).real - (B * B.conjugate()).real
        return across, ((-2j * A * B * level.conjugate()).real + upright * up) / self._ratio


def _decay(rate: float, h: float) -> Decay:
    """Return exp(-rate h), and what a constant push gains: its integral over h."""
    if rate == 0:
        return 1.0, h
    lost = -expm1(-rate * h)
    return 1 - lost, lost / rate
