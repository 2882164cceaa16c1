"""Write problems.json.xz of truth/testset: seventy motions to 30 digits.

Each state is computed by the closed form in 80 digits, and again by a Taylor series in as many
that shares no formula with it; a difference in the 33rd digit ends the program. What follows from
the states is not packed: they get as many digits as the package takes for thirty of it. It takes
twelve minutes with two processors:

    python -m workshop.testset.write
"""

import lzma
import math
import sys
from multiprocessing import Pool
from typing import Any

from mpmath import mp, mpf

from symtop_ros.physics import DEFAULT_GRAVITY
from symtop_ros.physics.reference.series import Inputs
from symtop_ros.truth.testset.score import FILE, VERSION, read_problems
from symtop_ros.truth.testset.tables import FORCES, LIMITS, STATES, WORLD, complete, format_problems
from workshop.digits import ClosedForm, ExactState, Series
from workshop.testset.exact import DIGITS, distance, perturb, returning_series
from workshop.testset.links import find_link_effect
from workshop.testset.problems import SETTINGS, Setting

PACKED = FILE.with_suffix(".json.xz")
SHOWN = 30  # digits
AGREEMENT = mpf(10) ** -33  # of both methods, relative to the largest component
NOTHING = mpf(10) ** -60  # of the largest component: what 80 digits leave of a zero
EPS, EPS_32 = 2.0**-52, 2.0**-23  # of float64 and float32


def solve(setting: Setting) -> list[ExactState]:
    """States at the times of a problem, by both methods."""
    inputs = Inputs.of(setting.top, setting.start)
    motion = ClosedForm(inputs, DIGITS)
    series = returning_series(inputs, DIGITS) if setting.has_period else Series(inputs, DIGITS)
    states = [motion.at(t) for t in setting.times]
    for t, exact in zip(setting.times, states, strict=True):
        check(setting, t, exact, series)
    return states


def check(setting: Setting, t: float, exact: ExactState, series: Series) -> None:
    """End the program if the Taylor series has another state."""
    other = series.at(t)
    with mp.workdps(DIGITS):
        apart = distance(exact[0], other[0])
        size = mp.norm(exact[1])
        faster = mp.norm([a - b for a, b in zip(exact[1], other[1], strict=True)])
        if apart > AGREEMENT or faster > AGREEMENT * size:
            sys.exit(f"{setting.name} at {t} s: {mp.nstr(apart, 3)}, {mp.nstr(faster / size, 3)}")


def limits(setting: Setting, t: float, exact: ExactState, eps: float = EPS) -> tuple[float, float]:
    """Angle (rad) and rate (rad/s) by which half an ulp of every input changes a state."""
    inputs = Inputs.of(setting.top, setting.start)
    moved = [ClosedForm(each, DIGITS).at(t) for each in perturb(inputs, eps)]
    with mp.workdps(DIGITS):
        angle = mp.norm([4 * mp.asin(distance(exact[0], each[0]) / 2) for each in moved])
        rate = mp.norm([a - b for each in moved for a, b in zip(exact[1], each[1], strict=True)])
        # no state is held more exactly than its own rounding allows
        floor = eps / 2 * float(mp.norm(exact[1]))
        return min(max(float(angle), eps), math.pi), max(float(rate), floor)


def describe(setting: Setting) -> dict[str, Any]:
    """The entry of a problem, without what follows from its states."""
    states = solve(setting)
    pairs = [
        (*limits(setting, t, each), *limits(setting, t, each, EPS_32))
        for t, each in zip(setting.times, states, strict=True)
    ]
    shown = ([float(f"{x:.3g}") for x in column] for column in zip(*pairs, strict=True))
    return {
        **describe_inputs(setting),
        **pack(setting, states),
        **dict(zip(LIMITS, shown, strict=True)),
        "mujoco_urdf_effect": find_link_effect(setting),
    }


def describe_inputs(setting: Setting) -> dict[str, Any]:
    """Return what an entry says of the problem itself."""
    body = setting.body
    return {
        "name": setting.name,
        "level": setting.level,
        "what": setting.what,
        **dict(zip(("Ix", "Iz", "Mgl"), setting.top.moments, strict=True)),
        "mass": body.mass,
        "arm": body.arm,
        "Ix_centre": body.Ix,
        "orientation": setting.start.given_orientation.tolist(),
        "angular_velocity": setting.start.angular_velocity.tolist(),
        "times": setting.times,
    }


def pack(setting: Setting, states: list[ExactState]) -> dict[str, Any]:
    """Return the states with the fewest digits that give thirty of all that follows from them."""
    wanted = list_all(setting, states)
    if len(set(wanted["energies"])) > 1:
        sys.exit(f"{setting.name}: the energy changes")
    for count in range(SHOWN, DIGITS):
        if list_all(setting, states, count) == wanted:
            return write_states(states, count)
    sys.exit(f"{setting.name}: no number of digits gives thirty of all that follows")


def list_all(setting: Setting, states: list[ExactState], count: int = DIGITS) -> dict[str, Any]:
    """Return states, forces, and the world's view, from states with so many digits."""
    inputs = describe_inputs(setting) | write_states(states, count)
    found = complete(inputs, DEFAULT_GRAVITY)
    return {name: found[name] for name in (*STATES, *FORCES, *WORLD)}


def write_states(states: list[ExactState], count: int) -> dict[str, Any]:
    """Return the lists of orientations and angular velocities as texts."""
    columns = zip(*states, strict=True)
    return dict(zip(STATES, (digits(each, count) for each in columns), strict=True))


def digits(rows: Any, count: int) -> list[list[str]]:
    """Return a list of vectors as texts."""
    # The axial rate is a double; mpf() would round the others to the precision of the moment.
    exact = [[n if isinstance(n, mpf) else mpf(n) for n in row] for row in rows]
    least = NOTHING * max(abs(n) for row in exact for n in row)
    return [[mp.nstr(n if abs(n) > least else mpf(0), count) for n in row] for row in exact]


def read_effects() -> dict[str, float | None]:
    """The published effects of links: those near rounding depend on the processor."""
    return {name: each.facts["mujoco_urdf_effect"] for name, each in read_problems().items()}


def main() -> None:
    """Compute all problems, and pack them."""
    problems = []
    effects = read_effects()
    with Pool() as pool:
        for setting, problem in zip(SETTINGS, pool.imap(describe, SETTINGS), strict=True):
            name = setting.name
            problem["mujoco_urdf_effect"] = effects.get(name, problem["mujoco_urdf_effect"])
            problems.append(problem)
            print(setting.name, flush=True)
    text = format_problems(problems, DEFAULT_GRAVITY, VERSION)
    PACKED.write_bytes(lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME))


if __name__ == "__main__":
    main()
