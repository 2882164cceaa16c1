"""Steps to the depth of a fall without constants of motion, by Euler's explicit scheme.

The torque gives three accelerations (the article's equations of theta'', phi'' and psi''). A step
adds each acceleration times dt to its rate, and theta' times dt to theta, with the values at the
beginning of the step. The error is of first order in dt: each digit takes ten times the steps.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from symtop_ros.physics import Top


@dataclass(frozen=True, slots=True)
class Tilted:
    """A tilted top, as far as its accelerations depend on it: theta in rad, rates in rad/s."""

    theta: float
    theta_dot: float
    phi_dot: float
    psi_dot: float

    def accelerate(self, top: Top) -> tuple[float, float, float]:
        """Return theta'', phi'' and psi'' in rad/s^2."""
        Ix, Iz, Mgl = top.moments
        sine, cosine = math.sin(self.theta), math.cos(self.theta)
        theta, phi, psi = self.theta_dot, self.phi_dot, self.psi_dot
        tilt = sine / Ix * ((Ix - Iz) * phi**2 * cosine - Iz * phi * psi + Mgl)
        turn = theta / (Ix * sine) * (Iz * psi + (Iz - 2 * Ix) * phi * cosine)
        return tilt, turn, theta * phi * sine - turn * cosine

    def step(self, top: Top, dt: float) -> "Tilted":
        """Return what Euler's explicit scheme makes of it in a step of dt in s."""
        tilt, turn, spin = self.accelerate(top)
        return Tilted(
            self.theta + self.theta_dot * dt,
            self.theta_dot + tilt * dt,
            self.phi_dot + turn * dt,
            self.psi_dot + spin * dt,
        )


@dataclass(frozen=True, slots=True)
class Count:
    """The steps of a fall, with the longest step that finds so many digits of its depth."""

    digits: int
    dt: float  # ms
    steps: int
    theta: float  # rad, where theta' is no longer positive


def fall(top: Top, start: Tilted, dt: float) -> tuple[int, float]:
    """Return the steps of dt in s until theta' is no longer positive, and theta there."""
    steps = 1
    now = start.step(top, dt)
    while now.theta_dot > 0:
        steps, now = steps + 1, now.step(top, dt)
    return steps, now.theta


def count_steps(top: Top, start: Tilted, depth: float, most: int) -> Iterator[Count]:
    """Yield the counts for 1 to `most` digits of the depth in rad.

    The steps tried are 10, 5, 2, 1, 0.5 ... ms; a digit is found if theta is off by less than half
    a unit of it.
    """
    tried = _list_steps()
    dt = 0.0
    steps, theta = 0, math.inf
    for digits in range(1, most + 1):
        while abs(theta - depth) >= 0.5 * 10.0**-digits:
            dt = next(tried)
            steps, theta = fall(top, start, dt / 1e3)
        yield Count(digits, dt, steps, theta)


def _list_steps() -> Iterator[float]:
    """Yield 10, 5, 2, 1, 0.5 ... ms."""
    parts = 1
    while True:
        yield from (size / parts for size in (10, 5, 2))
        parts *= 10
