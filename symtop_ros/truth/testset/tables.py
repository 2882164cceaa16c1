"""Files made from the problems that the package keeps: the entries of problems.json, and tables.

The package keeps states, from which accelerations and forces follow. They have as many digits as
thirty take in all that is computed from them: more where terms cancel. `workshop.testset.write`
tries it with states of 150 digits. problems.csv, states.csv, forces.csv and world.csv repeat the
entries for spreadsheets and for languages without a reader of JSON.
"""

import csv
import io
import json
import lzma
from collections.abc import Callable, Iterable, Mapping, Sequence
from decimal import Context, Decimal, localcontext
from functools import cache
from itertools import chain
from typing import Any

from symtop_ros.base.arrays import multiply

CONSTANTS = ("Ix", "Iz", "Mgl", "mass", "arm", "Ix_centre")
QUATERNION = ("w", "x", "y", "z")
RATES = ("wx", "wy", "wz")
TURNED_COLUMNS = tuple(f"turned_{name}" for name in (*QUATERNION, *RATES))
LIMITS = tuple(
    f"{name}_limits{form}"
    for form in ("", "_float32")
    for name in ("orientation", "angular_velocity")
)
TABLES = ("problems.csv", "states.csv", "forces.csv", "world.csv")
Facts = Mapping[str, Any]  # an entry of problems.json
Row = tuple[Any, ...]
ColumnGroups = tuple[Iterable[Any], ...]  # the times, and at each time groups of texts
# Columns of forces.csv by their lists in problems.json; energies are one column.
FORCES = {
    "angular_accelerations": ("alpha_x", "alpha_y", "alpha_z"),
    "accelerations": ("ax", "ay", "az"),
    "pivot_forces": ("fx", "fy", "fz"),
    "energies": ("energy",),
}
# Columns of world.csv by their lists in problems.json; the attitude comes first.
WORLD = {
    "centre_positions": ("px", "py", "pz"),
    "centre_velocities": ("vx", "vy", "vz"),
    "world_angular_velocities": ("omega_x", "omega_y", "omega_z"),
}
STATES = ("orientations", "angular_velocities")
# The states of a body whose frame is turned against the principal axes, by this quaternion w, x, y,
# z from the frame to the axes, which is that of symtop_ros.run.models.
TURNED = tuple(f"turned_{name}" for name in STATES)
TURN = tuple(map(Decimal, ("0.7", "0.1", "0.5", "0.5")))
# Digits that are shown, and those with which they are computed.
ROUNDED, WORKING = Context(prec=30), Context(prec=80)
FIXED = Decimal("1e-9")  # smaller numbers are shown with an exponent
# A number is zero if it is so much smaller than the largest of its list: what the digits left of a
# sum that cancels. The smallest number left is 8e-25 of its list's largest.
ZERO = Decimal("1e-30")
Numbers = Sequence[Decimal]


@cache  # it takes 0.2 s
def unpack(data: bytes, version: str) -> str:
    """Return the text of problems.json from its packed form."""
    facts = json.loads(lzma.decompress(data))
    whole = [complete(each, facts["gravity"]) for each in facts["problems"]]
    return format_problems(whole, facts["gravity"], version)


def complete(facts: Mapping[str, Any], gravity: float) -> dict[str, Any]:
    """Return an entry with thirty digits of its states, and with all that follows from them.

    Newton's and Euler's equations; the lists that follow begin with the start.
    """
    lists: dict[str, Sequence[Numbers]] = {
        name: [[Decimal(x) for x in each] for each in facts[name]] for name in STATES
    }
    start = normalise(facts["orientation"]), [Decimal(x) for x in facts["angular_velocity"]]
    constants = [Decimal(facts[name]) for name in ("Ix", "Iz", "Mgl", "mass", "arm")]
    with localcontext(WORKING):
        moments = [start, *zip(*lists.values(), strict=True)]
        found = [_derive([*constants, Decimal(gravity)], *each) for each in moments]
        a, b, c, d = TURN
        rows = _rotation(a, -b, -c, -d)
        turned = [(multiply(q, TURN), _turn(rows, omega)) for q, omega in moments[1:]]
    lists |= dict(zip(TURNED, zip(*turned, strict=True), strict=True))
    lists |= {name: [each[k] for each in found] for k, name in enumerate((*FORCES, *WORLD))}
    shown: dict[str, Any] = {name: _show_all(rows) for name, rows in lists.items()}
    shown["energies"] = [energy for (energy,) in shown["energies"]]
    # In the order of problems.json: the problem, its states, what follows from them, the limits.
    entries = list(facts.items())
    place = list(facts).index(STATES[0])
    return dict([*entries[:place], *shown.items(), *entries[place + len(STATES) :]])


def _derive(constants: Numbers, q: Numbers, omega: Numbers) -> tuple[Numbers, ...]:
    """Return what follows from a state, in the order of FORCES and WORLD."""
    Ix, Iz, Mgl, mass, arm, gravity = constants
    rows = _rotation(*q)
    wx, wy, wz = omega
    gx, gy, gz = rows[2]  # the vertical, seen from the body
    alpha_x = ((Ix - Iz) * wy * wz + Mgl * gy) / Ix
    alpha_y = ((Iz - Ix) * wz * wx - Mgl * gx) / Ix
    # omega x p and alpha x p + omega x (omega x p), for p on the axis
    velocity = arm * wy, -arm * wx, Decimal()
    change = arm * (alpha_y + wx * wz), arm * (wy * wz - alpha_x), -arm * (wx * wx + wy * wy)
    x, y, z = acceleration = _turn(rows, change)
    return (
        (alpha_x, alpha_y, Decimal()),
        acceleration,
        (mass * x, mass * y, mass * (z + gravity)),
        ((Ix * (wx * wx + wy * wy) + Iz * wz * wz) / 2 + Mgl * gz,),
        [arm * row[2] for row in rows],
        _turn(rows, velocity),
        _turn(rows, omega),
    )


def _rotation(w: Decimal, x: Decimal, y: Decimal, z: Decimal) -> list[Numbers]:
    """Return the rows of the matrix from body to world."""
    return [
        (w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z),
    ]


def _turn(rows: Sequence[Numbers], vector: Numbers) -> Numbers:
    return [sum((a * b for a, b in zip(row, vector, strict=True)), Decimal()) for row in rows]


def normalise(numbers: Sequence[float]) -> Numbers:
    """Return the unit quaternion of four doubles."""
    with localcontext(WORKING):
        q = [Decimal(x) for x in numbers]
        norm = sum((x * x for x in q), Decimal()).sqrt()
        return [x / norm for x in q]


def _show_all(rows: Sequence[Numbers]) -> list[list[str]]:
    """Return a list of numbers with the digits of the set."""
    least = ZERO * max(abs(x) for row in rows for x in row)
    return [[show(x if abs(x) > least else Decimal()) for x in row] for row in rows]


def show(number: Decimal) -> str:
    """Return a number with the digits of the set."""
    rounded = ROUNDED.normalize(number)
    text = f"{rounded:{'f' if not rounded or abs(rounded) > FIXED else 'e'}}"
    return text if "." in text else f"{text}.0"


def format_problems(problems: Iterable[Facts], gravity: float, version: str) -> str:
    """Return the text of problems.json."""
    facts = {
        "name": "symtop_ros test set",
        "version": version,
        "license": "CC0-1.0",
        "gravity": gravity,
    }
    lines = ",\n".join(map(json.dumps, problems))
    return f'{json.dumps(facts)[:-1]}, "problems": [\n{lines}\n]}}\n'


def tabulate(problems: Sequence[Facts]) -> dict[str, str]:
    """Return the texts of the tables by the names of their files."""
    limits = (name.replace("limits", "limit") for name in LIMITS)
    tables = (
        _list_starts(problems),
        _list_rows(problems, (*QUATERNION, *RATES, *limits, *TURNED_COLUMNS), _list_states),
        _list_rows(problems, chain(*FORCES.values()), _list_forces),
        _list_rows(problems, (*QUATERNION, *chain(*WORLD.values())), _list_world),
    )
    return {name: _write_csv(rows) for name, rows in zip(TABLES, tables, strict=True)}


def _list_starts(problems: Sequence[Facts]) -> Iterable[Row]:
    start = [f"{name}0" for name in (*QUATERNION, *RATES)]
    yield ("name", "level", *CONSTANTS, *start, "duration", "mujoco_urdf_effect", "what")
    for each in problems:
        states = *each["orientation"], *each["angular_velocity"]
        values = *(each[key] for key in CONSTANTS), *states, each["times"][-1]
        effect = each["mujoco_urdf_effect"]
        shown = "" if effect is None else repr(effect)
        yield (each["name"], each["level"], *map(repr, values), shown, each["what"])


def _list_rows(
    problems: Sequence[Facts], names: Iterable[str], list_columns: Callable[[Facts], ColumnGroups]
) -> Iterable[Row]:
    """Yield the header, and for each time of each problem its name, the time and texts."""
    yield ("name", "t", *names)
    for each in problems:
        for t, *groups in zip(*list_columns(each), strict=True):
            yield (each["name"], repr(t), *chain(*groups))


def _list_states(facts: Facts) -> ColumnGroups:
    limits = zip(*(map(repr, facts[name]) for name in LIMITS), strict=True)
    states, turned = ([facts[name] for name in names] for names in (STATES, TURNED))
    return facts["times"], *states, limits, *turned


def _list_forces(facts: Facts) -> ColumnGroups:
    *vectors, energies = (facts[key] for key in FORCES)
    return (0.0, *facts["times"]), *vectors, ((energy,) for energy in energies)


def _list_world(facts: Facts) -> ColumnGroups:
    start = [show(x) for x in normalise(facts["orientation"])]
    return (0.0, *facts["times"]), (start, *facts["orientations"]), *(facts[key] for key in WORLD)


def _write_csv(rows: Iterable[Row]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
