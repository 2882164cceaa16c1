"""The lines before the rows of a table: names, units below them, and forms that have no names."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.truth.tables.cells import Row, is_missing, is_number, split_cells
from symtop_ros.truth.tables.iso import ISO

MOTIVE = "Format Version,"  # how exports of Motive begin, whose names stand in several lines
# Columns without names: EuRoC has ns, position, w, x, y, z, and more; TUM has s, position, x, y, z,
# w; KITTI has twelve numbers of a matrix, and no time.
EUROC, TUM, KITTI = 8, 8, 12
POSITION = ("tx", "ty", "tz")
OF_EUROC = ("timestamp [ns]", *POSITION, "qw", "qx", "qy", "qz")
OF_TUM = ("t", *POSITION, "qx", "qy", "qz", "qw")
OF_KITTI = tuple(
    name for row in "123" for name in (*(f"r{row}{k}" for k in "123"), f"t{'xyz'[int(row) - 1]}")
)
# What `ros2 topic echo --csv` writes of a message: the stamp in s and ns, the frame, and its
# numbers. By the number of cells: the type, and the names after the frame ("_": not read).
XYZ = ("x", "y", "z")
STAMP = ("header.stamp.sec", "header.stamp.nanosec", "header.frame_id")
TURN = tuple(f"orientation.{each}" for each in (*XYZ, "w"))
POSE = (*POSITION, *TURN)
TWIST = (*("_",) * 3, *(f"angular.{each}" for each in XYZ))
MANY = ("_",) * 36  # covariances


def _name_covariance(quantity: str) -> tuple[str, ...]:
    """Return names of a covariance, of which the first number may say that there is none."""
    return (f"{quantity}_covariance_0", *("_",) * 8)


IMU = tuple(
    name
    for quantity, parts in (
        ("orientation", TURN),
        *(
            (quantity, tuple(f"{quantity}.{each}" for each in XYZ))
            for quantity in ("angular_velocity", "linear_acceleration")
        ),
    )
    for name in (*parts, *_name_covariance(quantity))
)
ECHOES: dict[int, tuple[str, tuple[str, ...]]] = {
    len(STAMP) + len(names): (kind, names)
    for kind, names in (
        ("Vector3Stamped or PointStamped", XYZ),
        ("QuaternionStamped", TURN),
        ("TwistStamped", TWIST),
        ("PoseStamped", POSE),
        ("TransformStamped", ("_", *POSE)),
        ("Imu", IMU),
        ("PoseWithCovarianceStamped", (*POSE, *MANY)),
        ("Odometry", ("_", *POSE, *MANY, *TWIST, *MANY)),
    )
}
LONGEST_NANOSECONDS = 9  # digits


@dataclass(frozen=True)
class Form:
    """Names for the columns of a table that has none, and what they were taken from."""

    names: tuple[str, ...]
    note: str


def find_form(path: object, cells: Row, separator: str | None) -> Form | None:
    """Return column names for a table without names, from its first row; or None."""
    if found := _find_echo(cells):
        return found
    if not all(is_number(cell) for cell in cells):
        return None
    if len(cells) >= EUROC and cells[0].isdecimal() and separator == ",":
        note = "no names of columns: read as EuRoC's, timestamp (ns), position, w, x, y, z"
        return Form((*OF_EUROC, *("_",) * (len(cells) - EUROC)), note)
    if len(cells) == TUM:
        note = "no names of columns: read as TUM's, timestamp (s), position, x, y, z, w"
        return Form(OF_TUM, note)
    if len(cells) == KITTI + 1:
        note = "no names of columns: read as a time (s) and KITTI's poses, a matrix of 3 rows"
        return Form(("t", *OF_KITTI), note)
    if len(cells) == KITTI:
        raise RefusedError(f"{path} must have times, got poses of KITTI, which lack them")
    return None


def _find_echo(cells: Row) -> Form | None:
    if len(cells) not in ECHOES or not (cells[0].isdecimal() and cells[1].isdecimal()):
        return None
    if len(cells[1]) > LONGEST_NANOSECONDS or is_number(cells[2]):
        return None
    kind, names = ECHOES[len(cells)]
    note = f"no names of columns: read as ros2 topic echo --csv writes {kind}"
    return Form((*STAMP, *names), note)


def is_data(cells: Row) -> bool:
    """Return whether a line is a row of numbers; the first may be a time in ISO 8601."""
    filled = [cell for cell in cells if cell]
    return len(filled) > 1 and all(is_number(cell) or ISO.fullmatch(cell) for cell in filled)


def is_units(cells: Row, places: Sequence[int]) -> bool:
    """Return whether a row below the names has words in the columns of numbers."""
    some = [cells[place] for place in places if place < len(cells)]
    words = [cell for cell in some if not is_missing(cell)]
    return bool(words) and not any(is_number(cell) or ISO.fullmatch(cell) for cell in words)


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
