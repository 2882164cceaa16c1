"""Names of the columns of tables, for all programs that read them, and their units.

They are names of our own tables and those that other tools write: EuRoC, TUM, PlotJuggler,
rostopic, Xsens, Motive, phyphox, Tracker.
"""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.physics import DEFAULT_GRAVITY
from symtop_ros.truth.tables.cells import Row, find_separator, split_cells

# A component of the quaternion is w, x, y, z alone or after one of these words: qw, q_RS_w []
# (EuRoC), pose.orientation.w, /top/imu/orientation/w (PlotJuggler).
QUATERNION = re.compile(
    r"((?:.*[._/ ])?(?:q|quat|quaternion|orientation|rotation|attitude)(?:_\w+?)?[._/ ]?|)([wxyz])"
)
# q0 to q3, Quat_q0 (Xsens): w first, as most have it.
NUMBERED = re.compile(r"((?:.*[._/ ])?)q_?([0-3])")
# wx, w_x, angular_velocity.x, gyroscope x (phyphox), gyr_x (Xsens), w_rs_s_x (EuRoC), and
# twist/angular/x (PlotJuggler)
RATES = re.compile(
    r"(measured_)?(?:w_?|(?:.*[._/ ])?"
    r"(?:angular_velocity|angular|gyroscope|gyro|gyr|w_rs_s)[._/ ]?)([xyz])"
)
# fx, acceleration x (phyphox), acc_x (Xsens), linear_acceleration/x (ROS), a_rs_s_x (EuRoC): all
# with gravity. phyphox's "linear acceleration x" is without, and is none of them.
FORCES = re.compile(
    r"(measured_)?(?:f_?|(?:.*[._/])?(?:linear_acceleration|specific_force|acc|a_rs_s)[._/]"
    r"|(?:acceleration|accelerometer)[._/ ])([xyz])"
)
TIMES = re.compile(
    r"(?:__|%)?(?:t|time|times|timestamp|time_?stamp|stamp|sec|secs|seconds|"
    r"(?:.*[._/ ])?header[._/ ]stamp)(?:_?(ns|us|ms|s))?"
)
# header.stamp.sec and header.stamp.nanosec (ROS 2), secs and nsecs (ROS 1)
WHOLE_SECONDS = re.compile(r"(|.*[._/ ])secs?")
NANOSECONDS = re.compile(r"(|.*[._/ ])(?:nanosecs?|nsecs?)")
AXIS = re.compile(r"(?:(?:.*[._/ ])?(?:axis|e|vector|point)[._/ ]?|)([xyz])")
ANGLES = {"theta": re.compile(r"theta|tilt|nutation"), "phi": re.compile(r"phi|precession|azimuth")}
POINT = re.compile(r"(?:pixel|px|point)?[._/ ]?([uvxy])")
TURNS = re.compile(r"(?:.*[._/ ])?(roll|pitch|yaw)(?:_(deg|rad))?")
MATRIX = re.compile(r"r([1-3])([1-3])")
SEC = re.compile(r"sec(?=$|\^|-|⁻)")
UNIT = re.compile(r"\s*[\[(]\s*([^\])]*?)\s*[\])]\s*$")
# Units of times, and of numbers, as `_shorten` leaves them.
SECONDS = {"s": 0, "ms": 3, "us": 6, "ns": 9}  # decimals of a second in the unit
TIME_UNITS = {
    **{name: name for name in SECONDS},
    **dict.fromkeys(("second", "seconds"), "s"),
    **dict.fromkeys(("millisecond", "milliseconds"), "ms"),
    **dict.fromkeys(("µs", "μs", "microsecond", "microseconds"), "us"),
    **dict.fromkeys(("ns", "nanosecond", "nanoseconds"), "ns"),
}
CLOCKS = ("utc", "iso", "unix", "epoch")  # words that say what a time is, and not its unit
UNSAID = ("", "1", "-")
FIRST = re.compile("_?0$")  # of the name of the first number of a covariance
DEGREE = math.pi / 180
ANGLE_UNITS = {
    **dict.fromkeys((*UNSAID, "rad", "radian", "radians"), 1.0),
    **dict.fromkeys(("deg", "degree", "degrees", "°", "º"), DEGREE),
    "mrad": 1e-3,
}
RATE_UNITS = {
    **dict.fromkeys((*UNSAID, "rad/s", "radians/s", "1/s", "rads^-1", "rads-1", "rads⁻¹"), 1.0),
    **dict.fromkeys(("deg/s", "degrees/s", "°/s", "º/s", "dps", "degs^-1", "deg"), DEGREE),
    "mrad/s": 1e-3,
    "rpm": math.pi / 30,
}
FORCE_UNITS = {
    **dict.fromkeys((*UNSAID, "m/s^2", "m/s2", "m/s/s", "m/s²", "ms^-2", "ms-2", "ms⁻²"), 1.0),
    **dict.fromkeys(("g", "gn"), DEFAULT_GRAVITY),
}


@dataclass(frozen=True)
class Head:
    """Names of columns in small letters, with their units in brackets or "".

    Attributes
    ----------
    path : object
        Name of the file, for refusals.
    names, units : tuple of str
    """

    path: object
    names: tuple[str, ...]
    units: tuple[str, ...]

    @classmethod
    def read(cls, path: object, cells: Row) -> "Head":
        """Return names without signs of comments and quotes, and their units."""
        names = [name.strip().strip('"') for name in cells]
        units = [found[1] if (found := UNIT.search(name)) else "" for name in names]
        return cls(
            path,
            tuple(UNIT.sub("", name).lower() for name in names),
            tuple(_shorten(unit) for unit in units),
        )

    @classmethod
    def of(cls, path: object, line: str) -> "Head":
        """Return the names of columns in a line; a comment sign is no name."""
        line = line.strip().lstrip("#").strip()
        return cls.read(path, split_cells(line, find_name_separator(line)))

    def take_units(self, cells: Row) -> "Head":
        """Return the head with the units of a row below the names."""
        said = [cell.strip().strip('"').strip("[]()") for cell in cells]
        said += [""] * (len(self.names) - len(said))
        units = (_shorten(new) or own for own, new in zip(self.units, said, strict=False))
        return Head(self.path, self.names, tuple(units))

    def find_factors(
        self, places: Sequence[int], units: Mapping[str, float], wanted: str
    ) -> tuple[float, ...]:
        """Return the factors of the units of columns, or refuse one that is not known."""
        for place in places:
            if self.units[place] not in units:
                name, unit = one_line(self.names[place]), one_line(self.units[place])
                raise RefusedError(f"{name} in {self.path} must be in {wanted}, got {unit}")
        return tuple(units[self.units[place]] for place in places)

    def refuse_twice(self, places: Sequence[int]) -> None:
        """Refuse columns that occur twice."""
        for place in places:
            if self.names.count(self.names[place]) > 1:
                raise RefusedError(
                    f"{self.path} must have each column once, got "
                    f"{one_line(self.names[place])} twice"
                )


def find_name_separator(line: str) -> str | None:
    """Return the separator of names; commas if a line has commas and semicolons."""
    return "," if "," in line and ";" not in line and "\t" not in line else find_separator(line)


def _shorten(unit: str) -> str:
    """Return a unit in small letters, without blanks, with s for sec."""
    return SEC.sub("s", unit.lower().replace(" ", "").replace("·", ""))


def find_flags(names: Row, places: Sequence[int]) -> tuple[int, ...]:
    """Return the places of numbers that say whether a quantity was measured.

    In sensor_msgs/Imu a covariance that begins with -1 says that there is none. Tables name its
    numbers orientation_covariance[0], _0 or 0.
    """
    wanted = {f"{names[place].rpartition('.')[0]}_covariance" for place in places}
    found: dict[str, int] = {}
    for place, name in enumerate(names):
        if (quantity := FIRST.sub("", name)) in wanted:
            found.setdefault(quantity, place)
    return tuple(found.values())


def find_times(head: Head) -> tuple[tuple[int, ...], str]:
    """Return the places of the time, or () if there is none, and its unit.

    There is one place, or two: of s and of ns. A stamp is preferred to seconds, and the stamp of a
    message to the time of its arrival. The unit is "" if the numbers have to show it.
    """
    pairs = [*_list_pairs(head.names)]
    if pairs:
        return max(pairs, key=lambda pair: "stamp" in head.names[pair[0]]), "s"
    times = [place for place, name in enumerate(head.names) if TIMES.fullmatch(name)]
    if not times:
        return (), ""
    stamps = [place for place in times if "stamp" in head.names[place]]
    place = (stamps or times)[0]
    return (place,), _find_unit(head, place)


def _list_pairs(names: Row) -> Iterator[tuple[int, int]]:
    whole = {
        found[1]: k for k, name in enumerate(names) if (found := WHOLE_SECONDS.fullmatch(name))
    }
    for place, name in enumerate(names):
        found = NANOSECONDS.fullmatch(name)
        if found and found[1] in whole:
            yield whole[found[1]], place


def _find_unit(head: Head, place: int) -> str:
    name, unit = head.names[place], head.units[place]
    found = TIMES.fullmatch(name)
    if unit and unit not in TIME_UNITS and not any(word in unit for word in CLOCKS):
        raise RefusedError(
            f"{one_line(name)} in {head.path} must be in {', '.join(SECONDS)}, got {one_line(unit)}"
        )
    if said := TIME_UNITS.get(unit) or (found[1] if found else ""):
        return said
    if name == "stamp":
        return "ns"
    return "" if "stamp" in name or name.startswith("%") else "s"


def find_turns(names: Row) -> list[int]:
    """Return the places of roll, pitch and yaw, or []."""
    places = {found[1]: k for k, name in enumerate(names) if (found := TURNS.fullmatch(name))}
    return [places[each] for each in ("roll", "pitch", "yaw")] if len(places) == 3 else []


def find_matrix(names: Row) -> list[int]:
    """Return the places of a rotation matrix by rows, or []."""
    places = [k for k, name in enumerate(names) if MATRIX.fullmatch(name)]
    return places if len(places) == 9 else []


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
