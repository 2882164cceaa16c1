"""A rigid body on a fixed point, integrated as its equations stand in a textbook.

Nothing of the package is used: Euler's equations of three moments (Goldstein, section 5.5), the
rotation matrix as nine numbers, and SciPy's DOP853.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Real = NDArray[np.float64]
PRECISE = 1e-11  # of a step; over a record the error stays far below its noise


@dataclass(frozen=True)
class Body:
    """Moments about the pivot, the weight, and what takes spin away.

    Attributes
    ----------
    moments : tuple of float
        About the axes x, y, z of the body, in kg m^2; z goes through pivot and centre of mass.
    weight : float
        Weight times the distance of the centre of mass from the pivot, in J.
    dry : float
        Torque against the spin whose size does not depend on it, in N m.
    linear : tuple of float
        Torques about z, and across it, for each rad/s, in N m s.
    """

    moments: tuple[float, float, float]
    weight: float
    dry: float = 0.0
    linear: tuple[float, float] = (0.0, 0.0)

    def find_slopes(self, _: float, state: Real) -> Real:
        """Return the derivatives (12,) of a rotation matrix and the rates of the body."""
        turned, rates = state[:9].reshape(3, 3), state[9:]
        moments = np.asarray(self.moments)
        down = -turned[2]  # in the body
        torque = self.weight * np.cross([0.0, 0.0, 1.0], down)
        axial, across = self.linear
        torque -= [across * rates[0], across * rates[1], axial * rates[2]]
        torque[2] -= self.dry * np.sign(rates[2])
        x, y, z = rates
        spinning = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        change = (torque - np.cross(rates, moments * rates)) / moments
        return np.concatenate([(turned @ spinning).ravel(), change])


@dataclass(frozen=True)
class Kick:
    """A sudden change of the rates of the body, (3,) in rad/s, at a time in s."""

    time: float
    change: tuple[float, float, float]


class Course:
    """What a body does from a start on, with kicks at some times."""

    def __init__(
        self, body: Body, matrix: Real, rates: Real, seconds: float, kicks: Sequence[Kick] = ()
    ) -> None:
        state = np.concatenate([matrix.ravel(), rates])
        ends = [*(kick.time for kick in kicks), seconds]
        changes = [*(kick.change for kick in kicks), (0.0, 0.0, 0.0)]
        self._starts, self._pieces, begin = [], [], 0.0
        for end, change in zip(ends, changes, strict=True):
            piece = solve_ivp(
                body.find_slopes,
                (begin, end),
                state,
                "DOP853",
                dense_output=True,
                rtol=PRECISE,
                atol=PRECISE,
            )
            self._starts.append(begin)
            self._pieces.append(piece.sol)
            state, begin = piece.y[:, -1].copy(), end
            state[9:] += change

    def at(self, times: Real) -> tuple[Real, Real]:
        """Return the rotation matrices (n, 3, 3) and the rates of the body (n, 3) at times (n,)."""
        places = np.searchsorted(self._starts, times, side="right") - 1
        states = np.array(
            [
                self._pieces[max(place, 0)](time)
                for place, time in zip(places.tolist(), times.tolist(), strict=True)
            ]
        )
        return states[:, :9].reshape(-1, 3, 3), states[:, 9:]


def place_body(theta: float, phi: float) -> Real:
    """Return the matrix (3, 3) of a body that was turned by theta about x, then by phi about z."""
    cos, sin = np.cos(theta), np.sin(theta)
    tilted = np.array([[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]])
    cos, sin = np.cos(phi), np.sin(phi)
    turned = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(turned @ tilted)
