"""Derivatives of a motion by its top and start: error and time, compared with heyoka.

heyoka integrates the variational equations of the quaternion and Euler's equations; the reference
was made by differences of motions with 70 digits.
"""

import json
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from timeit import repeat
from typing import Any, NamedTuple

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion, State, Top
from workshop.speed.conditions import describe_conditions
from workshop.speed.publish import format_table, group, write_results

FILE = Path(__file__).with_name("derivatives.json")
NAME = "derivatives"  # of the files, and of the section in the documentation
ROWS = (slice(0, 3), slice(3, 6))  # attitude, angular velocity
COLUMNS = (slice(0, 1), slice(1, 2), slice(2, 3), slice(3, 6), slice(6, 9))
RUNS = 15  # of which the median counts
TOLERANCE = 2.0**-52


class Case(NamedTuple):
    """A motion, and its Jacobians (6, 9) at times in s."""

    motion: Motion
    times: list[float]
    exact: Real


def read_case() -> Case:
    """Return the case of derivatives.json."""
    facts = json.loads(FILE.read_text(encoding="utf-8"))
    motion = Motion(Top(*facts["moments"]), State(facts["orientation"], facts["angular_velocity"]))
    return Case(motion, facts["times"], np.array(facts["jacobians"]))


def find_error(found: Real, exact: Real) -> float:
    """Return the largest error, as a part of the largest element of its block."""
    errors = [
        np.abs(found - exact)[rows, columns].max() / np.abs(exact[rows, columns]).max()
        for rows in ROWS
        for columns in COLUMNS
    ]
    return float(max(errors))


def derive_by_package(motion: Motion, t: float) -> Real:
    """Return the Jacobian of a new motion: nothing is known of it yet."""
    return Motion(motion.top, motion.start).jacobian(t)


class Variations:
    """The variational equations in heyoka, compiled once."""

    def __init__(self, motion: Motion) -> None:
        import heyoka as hy

        w, x, y, z, a, b, c = names = hy.make_vars(*"wxyzabc")
        Ix, Iz, Mgl = (hy.par[k] for k in range(3))
        rates = [
            (-x * a - y * b - z * c) / 2,
            (w * a + y * c - z * b) / 2,
            (w * b + z * a - x * c) / 2,
            (w * c + x * b - y * a) / 2,
            ((Ix - Iz) * b * c + 2 * Mgl * (y * z + w * x)) / Ix,
            ((Iz - Ix) * c * a - 2 * Mgl * (x * z - w * y)) / Ix,
            0.0 * a,
        ]
        arguments = hy.var_args.vars | hy.var_args.params
        system = hy.var_ode_sys(list(zip(names, rates, strict=True)), arguments, order=1)
        self._q = motion.start.orientation
        start = [*self._q.tolist(), *motion.start.angular_velocity.tolist()]
        moments = list(motion.top.moments)
        self._taylor = hy.taylor_adaptive(
            system, start, pars=moments, tol=TOLERANCE, compact_mode=True
        )
        self._start = self._taylor.state.copy()

    def derive(self, t: float) -> Real:
        """Return the Jacobian (6, 9) at a time in s."""
        self._taylor.time = 0.0
        self._taylor.state[:] = self._start
        self._taylor.propagate_until(t)
        state = self._taylor.state
        by = state[7:].reshape(7, 10)  # by q, omega and the moments
        # A small rotation d of the body changes q by (0, d)/2 on its right side.
        columns = np.hstack((by[:, 7:], by[:, :4] @ _turn(self._q) / 2, by[:, 4:7]))
        return np.vstack((2 * _turn(state[:4]).T @ columns[:4], columns[4:]))


def _turn(q: Real) -> Real:
    """Return the matrix (4, 3) of the product of q with a vector."""
    w, x, y, z = q
    return np.array([[-x, -y, -z], [w, -z, y], [z, w, -x], [-y, x, w]])


def compare_derivatives(folder: Path, docs: Path | None = None) -> None:
    """Write derivatives.md and derivatives.json."""
    case = read_case()
    programs: dict[str, Callable[[float], Real]] = {
        "symtop_ros, Motion.jacobian": partial(derive_by_package, case.motion)
    }
    if find_spec("heyoka"):
        programs["heyoka, variational equations"] = Variations(case.motion).derive
    entries = []
    for name, derive in programs.items():
        for t, exact in zip(case.times, case.exact, strict=True):
            seconds = float(np.median(repeat(partial(derive, t), number=1, repeat=RUNS)))
            error = find_error(derive(t), exact)
            entries.append({"program": name, "t": t, "error": error, "seconds": seconds})
    facts = {"conditions": describe_conditions("heyoka"), "entries": entries}
    write_results(NAME, facts, format_entries(facts), folder, docs)
    print(f"{folder / 'derivatives.md'} and derivatives.json")


def format_entries(facts: dict[str, Any]) -> str:
    """Return the table of a measurement: a row for each program, a column for each time."""
    entries: list[dict[str, Any]] = facts["entries"]
    times = list(dict.fromkeys(each["t"] for each in entries))
    rows = [
        [name, *(f"{each['error']:.0e}, {_round(1e3 * each['seconds']):g} ms" for each in own)]
        for name, own in group(entries, lambda each: each["program"]).items()
    ]
    table = format_table(["error, time", *(f"{t:g} s" for t in times)], rows)
    return f"{table}\n\n{facts['conditions']}."


def _round(value: float) -> float:
    """Return a number with two digits, of which %g then writes no exponent."""
    return float(f"{value:.2g}")
