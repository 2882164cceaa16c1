"""Names of the columns of tables, for all programs that read them, and the cells of a line.

They are names of our own tables and those that other tools write: EuRoC, TUM, PlotJuggler, Xsens,
Motive, phyphox, Tracker.
"""

import csv
import re
from collections.abc import Iterator, Sequence

from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError, one_line, plain

SEPARATORS = (",", ";", "\t")  # else any white space
# A component of the quaternion is w, x, y, z alone or after one of these words: qw, q_RS_w []
# (EuRoC), pose.orientation.w, /top/imu/orientation/w (PlotJuggler).
QUATERNION = re.compile(
    r"((?:.*[._/ ])?(?:q|quat|quaternion|orientation|rotation|attitude)(?:_\w+?)?[._/ ]?|)([wxyz])"
)
# q0 to q3, Quat_q0 (Xsens): w first, as most have it.
NUMBERED = re.compile(r"((?:.*[._/ ])?)q_?([0-3])")
# wx, w_x, angular_velocity.x, gyroscope x (phyphox), gyr_x (Xsens), w_rs_s_x (EuRoC)
RATES = re.compile(
    r"(measured_)?(?:w_?|(?:.*[._/ ])?(?:angular_velocity|gyroscope|gyro|gyr|w_rs_s)[._/ ]?)([xyz])"
)
# fx, acceleration x (phyphox), acc_x (Xsens), linear_acceleration/x (ROS), a_rs_s_x (EuRoC): all
# with gravity. phyphox's "linear acceleration x" is without, and is none of them.
FORCES = re.compile(
    r"(measured_)?(?:f_?|(?:.*[._/])?(?:linear_acceleration|specific_force|acc|a_rs_s)[._/]"
    r"|(?:acceleration|accelerometer)[._/ ])([xyz])"
)
TIMES = re.compile(
    r"(?:__)?(?:t|time|times|timestamp|time_?stamp|stamp|sec|secs|seconds)(?:_?(ns|us|ms|s))?"
)
AXIS = re.compile(r"(?:(?:.*[._/ ])?(?:axis|e)[._/ ]?|)([xyz])")
ANGLES = {"theta": re.compile(r"theta|tilt|nutation"), "phi": re.compile(r"phi|precession|azimuth")}
POINT = re.compile(r"(?:pixel|px|point)?[._/ ]?([uvxy])")
TURNS = re.compile(r"(?:.*[._/ ])?(roll|pitch|yaw)(?:_(?:deg|rad))?")
DEGREES = ("deg", "degree", "degrees", "°", "deg/s", "°/s", "dps")
MOTIVE = "Format Version,"  # how exports of Motive begin, whose names stand in several lines
UNIT = re.compile(r"\s*[\[(]\s*([^\])]*?)\s*[\])]\s*$")
Row = Sequence[str]


def find_separator(line: str) -> str | None:
    """Return what separates the cells of a line; None for white space."""
    return next((each for each in SEPARATORS if each in line), None)


def split_cells(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line."""
    if separator is None:
        return line.split()
    (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
    return [cell.strip() for cell in cells]


def split_names(line: str) -> list[str]:
    """Return the names of columns; a comment sign is no name."""
    line = line.strip().lstrip("#").strip()
    return split_cells(line, find_separator(line))


def split_units(head: Row) -> tuple[list[str], list[str]]:
    """Return the names of columns in small letters, and their units in brackets or ""."""
    names = [UNIT.sub("", name.strip().strip('"')).lower() for name in head]
    units = [found[1].lower() if (found := UNIT.search(name)) else "" for name in head]
    return names, units


def join_names(path: object, numbered: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """Yield numbered lines; of Motive's export the lines of names as one, NAME.rotation.x.

    Its first line has pairs of words, then there are lines for the type, the name and the identity
    of each column, for rotation or position, and at last Frame, Time (Seconds), X, Y, Z, W.
    """
    first = next(numbered, None)
    if first is None:
        return
    if not first[1].startswith(MOTIVE):
        yield first
        yield from numbered
        return
    said = split_cells(first[1], ",")
    kind = dict(zip(said[::2], said[1::2], strict=False)).get("Rotation Type", "Quaternion")
    if kind != "Quaternion":
        raise RefusedError(f"{path} must have the rotation type Quaternion, got {one_line(kind)}")
    above: list[list[str]] = []
    for number, line in numbered:
        cells = split_cells(line, ",")
        if cells[0].lower() == "frame":
            yield number, ",".join(_name_columns(above, cells))
            break
        above.append(cells)
    yield from numbered


def _name_columns(above: Sequence[list[str]], axes: list[str]) -> Iterator[str]:
    """Yield a name of each column of Motive: frame, time, and e.g. top.rotation.x."""
    names = next((row for row in above if "Name" in row[:2]), above[1] if len(above) > 1 else [])
    parts = above[-1] if above else []
    for place, axis in enumerate(axes):
        words = [row[place] for row in (names, parts) if 1 < place < len(row) and row[place]]
        yield ".".join([*words, axis]).replace(",", "_").replace('"', "")


def find_turns(names: Row) -> list[int]:
    """Return the places of roll, pitch and yaw, or []."""
    places = {found[1]: k for k, name in enumerate(names) if (found := TURNS.fullmatch(name))}
    return [places[each] for each in ("roll", "pitch", "yaw")] if len(places) == 3 else []


def describe_empty(count: int) -> Iterator[str]:
    """Yield that rows were left out, if there were any."""
    if count:
        rows = f"{write_count(count, 'row')} {'has' if count == 1 else 'have'}"
        yield f"{rows} an empty cell: left out"


def is_number(text: str) -> bool:
    """Return whether a cell is a number."""
    try:
        float(plain(text))
    except ValueError:
        return False
    return True


def choose_time(names: Row, times: Sequence[int]) -> int:
    """Return the place of the time: a stamp, if there are seconds as well."""
    stamps = [place for place in times if "stamp" in names[place]]
    return (stamps or [*times])[0]


def find_unit(name: str, unit: str, units: Sequence[str]) -> str:
    """Return the unit of a time by what its name says; "" if the numbers have to show it."""
    found = TIMES.fullmatch(name)
    said = unit if unit in units else found[1] if found else ""
    if said:
        return said
    if name == "stamp":
        return "ns"
    return "" if "stamp" in name else "s"


def find_quaternions(names: Row) -> dict[str, dict[str, int]]:
    """Return the places of complete quaternions by the words before their components.

    If there is a bare w, x, y, z it is the only one.
    """
    groups: dict[str, dict[str, int]] = {}
    for place, name in enumerate(names):
        if found := QUATERNION.fullmatch(name):
            groups.setdefault(found[1], {}).setdefault(found[2], place)
        elif found := NUMBERED.fullmatch(name):
            groups.setdefault(found[1] + "q", {}).setdefault("wxyz"[int(found[2])], place)
    whole = {word: places for word, places in groups.items() if len(places) == 4}
    return {"": whole[""]} if "" in whole else whole


def find_rates(
    names: Row, words: Sequence[str] = ("",), pattern: re.Pattern[str] = RATES
) -> list[int]:
    """Return the places of an angular velocity after the first of some words, or [].

    top_imu writes the exact one and what was measured, as measured_wx, into one table.
    """
    groups: dict[str, dict[str, int]] = {}
    for place, name in enumerate(names):
        if found := pattern.fullmatch(name):
            groups.setdefault(found[1] or "", {}).setdefault(found[2], place)
    for word in words:
        places = groups.get(word, {})
        if len(places) == 3:
            return [places[each] for each in "xyz"]
    return []


def refuse_twice(path: object, names: Row, places: Sequence[int]) -> None:
    """Refuse columns that are there twice."""
    for place in places:
        if names.count(names[place]) > 1:
            raise RefusedError(
                f"{path} must have each column once, got {one_line(names[place])} twice"
            )
