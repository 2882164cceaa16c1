"""The article's top, random tops and starts, and the distance of two attitudes."""

import math
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from drawn import Numbers, cos, sin
from mpmath import mp, mpf
from waiting import TIMEOUT

from symtop_ros.physics import Motion, State, Top, regular_precession_rates
from symtop_ros.physics.reference.series import Inputs
from workshop.digits import ClosedForm, ExactState, Series
from workshop.testset.exact import DIGITS

EPS = 2.0**-52
FAMILIES = ("any", "weak gravity", "fast", "critical", "pendulum", "from below")
ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
CUSPS = State.from_euler(theta=0.5, psi_dot=200.0)
SLOW, FAST = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)
# A disc that hangs from its pivot: Iz > Ix and Mgl < 0, where Perry's rule can fail at slow roots.
DISC = Top(Ix=0.0002, Iz=0.00035, Mgl=-0.05)


def find_roots(top, theta, spin):
    """Return the rates of regular precession that there are, the slow one first."""
    rates = regular_precession_rates(top, theta=theta, psi_dot=spin)
    return [rate for rate in rates if math.isfinite(rate)]


@dataclass(frozen=True)
class Case:
    """A top, its start and a time."""

    top: Top
    start: State
    t: float

    @property
    def inputs(self) -> Inputs:
        return Inputs.of(self.top, self.start)

    @property
    def exact(self) -> ExactState:
        """Orientation and angular velocity to 30 digits or more."""
        return ClosedForm(self.inputs, DIGITS).at(self.t)


def random_case(seed: int, family: str) -> Case:
    rng = Numbers(f"{family} {seed}")
    Ix = rng.power(-6, 1)
    ratio = rng.choice([rng.uniform(0.01, 2.0), 2.0, 1.0 + 1e-12, 1.0, rng.power(-4, 0)])
    pull = rng.power(0, 3) * rng.choice([1, 1, -1])
    tilt = rng.choice([rng.uniform(0, math.pi), rng.power(-12, 0)])
    critical = 2 * math.sqrt(abs(pull)) / ratio  # rad/s, where p_psi^2 = 4 Ix Mgl
    spin = critical * rng.choice([-1, 1]) * rng.choice([0.0, rng.power(-2, 3)])
    across = rng.choice([0.0, rng.power(-3, 1) * critical, tilt * critical])
    t = rng.power(-3, 9) * rng.choice([-1, 1])
    if family == "weak gravity":
        pull = rng.choice([-1, 1]) * 1e-15 / Ix
    if family == "fast":
        spin = rng.choice([-1, 1]) * rng.power(5, 7)
    if family == "critical":
        spin = critical * (1 + rng.choice([0.0, rng.uniform(-1e-9, 1e-9)]))
        tilt = rng.power(-12, -2)
        across = 0.0
        t = rng.uniform(0.1, 30) / math.sqrt(abs(pull))
    if family == "pendulum":
        spin = 0.0
        t = rng.uniform(0.1, 30) / math.sqrt(abs(pull))
    if family == "from below":  # through the lower pole, with more or less than enough to rise
        tilt = math.pi - rng.power(-12, -1)
        spin *= rng.choice([0.0, 1e-9, 1.0])
        across = 2 * math.sqrt(abs(pull)) * (1 + rng.choice([0.0, 1e-15, 1e-9, 0.1, -1e-6]))
        t = rng.uniform(0.1, 10) / math.sqrt(abs(pull))
    angle, phi, psi = (rng.uniform(-3, 3) for _ in range(3))
    c, s = cos(tilt / 2), sin(tilt / 2)
    plus = (phi + psi) / 2
    minus = (phi - psi) / 2
    q = (c * cos(plus), s * cos(minus), s * sin(minus), c * sin(plus))
    omega = (across * cos(angle), across * sin(angle), spin)
    return Case(Top(Ix, Ix * ratio, Ix * pull), State(q, omega), t)


def precess(phi_dot: float, psi_dot: float = 200.0, theta: float = 0.5) -> State:
    """A start with theta' = 0."""
    return State.from_euler(theta=theta, phi_dot=phi_dot, psi_dot=psi_dot)


def random_states(count: int, seed: int = 1) -> State:
    """Attitudes all over the sphere, rates of all sizes about 10 rad/s."""
    rng = Numbers(seed)
    return State(rng.quaternions(count), rng.normals(count, 3) * 10)


def distance(a: State, b: State) -> float:
    """Largest distance of the quaternions, up to sign."""
    p, q = a.orientation, b.orientation
    minus, plus = (np.linalg.norm(each, axis=-1) for each in (p - q, p + q))
    return float(np.max(np.minimum(minus, plus)))


def error(exact, doubles, size: float = 1.0) -> float:
    """Distance of a vector of doubles from an exact one, relative to a size."""
    with mp.workdps(40):
        pairs = zip(exact, np.asarray(doubles).tolist(), strict=True)
        return float(mp.norm([mpf(a) - b for a, b in pairs]) / size)


def attitude_error(exact, doubles, size: float = 1.0) -> float:
    """The same of a quaternion, or parts of it, up to sign."""
    return min(error(exact, sign * np.asarray(doubles), size) for sign in (1, -1))


def follow_exactly(
    motion: Motion, inputs: Inputs | None = None, digits: int = 40
) -> ClosedForm | Series:
    """The exact motion with the friction and torque of one of doubles, maybe from other inputs."""
    inputs = inputs or Inputs.of(motion.top, motion.start)
    if not motion.is_driven:
        return ClosedForm(inputs, digits)
    friction = motion.friction.axial, motion.friction.transverse
    return Series(inputs, digits, friction, motion.applied_torque)


def exact_parts(state: State):
    """w, x, y, z of norm 1 and omega of a state of doubles, with many digits."""
    q, omega = ([mpf(c) for c in part.tolist()] for part in state._parts)
    return [c / mp.norm(q) for c in q], omega


def exact_euler(q, omega):
    """phi, theta, psi and their rates, of a quaternion and body rates with many digits."""
    (w, x, y, z), (wx, wy, wz) = q, omega
    theta = 2 * mp.atan2(mp.hypot(x, y), mp.hypot(w, z))
    upper = mp.atan2(z, w)
    lower = mp.atan2(y, x)
    sine = mp.sin(theta)
    gx = 2 * (x * z - w * y)
    gy = 2 * (y * z + w * x)
    phi_dot = (wx * gx + wy * gy) / sine**2
    rates = phi_dot, (wx * gy - wy * gx) / sine, wz - phi_dot * mp.cos(theta)
    return (upper + lower, theta, upper - lower), rates


def multiply(p, q):
    """The product of two quaternions of any numbers."""
    (w, x, y, z), (a, b, c, d) = p, q
    return (
        w * a - x * b - y * c - z * d,
        w * b + x * a + y * d - z * c,
        w * c - x * d + y * a + z * b,
        w * d + x * c - y * b + z * a,
    )


def turn(q, v):
    """q v q* as v + 2 u x (w v + u x v), of numbers with many digits."""
    w, *u = q
    inner = [w * a + b for a, b in zip(v, cross(u, v), strict=True)]
    return [a + 2 * b for a, b in zip(v, cross(u, inner), strict=True)]


def cross(a, b):
    return [a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)]


@contextmanager
def ending() -> Iterator[None]:
    """Raise an error if the block hangs, between two calls of the kernel."""

    def end(*_):
        raise AssertionError(f"no end within {TIMEOUT} s")

    usual = signal.signal(signal.SIGALRM, end)
    # again and again: Python ignores what is raised while it collects garbage
    signal.setitimer(signal.ITIMER_REAL, TIMEOUT, TIMEOUT)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, usual)
