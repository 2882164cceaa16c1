"""Time for many different motions: the package, and heyoka with parameters and batches."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics import Motion, State, Top, accelerated
from symtop_ros.report.peers import ALONE, CLOSED_FORM

SEED = 1
COMPARED = 64  # motions of which the errors are taken, against the closed form in Python alone
SLOW = 2000  # motions that a slow program is timed with
TOLERANCES = 1e-9, 2.0**-52


@dataclass(frozen=True)
class ManyCost:
    """Seconds for each of many motions, and the largest error in rad."""

    peer: str
    motions: int
    seconds: float
    error: float


@dataclass(frozen=True)
class Motions:
    """Tops with other weights, and starts with other spins and tilts."""

    top: Top
    start: State

    @classmethod
    def draw(cls, count: int) -> "Motions":
        """Return random motions about the article's cusps."""
        rng = np.random.default_rng(SEED)
        top = Top(0.000228, 0.0000572, 0.068 * rng.uniform(0.8, 1.2, count))
        tilt, spin = rng.uniform(0.2, 1.0, count), rng.uniform(150.0, 250.0, count)
        zero = np.zeros(count)
        q = np.stack([np.cos(tilt / 2), np.sin(tilt / 2), zero, zero], axis=1)
        return cls(top, State(q, np.stack([zero, zero, spin], axis=1)))

    def take(self, count: int) -> "Motions":
        """Return the first of the motions."""
        top = Top(*(each[:count] for each in map(np.asarray, self.top.moments)))
        q, omega = self.start.given_orientation[:count], self.start.angular_velocity[:count]
        return Motions(top, State(q, omega))


Program = Callable[[Motions, float], Real]  # the orientations (n, 4) at a time in s


def find_programs() -> list[tuple[str, Program]]:
    """Return the programs that can be measured, by name."""
    programs: list[tuple[str, Program]] = [(CLOSED_FORM, partial(compute, False))]
    if accelerated:
        programs.append((CLOSED_FORM + ALONE, partial(compute, True)))
    if find_spec("heyoka"):
        from symtop_ros.report.peers.heyoka_peer import prepare_batches

        for tolerance in TOLERANCES:
            name = f"heyoka, two constants, batches, tolerance {tolerance:.0e}"
            programs.append((name, prepare_batches(tolerance)))
    return programs


def compute(pure: bool, motions: Motions, t: float) -> Real:
    """Return the orientations from the package."""
    return Motion(motions.top, motions.start, pure=pure).at(t).orientation


def measure_many(name: str, program: Program, count: int, t: float) -> ManyCost:
    """Measure a program with a number of motions; slow ones with fewer."""
    if name != CLOSED_FORM:
        count = min(count, SLOW)
    motions = Motions.draw(count)
    compared = motions.take(COMPARED)
    program(compared, t)  # what is only done once is not measured
    began = time.perf_counter()
    program(motions, t)
    seconds = time.perf_counter() - began
    exact, found = compute(True, compared, t), program(compared, t)
    signs = np.sign((exact * found).sum(axis=1, keepdims=True))
    error = 2 * np.linalg.norm(exact - signs * found, axis=1).max()
    return ManyCost(name, count, seconds / count, float(error))
