"""Random tops, starts and times of all families, easy and hard, for comparisons with the CPU."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from symtop_ros.base.arrays import Real

# Orientations of few digits, of which exact resting points, turning points and poles are made.
EXACT = (
    (0.6, 0.8, 0, 0),
    (0.6, 0, 0.8, 0),
    (0.5, 0.5, 0.5, 0.5),
    (0.8, 0.36, 0.48, 0),
    (0.28, 0.96, 0, 0),
    (1, 0, 0, 0),
    (0, 1, 0, 0),
    (0.5, -0.5, 0.5, 0.5),
)


@dataclass
class Draw:
    """Generic tops, starts and times, of which a family changes what makes it one."""

    random: Generator
    count: int

    def __post_init__(self) -> None:
        """Draw what all families begin with."""
        self.Ix = self.log(-5, 1)
        self.ratio = self.random.uniform(0.01, 1, self.count)  # Iz/Ix
        self.Mgl = self.Ix * self.log(-1, 3) * self.sign()
        q = self.random.normal(size=(self.count, 4))
        self.q = q / np.linalg.norm(q, axis=1, keepdims=True)
        self.omega = self.random.normal(size=(self.count, 3)) * self.log(-1, 2)[:, None]
        self.times = self.random.uniform(-1000, 1000, self.count)

    def log(self, low: float, high: float) -> Real:
        """Return numbers between two powers of ten."""
        return np.asarray(10 ** self.random.uniform(low, high, self.count))

    def sign(self) -> Real:
        """Return 1 and -1."""
        return self.choose((-1.0, 1.0))

    def choose(self, values: Sequence[float], *more: int) -> Real:
        """Return some of the values, (count, ...)."""
        places = self.random.integers(0, len(values), (self.count, *more))
        return np.asarray(values, np.float64)[places]

    def happens(self, share: float) -> Real:
        """Return what is True in a share of the cases."""
        return np.asarray(self.random.random(self.count) < share)

    def miss(self, share: float, low: float, high: float) -> Real:
        """Return factors next to 1, which are 1 in a share of the cases."""
        missed = self.log(low, high) * self.sign()
        return 1 + np.where(self.happens(share), 0.0, missed)

    def tilt(self, theta: Real) -> Real:
        """Set orientations of a tilt, turned about both axes; return the angle psi."""
        phi, psi = self.random.uniform(-np.pi, np.pi, (2, self.count))
        c = np.cos(theta / 2)
        s = np.sin(theta / 2)
        plus = (phi + psi) / 2
        minus = (phi - psi) / 2
        parts = (c * np.cos(plus), s * np.cos(minus), s * np.sin(minus), c * np.sin(plus))
        self.q = np.stack(parts, axis=1)
        return np.asarray(psi)

    def turn(self, psi: Real, theta_dot: Real, across: Real, axial: Real) -> None:
        """Set rates from theta', phi' sin(theta) and omega_z."""
        wx = theta_dot * np.cos(psi) + across * np.sin(psi)
        wy = across * np.cos(psi) - theta_dot * np.sin(psi)
        self.omega = np.stack([wx, wy, axial], axis=1)


def _fast(d: Draw) -> None:
    d.omega[:, 2] = d.log(2, 5) * d.sign()


def _slow(d: Draw) -> None:
    d.omega *= d.log(-9, -2)[:, None]


def _cusps(d: Draw) -> None:
    d.omega[:, :2] = 0.0
    d.omega[:, 2] = d.log(-2, 3) * d.sign()


def _separatrix(d: Draw) -> None:
    """The axis comes to rest upright, but for an energy that is missed by 0 or 1e-16 to 0.1."""
    theta = d.random.uniform(0.05, np.pi - 0.05, d.count)
    psi, d.Mgl = d.tilt(theta), np.abs(d.Mgl)
    beta = 2 * d.Mgl / d.Ix
    u = np.cos(theta)
    spin = np.where(d.happens(0.2), 0.0, d.random.uniform(-2, 2, d.count) * np.sqrt(beta))
    across = np.sin(theta) * spin / (1 + u)
    rest = beta * (1 - u) * d.miss(0.1, -16, -1) - across**2
    d.turn(psi, np.sqrt(np.maximum(rest, 0)) * d.sign(), across, spin / d.ratio)


def _vertical(d: Draw) -> None:
    theta = d.log(-16, -2)
    d.tilt(np.where(d.happens(0.5), theta, np.pi - theta))
    d.omega[:, :2] *= np.where(d.happens(0.5), d.log(-16, 0), 1.0)[:, None]


def _flat(d: Draw) -> None:
    d.ratio = np.where(d.happens(0.2), 2.0, d.random.uniform(1, 2, d.count))


def _regular(d: Draw) -> None:
    """A root of the regular precession, missed by 0 or 1e-16 to 0.01."""
    theta = d.random.uniform(0.05, np.pi - 0.05, d.count)
    psi, u = d.tilt(theta), np.cos(theta)
    spin = d.log(0, 3) * d.sign()
    root = np.sqrt(np.maximum(spin**2 - 4 * u * d.Mgl / d.Ix, 0)) * d.sign()
    phi_dot = (spin + root) / (2 * u) * d.miss(0.3, -16, -2)
    d.turn(psi, np.zeros(d.count), np.sin(theta) * phi_dot, spin / d.ratio)


def _short(d: Draw) -> None:
    d.Ix, d.ratio = d.choose((0.001, 0.5, 1.0, 2.0)), d.choose((0.25, 0.5, 1.0, 2.0))
    d.Mgl = d.choose((0.1, 1.0, -1.0, 2.0, 5.0))
    d.q = np.array(EXACT)[d.random.integers(0, len(EXACT), d.count)]
    d.omega = d.choose((0.0, 0.0, 1.0, -1.0, 2.0, 3.0, 10.0), 3)


def _extreme(d: Draw) -> None:
    d.Ix = d.log(-80, 80)
    d.Mgl = d.Ix * d.log(-19, 19) * d.sign()
    d.omega *= d.log(-60, 20)[:, None]


def _free(d: Draw) -> None:
    """Without weight, or at rest on the vertical."""
    weightless, upright = d.happens(0.5), d.happens(0.5)
    d.Mgl = np.where(weightless, 0.0, d.Mgl)
    poles = np.where(upright[:, None], [1.0, 0, 0, 0], [0, 0.6, 0.8, 0])
    d.q = np.where(weightless[:, None], d.q, poles)
    d.omega[weightless == 0, :2] = 0.0


def _refused(d: Draw) -> None:
    d.ratio = np.where(d.happens(0.5), 3.0, np.nan)


FAMILIES: dict[str, Callable[[Draw], None]] = {
    "generic": lambda _: None,
    "fast": _fast,
    "slow": _slow,
    "let go at rest": _cusps,
    "next to the separatrix": _separatrix,
    "next to the vertical": _vertical,
    "Iz > Ix": _flat,
    "next to regular precession": _regular,
    "short decimals": _short,
    "extreme sizes": _extreme,
    "free": _free,
    "refused": _refused,
}


def draw_mixed(count: int, seed: int) -> tuple[Real, Real]:
    """Return starts (n, 15), as `symtop_start` has them, and times (n,), of all families."""
    random = np.random.default_rng(seed)
    share = -(-count // len(FAMILIES))
    parts = [draw_family(name, share, random) for name in FAMILIES]
    starts, times = (np.concatenate(each) for each in zip(*parts, strict=True))
    order = random.permutation(len(starts))[:count]
    return starts[order], times[order]


def draw_family(name: str, count: int, random: Generator) -> tuple[Real, Real]:
    """Return starts (n, 15) and times (n,) of a family."""
    draw = Draw(random, count)
    FAMILIES[name](draw)
    starts = np.zeros((count, 15))
    starts[:, 0] = draw.Ix
    starts[:, 1] = draw.Ix * draw.ratio
    starts[:, 2] = draw.Mgl
    starts[:, 3:7], starts[:, 7:10] = draw.q, draw.omega
    early, far = draw.happens(0.15), draw.happens(0.02)
    times = np.where(early, draw.log(-9, 0) * draw.sign(), draw.times)
    return starts, np.where(far, np.where(draw.happens(0.5), 0.0, draw.log(9, 20)), times)
