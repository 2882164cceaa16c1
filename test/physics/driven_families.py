"""Fourteen families of random tops under friction or an applied torque, with their starts."""

from __future__ import annotations

import math
from collections.abc import Sequence

from drawn import Numbers, hypot
from physics.tops import ARTICLE, series_of

from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.physics.values import Vector

FAMILIES = (
    "plain",
    "strong friction",
    "overdamped",
    "tiny and long",
    "fast spin",
    "vertical torque",
    "horizontal torque",
    "torque with friction",
    "torque without friction",
    "weightless",
    "sleepers",
    "rods",
    "mixed",
    "tumbling",
)
COUNT = 124  # cases of the report: nine of each family, eight of the last two
TINY = (1e-300, 1e-30, 1e-16, 1e-12, 1e-10, 1e-7, 1e-6)  # N m s, or shares of Ix swing
TILTS = (0.0, 1e-12, 1e-8, 1e-6, 1e-3, 1e-2, 0.1)  # rad


class DrivenCase:
    """A top, its start, what drives it, and two times in s."""

    def __init__(self, family: str, seed: int) -> None:
        self.family = family
        self.random = Numbers(f"{family} {seed}")
        self.torque: Vector = (0.0, 0.0, 0.0)
        self.friction = Friction()
        self.use_random_top()
        getattr(self, "_make_" + family.replace(" ", "_"))(seed)

    @property
    def times(self) -> tuple[float, float]:
        return self.t / 2, self.t

    @property
    def motion(self) -> Motion:
        return Motion(self.top, self.start, self.friction, self.torque)

    def solve(self):
        """Return the exact states at the two times."""
        return list(map(series_of(self.motion).at, self.times))

    def use_random_top(self) -> None:
        draw = self.random
        Ix = draw.power(-4, 1)
        weight = draw.choice([1, 1, 1, -1]) * draw.power(0.5, 3)
        self.set_top(Top(Ix, Ix * draw.uniform(0.05, 1.95), Ix * weight))
        self.use_random_start(spin=4.0)
        self.t = 20 / self.swing

    def set_top(self, top: Top) -> None:
        self.top, self.swing = top, math.sqrt(abs(top.Mgl) / top.Ix)

    def use_article(self, **rates: float) -> None:
        self.set_top(ARTICLE)
        self.start = State.from_euler(theta=0.5, psi_dot=200.0, **rates)

    def use_random_start(self, spin: float) -> None:
        """Rates of the order of the swing, and a spin momentum of so much times Ix swing."""
        draw, swing = self.random, self.swing
        self.start = State.from_euler(
            theta=draw.uniform(0.1, 3.0),
            phi=draw.uniform(-3, 3),
            psi=draw.uniform(-3, 3),
            theta_dot=swing * draw.gauss(0, 0.7),
            phi_dot=swing * draw.gauss(0, 0.7),
            psi_dot=swing * spin * draw.gauss(0, 1) * self.top.Ix / self.top.Iz,
        )

    def use_friction(self, axial: float, transverse: float) -> None:
        """Friction as shares of Iz swing and Ix swing."""
        self.friction = Friction(
            axial * self.top.Iz * self.swing, transverse * self.top.Ix * self.swing
        )

    def use_torque(self, axes: Sequence[int], share: float) -> None:
        """Components along these axes of up to a share of |Mgl|."""
        pull = share * abs(self.top.Mgl)
        x, y, z = (self.random.uniform(-pull, pull) if axis in axes else 0.0 for axis in range(3))
        self.torque = x, y, z

    def _make_plain(self, seed: int) -> None:
        self.use_article(
            theta_dot=self.random.choice([0.0, self.random.uniform(-9, 9)]),
            phi_dot=self.random.choice([0.0, 6.5, 69.8, self.random.uniform(-20, 75)]),
        )
        self.friction = Friction(1e-6, self.random.choice([1e-6, 1e-5]))
        self.t = 10.0

    def _make_strong_friction(self, seed: int) -> None:
        self.use_friction(self.random.uniform(0.2, 2), self.random.uniform(0.2, 2))

    def _make_overdamped(self, seed: int) -> None:
        strength = self.random.power(0.5, 2)
        self.use_friction(strength, strength * self.random.uniform(0.5, 2))

    def _make_tiny_and_long(self, seed: int) -> None:
        tiny = TINY[seed % len(TINY)]
        if tiny < 1e-8:
            self.use_article(phi_dot=self.random.choice([0.0, 3.0, 6.5, 9.0]))
            self.friction, self.t = Friction(tiny, tiny), 50.0
        else:
            self.use_friction(tiny, tiny)
            self.t = 1000 / self.swing

    def _make_fast_spin(self, seed: int) -> None:
        self.use_random_start(spin=40.0)
        self.use_friction(1e-3, 1e-2)
        self.t = 8 / self.swing

    def _make_vertical_torque(self, seed: int) -> None:
        if seed < 3:
            self.use_article(phi_dot=(0.0, 6.5, 20.0)[seed])
            self.t = 10.0
        self.use_torque([2], 0.1 if seed >= 3 else 0.005)

    def _make_horizontal_torque(self, seed: int) -> None:
        self.use_torque([0, 1], 0.1)

    def _make_torque_with_friction(self, seed: int) -> None:
        self.use_friction(self.random.uniform(0, 0.1), self.random.uniform(0, 0.1))
        self.use_torque([0, 1, 2], 0.1)

    def _make_torque_without_friction(self, seed: int) -> None:
        self.use_torque([0, 1, 2], 0.3)

    def _make_weightless(self, seed: int) -> None:
        Ix, Iz = self.top.Ix, self.top.Iz
        self.top, self.t = Top(Ix, Iz, 0.0), 10.0
        self.start = State(*self._draw_attitude(), [self.random.gauss(0, 10) for _ in range(3)])
        self.friction = Friction(self.random.uniform(0, 0.2) * Iz, self.random.uniform(0, 0.2) * Ix)
        if seed % 2:
            x, y, z = (self.random.gauss(0, 3) * Ix for _ in range(3))
            self.torque = x, y, z

    def _make_sleepers(self, seed: int) -> None:
        self.set_top(ARTICLE)
        spin = self.random.uniform(0.4, 2) * ARTICLE.critical_spin
        self.start = State.from_euler(theta=TILTS[seed % len(TILTS)], phi=0.3, psi_dot=spin)
        self.friction, self.t = Friction(1e-6, self.random.choice([1e-6, 1e-5])), 5.0

    def _make_rods(self, seed: int) -> None:
        Ix = self.random.power(-3, 0)
        ratio = self.random.power(-8, -1)
        self.set_top(Top(Ix, Ix * ratio, Ix * self.random.power(1, 2)))
        self.use_random_start(spin=min(4.0, 300 * ratio))
        self.use_friction(self.random.uniform(0, 0.05), self.random.uniform(0, 0.05))
        self.t = 10 / self.swing

    def _make_mixed(self, seed: int) -> None:
        self.use_random_start(spin=self.random.choice([0.3, 1, 5, 10]))
        self.use_friction(self.random.power(-6, 0), self.random.power(-6, 0))
        self.use_torque([axis for axis in range(3) if self.random.random() < 0.5], 0.2)

    def _make_tumbling(self, seed: int) -> None:
        size = self.swing * (1, 3, 10, 1)[seed % 4]
        omega = (self.random.gauss(0, size), self.random.gauss(0, size), 0.0)
        self.start = State(*self._draw_attitude(), omega)
        if seed % 4 == 3:
            self.use_torque([2], 0.05)
        else:
            self.use_friction(1e-3, self.random.choice([0.0, 1e-3]))

    def _draw_attitude(self) -> list[list[float]]:
        q = [self.random.gauss(0, 1) for _ in range(4)]
        return [[part / hypot(*q) for part in q]]


def list_cases() -> list[DrivenCase]:
    """Return the cases of the report."""
    return [DrivenCase(FAMILIES[n % 14], n // 14) for n in range(COUNT)]
