"""The tables of the test set, made from its problems.

problems.json says everything; problems.csv, states.csv, forces.csv and world.csv repeat it for
spreadsheets and for languages without a reader of JSON.
"""

import csv
import io
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain
from typing import Any

from symtop_ros.testset.packed import FORCES, STATES, TURNED, WORLD, normalise, show

VERSION = "5.0"
CONSTANTS = ("Ix", "Iz", "Mgl", "mass", "arm", "Ix_centre")
QUATERNION, RATES = ("w", "x", "y", "z"), ("wx", "wy", "wz")
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


def format_problems(problems: Iterable[Facts], gravity: float) -> str:
    """Return the text of problems.json."""
    facts = {
        "name": "symtop_ros test set",
        "version": VERSION,
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
        values = [each[key] for key in CONSTANTS]
        values += [*each["orientation"], *each["angular_velocity"], each["times"][-1]]
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
    attitudes = start, *facts["orientations"]
    return (0.0, *facts["times"]), attitudes, *(facts[key] for key in WORLD)


def _write_csv(rows: Iterable[Row]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
