"""Sixteen families of random tops, starts and times, for the Taylor series to solve."""

from __future__ import annotations

import json
import lzma
import math
from dataclasses import dataclass
from pathlib import Path

from drawn import Numbers, asin, atan2, cos, hypot, sin, tan

from symtop_ros.physics import Motion, State, Top
from symtop_ros.physics.reference import ClosedForm, Inputs, Series
from workshop.testset.exact import returning_series

FAMILIES = (
    "ordinary",
    "fast",
    "slow",
    "disc",
    "rod",
    "hanging",
    "upright",
    "critical",
    "pendulum",
    "weak weight",
    "weight below",
    "nearly regular",
    "upper pole",
    "lower pole",
    "separatrix of a pendulum",
    "separatrix of a spinning top",
)
PATH = Path(__file__).with_name("taylor_motions.json.xz")
STORED = json.loads(lzma.decompress(PATH.read_bytes()))
DIGITS, DIGITS_OF_GAP = 60, 45  # the second for gaps down to 1e-30


@dataclass(frozen=True)
class Case:
    """A top, a start, times in periods (in s if there is no period), and digits for the series."""

    moments: tuple[float, float, float]
    orientation: tuple[float, ...]
    omega: tuple[float, float, float]
    spans: tuple[float, ...]
    digits: int = DIGITS
    has_period: bool = True

    @property
    def inputs(self) -> Inputs:
        return Inputs.exact(*self.moments, self.orientation, self.omega)

    @property
    def series(self) -> Series:
        return returning_series(self.inputs, self.digits)

    @property
    def period(self) -> float:
        """Period of theta in s."""
        return float(ClosedForm(self.inputs, self.digits).period)

    @property
    def motion(self) -> Motion:
        return Motion(Top(*self.moments), State(self.orientation, self.omega))

    @property
    def times(self) -> list[float]:
        """The times in s."""
        unit = self.period if self.has_period else 1.0
        return [span * unit for span in self.spans]


def read_stored(data: dict) -> tuple[Top, State]:
    """The top and the start of a stored motion."""
    return Top(*data["moments"]), State(data["q0"], data["omega0"])


def make_case(family: str, seed: int) -> Case:
    rng = Numbers(f"{family} {seed}")
    spans = tuple(rng.choice([1, -1]) * rng.power(*each) for each in ((-3, 0), (0, 12)))
    if family == "separatrix of a pendulum":
        return _near_separatrix(rng, spans, 0.0)
    if family == "separatrix of a spinning top":
        return _near_separatrix(rng, spans, rng.uniform(0.1, 0.95) * rng.choice([1, -1]))
    Ix, pull = rng.power(-6, 1), rng.power(0, 3)
    ratio, tilt, across, spin = _choose(rng, family)
    if family == "weak weight":
        pull = rng.power(-30, -6)
    phi, psi = rng.uniform(-3, 3), rng.uniform(-3, 3)
    direction = rng.uniform(-3, 3)
    if family == "nearly regular":
        across = _regular_rate(ratio, tilt, spin) * sin(tilt)
        across *= 1 + rng.choice([1, -1]) * rng.power(-9, -1)
        direction = math.pi / 2 - psi
    if family.endswith("pole"):  # p_phi = p_psi or -p_psi, up to rounding
        side = 1 if family == "upper pole" else -1
        level = side * spin * ratio * tan(tilt / 2) ** side
        across, direction = hypot(level, across), atan2(level, across) - psi
    scale = math.sqrt(pull)
    omega = tuple(scale * rate for rate in (across * cos(direction), across * sin(direction), spin))
    sign = -1 if family == "weight below" else 1
    moments = (Ix, Ix * ratio, sign * Ix * pull)
    return Case(moments, _orientation(tilt, phi, psi), omega, spans)


def _regular_rate(ratio: float, tilt: float, spin: float) -> float:
    """The slow rate of regular precession at a given omega_z, if there is one."""
    half = ratio * spin / 2
    root = half * half - cos(tilt)
    return 1 / (half + math.sqrt(root)) if root > 0 else half


def _choose(rng: Numbers, family: str) -> tuple[float, ...]:
    """Iz/Ix, theta, and the rates across and along the axis in units of sqrt(Mgl/Ix)."""
    ratio, tilt = rng.uniform(0.1, 1.9), rng.uniform(0.05, 3.0)
    across, spin = rng.choice([0.0, rng.uniform(0, 3)]), rng.uniform(-6, 6)
    near, sign = rng.power(-9, -1), rng.choice([1, -1])
    sleeping = rng.uniform(2.5, 9) / ratio
    return {
        "disc": (rng.choice([2.0, 1.0, 1.0 + 1e-12, rng.uniform(1, 2)]), tilt, across, spin),
        "rod": (rng.uniform(0.03, 0.1), tilt, across, spin),
        "fast": (ratio, tilt, across, sign * rng.power(1, 2)),
        "slow": (ratio, tilt, across / 30, spin / 60),
        "hanging": (ratio, math.pi - near, near * across, sleeping),
        "upright": (ratio, near, near * across, sleeping),
        "critical": (0.5 + ratio / 2, near**0.5, 0.0, 2 / (0.5 + ratio / 2) * (1 + sign * near**2)),
        "pendulum": (ratio, tilt, across, 0.0),
        "weak weight": (ratio, tilt, sign * 1e6 * (0.1 + across), 1e6 * spin),
        "nearly regular": (ratio, tilt, 0.0, sleeping),
        "upper pole": (ratio, tilt, across, spin / 2),
        "lower pole": (ratio, tilt, across, spin / 2),
    }.get(family, (ratio, tilt, across, spin))


def _orientation(theta: float, phi: float, psi: float) -> tuple[float, ...]:
    c, s = cos(theta / 2), sin(theta / 2)
    plus, minus = (phi + psi) / 2, (phi - psi) / 2
    return (c * cos(plus), s * cos(minus), s * sin(minus), c * sin(plus))


def _near_separatrix(rng: Numbers, spans: tuple[float, ...], spin: float) -> Case:
    """A start with a gap of 1e-2 to 1e-30 on either side, as rounded, or exactly without."""
    side = rng.choice(["pushed", "let go", "thrown up", "exact"])
    digits = DIGITS + DIGITS_OF_GAP
    if side == "exact":  # doubles with few bits, of which no sum and no product is rounded
        across, up = rng.randint(1, 40) / 8, 0.0 if spin == 0 else rng.randint(-16, 16) / 8
        spans = tuple(rng.power(-3, 1.3) / hypot(across, up) for _ in range(2))
        moments = (1.0, 0.5, (across**2 + up**2) / 2)
        omega = (-across, up, 2 * up)
        return Case(moments, (0.5, 0.5, 0.5, 0.5), omega, spans, digits, has_period=False)
    ratio, angle = rng.uniform(0.2, 1.9), rng.uniform(-3, 3)
    gap = rng.power(-30, -2)
    omega_z = 2 * spin / ratio
    size = math.sqrt(gap)
    if side == "pushed":
        half = rng.uniform(-3, 3)
        q = (cos(half), 0.0, 0.0, sin(half))
        omega = (size * cos(angle), size * sin(angle), omega_z)
    elif side == "let go":
        q = _orientation(2 * asin(size), angle, 0.4)
        omega = (0.0, 0.0, omega_z)
    else:  # the doubles nearest to a start from which the axis comes to rest on top
        theta = rng.uniform(0.5, 3.0)
        p = omega_z * ratio * tan(theta / 2)
        theta_dot = -math.sqrt(max(0.0, 2 * (1 - cos(theta)) - p * p))
        psi = rng.uniform(-3, 3)
        c, s = cos(psi), sin(psi)
        q = _orientation(theta, angle, psi)
        omega = (p * s + theta_dot * c, p * c - theta_dot * s, omega_z)
    return Case((1.0, ratio, 1.0), q, omega, spans, digits)
