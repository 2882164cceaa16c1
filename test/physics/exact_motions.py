"""Motions with exact states: every hard case, and tops of many families, in one table.

    PYTHONPATH=.:test python test/physics/exact_motions.py

computes all states of exact_motions.json.xz anew from its inputs by the reference, which takes some
minutes. A new case is a row with inputs and times alone. Inputs are hexadecimal doubles, taken as
exact; states are (w, x, y, z) up to sign and the angular velocity in the body, to 25 digits.
"""

import json
import lzma
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

from mpmath import mp, mpf

from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.physics.reference.series import Inputs
from workshop.digits import ClosedForm, ExactState, Series
from workshop.testset.exact import distance

PATH = Path(__file__).with_name("exact_motions.json.xz")
DIGITS = 25  # that are written
# With so many the closed form is computed, and with more until two states agree: of two starts that
# differ by 1e-30 a hundred digits are lost in 1e12 periods.
WORKING = (60, 100, 160, 260, 400)
SHIFT = 2.0**-30  # of an angular velocity: small, and far above rounding


class ExactMotion:
    """A motion, the times in s, and its row of the table."""

    def __init__(self, row: dict[str, Any]) -> None:
        self.row = row
        self.family = str(row["family"])
        names = "top", "q", "omega", "friction", "torque", "t"
        parts = (list(map(float.fromhex, row[name])) for name in names)
        top, q, omega, friction, torque, times = parts
        self.motion = Motion(Top(*top), State(q, omega), Friction(*friction), torque)
        self.inputs = Inputs.exact(*top, q, omega)
        self.times = times

    @property
    def states(self) -> list[ExactState]:
        """The exact states at the times."""
        with mp.workdps(DIGITS + 5):
            rows = [tuple(map(mpf, row)) for row in self.row["states"]]
        return [ExactState(row[:4], row[4:]) for row in rows]

    def series(self, digits: int, inputs: Inputs | None = None) -> Series:
        """Return the Taylor series of the motion, or of its top and drive from other inputs."""
        friction = self.motion.friction
        coefficients = friction.axial, friction.transverse
        return Series(inputs or self.inputs, digits, coefficients, self.motion.applied_torque)

    def solve(self) -> dict[str, Any]:
        """Return the row with what follows from its inputs."""
        found = self._solve_driven() if self.motion.is_driven else self._solve()
        return {**self.row, **found}

    def _solve_driven(self) -> dict[str, Any]:
        states = list(map(self.series(42).at, self.times))
        shifted = tuple(each * (1 + Fraction(SHIFT)) for each in self.inputs.angular_velocity)
        other = self.series(42, self.inputs._replace(angular_velocity=shifted))
        pairs = zip(states, map(other.at, self.times), strict=True)
        growth = [float(distance(a.orientation, b.orientation)) / SHIFT for a, b in pairs]
        return {"states": list(map(write_state, states)), "growth": growth}

    def _solve(self) -> dict[str, Any]:
        found: list[tuple[list[ExactState], list[Any]]] = []
        for digits in WORKING:
            exact = ClosedForm(self.inputs, digits)
            rates = list(exact.mean_rates) if mp.isfinite(exact.period) else []
            found.append((list(map(exact.at, self.times)), rates))
            before = found[-2:-1]
            if all(rates) and any(
                agree(old, found[-1][0]) and all(map(is_same, of, rates)) for old, of in before
            ):
                break
        else:
            rates = []  # zero but for rounding, as those of a pendulum
        assert agree(found[-2][0], found[-1][0]), self.row
        return {
            "states": list(map(write_state, found[-1][0])),
            "largest": find_largest(self.inputs, exact).hex(),
            "period": write(exact.period),
            "rates": list(map(write, rates)),
        }


def agree(some: list[ExactState], others: list[ExactState], digits: int = DIGITS + 2) -> bool:
    """Return whether states are the same to so many digits of their sizes."""
    parts = [pair for both in zip(some, others, strict=True) for pair in zip(*both, strict=True)]
    with mp.workdps(40):
        apart = [(mp.norm([a - b for a, b in zip(*pair, strict=True)]), pair[1]) for pair in parts]
        return all(off <= mpf(10) ** -digits * mp.norm(part) for off, part in apart)


def is_same(one: Any, other: Any) -> bool:
    """Return whether two numbers are the same to the digits that are written, and two more."""
    with mp.workdps(40):
        return bool(abs(one - other) <= mpf(10) ** (-DIGITS - 2) * abs(other))


def find_largest(inputs: Inputs, exact: ClosedForm) -> float:
    """Return the largest |omega_xy| of a motion, in rad/s: where the centre of mass is lowest."""
    squared = sum(mpf(each) ** 2 for each in inputs.angular_velocity[:2])
    if nutation := exact._nutation:
        squared -= nutation.beta * nutation.s[0]  # the lowest point, measured from the start
    return float(mp.sqrt(squared))


def write_state(state: ExactState) -> list[str]:
    return [write(each) for part in state for each in part]


def write(number: Any) -> str:
    return str(mp.nstr(number, DIGITS))


@cache
def read_motions() -> list[ExactMotion]:
    return list(map(ExactMotion, json.loads(lzma.decompress(PATH.read_bytes()))))


def main() -> None:
    rows = [json.dumps(each.solve()) for each in read_motions()]
    text = "[\n" + ",\n".join(rows) + "\n]\n"
    PATH.write_bytes(lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME))


if __name__ == "__main__":
    main()
