"""The closed form as a reader of a textbook would write it, with SciPy's elliptic functions.

u = cos(theta) is a Jacobian function of time between the roots of the cubic (Goldstein, Classical
Mechanics, section 5.7); phi and psi are incomplete elliptic integrals of the third kind, by the
forms of Carlson (DLMF 19.25.14). It is divided by sin(theta)^2, and nothing is done against
cancellation. It has motions between two different tilts that are no poles, with Mgl > 0.
"""

import numpy as np
from scipy.special import ellipj, ellipk, ellipkinc, elliprf, elliprj

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from workshop.speed.peers.peer import Arrays, Peer, Solution, from_euler_angles


class ClosedForm:
    """The constants of a motion, and its states."""

    def __init__(self, task: Motion) -> None:
        Ix, Iz, Mgl = task.top.moments
        phi, theta, psi = task.start.euler_angles
        phi_dot, theta_dot, psi_dot = task.start.euler_rates
        u, self.spin = np.cos(theta), psi_dot + phi_dot * np.cos(theta)
        self.a = Iz * self.spin / Ix
        self.b = phi_dot * np.sin(theta) ** 2 + self.a * u
        beta = 2 * Mgl / Ix
        alpha = theta_dot**2 + (phi_dot * np.sin(theta)) ** 2 + beta * u
        # u'^2 = (1 - u^2) (alpha - beta u) - (b - a u)^2
        cubic = [beta, -alpha - self.a**2, 2 * self.a * self.b - beta, alpha - self.b**2]
        self.low, high, third = np.sort(np.roots(cubic).real)
        self.width = high - self.low
        self.m = self.width / (third - self.low)
        self.rate = np.sqrt(beta * (third - self.low)) / 2
        sine = np.sqrt(np.clip((u - self.low) / self.width, 0.0, 1.0))
        if not theta_dot:  # a turning point: rounding in the root would cost half of all digits
            sine = np.rint(sine)
        # u grows while theta falls
        self.phase = -np.copysign(ellipkinc(np.arcsin(sine), self.m), theta_dot)
        self.angles = phi, psi
        self.begin = self._integrate(np.array([self.phase]))

    def orientation(self, times: Real) -> Real:
        """Return the orientations (n, 4) at times (n,) in s."""
        w = self.phase + self.rate * np.asarray(times)
        sine = ellipj(w, self.m)[0]
        up, down = (now - start for now, start in zip(self._integrate(w), self.begin, strict=True))
        phi = self.angles[0] + (up + down) / 2
        psi = self.angles[1] + (self.spin - self.a) * times - (up - down) / 2
        theta = np.arccos(self.low + self.width * sine**2)
        return from_euler_angles(np.stack([phi, theta, psi], axis=1))

    def _integrate(self, w: Real) -> tuple[Real, Real]:
        """Return the integrals of (b - a)/(1 - u) and (b + a)/(1 + u) over time, from w = 0."""
        amplitude = ellipj(w, self.m)[3]
        above, below = 1 - self.low, 1 + self.low
        up = find_third_kind(self.width / above, amplitude, self.m)
        down = find_third_kind(-self.width / below, amplitude, self.m)
        by_rate = (self.b - self.a) / (above * self.rate), (self.b + self.a) / (below * self.rate)
        return by_rate[0] * up, by_rate[1] * down


def find_third_kind(n: float, amplitude: Real, m: float) -> Real:
    """Return the incomplete elliptic integral of the third kind for any amplitude in rad."""
    turns = np.rint(amplitude / np.pi)
    s, c = np.sin(amplitude - turns * np.pi), np.cos(amplitude - turns * np.pi)
    x, y, z = c * c, 1 - m * s * s, 1 - n * s * s
    part = s * elliprf(x, y, 1.0) + n / 3 * s**3 * elliprj(x, y, 1.0, z)
    whole = ellipk(m) + n / 3 * elliprj(0.0, 1 - m, 1.0, 1 - n)
    return np.asarray(part + 2 * turns * whole)


def prepare(task: Motion, _: float) -> Solution:
    """Return a solution that finds the constants at each call, as the package does."""
    compute = prepare_arrays(task)
    return Solution.of_arrays(lambda t: np.asarray(compute(np.array([t]))[0]), compute)


def prepare_arrays(task: Motion) -> Arrays:
    """Return a function for the orientations at many times."""
    return lambda times: ClosedForm(task).orientation(times)


PEERS = [Peer("SciPy, elliptic functions", (0.0,), prepare, prepare_arrays=prepare_arrays)]
