"""Score a trajectory against a problem of the test set. This file needs NumPy only.

    python score.py                          # lists the problems
    python score.py cusps trajectory.csv     # scores a trajectory
    python score.py cusps.turned turned.csv  # the same problem, another description of the body
    python score.py cusps trajectory.csv --json --max-error 1e-6  # for continuous integration

A trajectory is a table with the columns t, w, x, y, z, and wx, wy, wz if it has angular velocities
in the body frame, or omega_x, omega_y, omega_z in the world frame, in any order. Commas,
semicolons, tabs or spaces separate columns. A row at t = 0 is compared with the start as it was
given. Further columns, and rows at times that the problem does not have, are ignored. A line before
the names of the columns may say what computed it, so that the score can be cited:

    # engine: MuJoCo 4.0.0, RK4, step 1e-4 s
"""

from __future__ import annotations

import argparse
import json
import platform
import sys
from array import array
from bisect import bisect
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Problem", "Score", "read_problems", "read_trajectory", "score_trajectory"]

VERSION = "6.2"  # of the test set
FILE = Path(__file__).with_name("problems.json")
PACKED = ".json.xz"  # of the same file in the package, which writes the set from it
QUATERNION = ("w", "x", "y", "z")
RATES = ("wx", "wy", "wz")
WORLD_RATES = ("omega_x", "omega_y", "omega_z")
BOM = "\xef\xbb\xbf"  # of UTF-8, as Latin-1 reads it
# Descriptions of the body: in a turned frame, with a full tensor or with moments in an inertial
# frame; in a frame with its origin off the pivot; with all or half of the mass in a fixed child.
DESCRIPTIONS = ("turned", "inertial", "offset", "nested", "nested_half")
# One problem also has its body in other forms of the formats. README.md has a table of them.
FORMED = "cusps"
TURNED_FORMS = (
    *("euler", "degrees", "axisangle", "xyaxes", "zaxis", "quaternion"),
    *("solid", "ends", "inferred", "classes", "units"),
)
FORMS = (*TURNED_FORMS, "frames", "submodel")
# The states of these are in the turned frame, those of the others in the frame of the problem.
TURNED = ("turned", "inertial", *TURNED_FORMS)
# The rotation of a turned frame to the principal axes.
TURN = (0.7, 0.1, 0.5, 0.5)
SEPARATORS = (",", ";", "\t")  # else any white space
LARGEST_NORM_ERROR = 0.01  # of a quaternion; a larger one is no error of a motion
# A row belongs to a time if it is this close to it, relatively: a clock that adds up its steps.
SAME_TIME = 1e-9
# A row at t = 0 agrees with the start, or with what a mistake makes of it, within this: in rad, and
# relative to the rate. It may be rounded to single precision, or to a few digits.
SAME_START = 1e-4
LARGEST_FILE = 2**30  # bytes
LARGEST_NUMBER = 1e100  # beyond it squares overflow
SHOWN = 60  # characters of a header or row in a message, and of the name of an engine
COMMENT, ENGINE = "#", "engine:"  # of lines before the header
OF_A_PROBLEM = b'"orientation_limits"'  # in its JSON file, and in no other of its folder
SHORT = 12  # digits of a digest that a line shows
Real = NDArray[np.float64]


@dataclass(frozen=True)
class Problem:
    """A motion to compute.

    Attributes
    ----------
    facts : dict
        The entry in problems.json; README.md explains it.

    Examples
    --------
    >>> cusps = read_problems()["cusps"]
    >>> cusps.facts["Mgl"], cusps.times.tolist()[-1]
    (0.068, 10.0)
    """

    facts: dict[str, Any]

    @property
    def times(self) -> Real:
        """Times of the exact states, (20,), in s."""
        return np.asarray(self.facts["times"], dtype=np.float64)

    def format_json(self) -> str:
        """Return the problem and its solution as JSON, with a line for each quantity.

        Examples
        --------
        >>> print(read_problems()["cusps"].format_json().splitlines()[1])
         "name": "cusps",
        """
        lines = [f' "{key}": {json.dumps(value)}' for key, value in self.facts.items()]
        return "{\n" + ",\n".join(lines) + "\n}\n"

    def score(self, orientations: ArrayLike, angular_velocities: ArrayLike | None = None) -> Score:
        """Return the errors of states at the times of the problem.

        Parameters
        ----------
        orientations : array_like (20, 4)
            Quaternions w, x, y, z, body to world, of either sign; they are normalised.
        angular_velocities : array_like (20, 3), optional
            In the body frame, in rad/s.

        Raises
        ------
        ValueError
            If a shape does not fit, a number is not finite, or a norm is not near 1.

        Examples
        --------
        >>> cusps = read_problems()["cusps"]
        >>> rounded = [[float(c) for c in q] for q in cusps.facts["orientations"]]
        >>> bool(cusps.score(rounded).angles.max() < 4.5e-16)
        True
        """
        q = _check("orientations", orientations, 4)
        norms = np.linalg.norm(q, axis=1)
        worst = norms[np.abs(norms - 1).argmax()]
        if abs(worst - 1) > LARGEST_NORM_ERROR:
            raise ValueError(f"orientations must be unit quaternions, got a norm of {worst:.6g}")
        q = q / norms[:, np.newaxis]
        angles = measure_angles(q, *split_decimals(self.facts["orientations"]))
        if angular_velocities is None:
            return Score(self, angles, None)
        omega = _check("angular_velocities", angular_velocities, 3)
        high, low = split_decimals(self.facts["angular_velocities"])
        return Score(self, angles, np.linalg.norm((omega - high) - low, axis=1))


@dataclass(frozen=True)
class Score:
    """Errors at the times of a problem.

    Attributes
    ----------
    problem : Problem
    angles : ndarray (20,)
        Angle in rad of the rotation that would correct the attitude.
    rates : ndarray (20,) or None
        |omega - omega_exact| in rad/s.
    start : str
        Sentence on the difference of the row at t = 0 from the start; empty without a difference or
        without such a row.
    engine : str
        Program that computed the trajectory, as stated in its file; empty if not stated.
    """

    problem: Problem
    angles: Real
    rates: Real | None
    start: str = ""
    engine: str = ""

    @property
    def in_limits(self) -> Real:
        """Errors of the attitude in limits of double precision, (20,)."""
        return self._divide("orientation_limits")

    @property
    def in_float32_limits(self) -> Real:
        """Errors of the attitude in limits of single precision, (20,)."""
        return self._divide("orientation_limits_float32")

    def _divide(self, limits: str) -> Real:
        return np.asarray(self.angles / np.array(self.problem.facts[limits]), dtype=np.float64)

    def facts(self) -> dict[str, Any]:
        """Return the score as numbers, for JSON; errors are those at the times of the problem."""
        facts = self.problem.facts
        return {
            "problem": facts["name"],
            "level": facts["level"],
            "max_error": float(self.angles.max()),
            "limits": float(self.in_limits.max()),
            "float32_limits": float(self.in_float32_limits.max()),
            "times": facts["times"],
            "errors": self.angles.tolist(),
            "rate_errors": None if self.rates is None else self.rates.tolist(),
            "start": self.start,
            "engine": self.engine or None,
        }

    def format(self) -> str:
        """Return the score in a line.

        Examples
        --------
        >>> cusps = read_problems()["cusps"]
        >>> cusps.score([cusps.facts["orientation"]] * 20).format()[:50]
        'cusps: attitude 2.1e+00 rad at most (mean 1.2e+00)'
        """
        rates = self.rates
        return (
            f"{self.problem.facts['name']}: attitude {self.angles.max():.1e} rad at most "
            f"(mean {self.angles.mean():.1e}), {self.in_limits.max():.2g} limits "
            f"({self.in_float32_limits.max():.2g} of float32)"
            f"{'' if rates is None else f'; angular velocity {rates.max():.1e} rad/s at most'}"
            f"{self.start and f'; {self.format_start()}'}"
        )

    def format_start(self) -> str:
        """Return a sentence on how the row at t = 0 differs from the start."""
        return f"the row at t = 0 is not the start: {self.start}"


def read_problems(path: Path = FILE) -> dict[str, Problem]:
    """Return the problems by their names.

    If `path` does not exist, its packed form is read (the package has only this form). Without a
    packed form, the JSON files of problems in the same folder are read, as in the folder of a
    copied problem.

    Examples
    --------
    >>> len(read_problems())
    70
    """
    found: list[dict[str, Any]] = []
    for text in _read_texts(path).values():
        facts = json.loads(text)
        found += facts.get("problems", [facts])
    return {each["name"]: Problem(each) for each in found}


def describe_testset(path: Path = FILE) -> dict[str, Any]:
    """Return the version of the test set, and the SHA-256 of its problems by the names of files.

    Examples
    --------
    >>> [*describe_testset()["sha256"]]
    ['problems.json']
    """
    texts = _read_texts(path).items()
    return {"version": VERSION, "sha256": {name: sha256(text).hexdigest() for name, text in texts}}


def describe_platform() -> dict[str, str]:
    """Return where a score is computed: system, machine, and versions of Python and NumPy.

    Examples
    --------
    >>> [*describe_platform()]
    ['system', 'machine', 'python', 'numpy']
    """
    return {
        "system": platform.system(),
        "machine": platform.machine(),
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


def format_citation(program: str, testset: dict[str, Any]) -> str:
    """Return the line that cites a score: the test set, the scorer and the platform.

    Examples
    --------
    >>> format_citation("score.py", describe_testset()).partition(" (")[0] == f"test set {VERSION}"
    True
    """
    files = ", ".join(f"{name} {digest[:SHORT]}" for name, digest in testset["sha256"].items())
    place = describe_platform()
    return (
        f"test set {testset['version']} (SHA-256: {files}), scored by {program} "
        f"on {place['system']} {place['machine']}, Python {place['python']}, NumPy {place['numpy']}"
    )


def format_engine(engine: str) -> str:
    """Return the line that names the engine, or how the file can name it."""
    return (
        f"engine: {engine or 'not stated; a first line such as # engine: MuJoCo 4.0.0 states it'}"
    )


def _read_texts(path: Path) -> dict[str, bytes]:
    """Return the contents of problems.json, or of the files of copied problems, by their names."""
    packed = path.with_suffix(PACKED)
    if path.exists():
        return {path.name: path.read_bytes()}
    if packed.exists():
        from symtop_ros.truth.testset.tables import unpack  # a copy of this file has no package

        return {path.name: unpack(packed.read_bytes(), VERSION).encode()}
    texts = {each.name: each.read_bytes() for each in sorted(path.parent.glob("*.json"))}
    return {name: text for name, text in texts.items() if OF_A_PROBLEM in text}


def read_trajectory(path: Path, problem: Problem) -> tuple[Real, Real | None]:
    """Return the orientations (20, 4) and body angular velocities (20, 3) of a table.

    Parameters
    ----------
    path : Path
    problem : Problem
        Gives the times; each must be in the file.

    Raises
    ------
    ValueError
        If a column, a time or a number is missing.
    OSError
        If the file cannot be read.
    """
    q, rates, _ = _read_states(path, problem)
    return q[1:], None if rates is None else rates[1:]


def score_trajectory(path: Path, problem: Problem) -> Score:
    """Return the score of a table, with what is wrong with its row at t = 0, if it has one.

    Raises
    ------
    ValueError, OSError
        As `read_trajectory`.
    """
    q, rates, engine = _read_states(path, problem)
    score = problem.score(q[1:], None if rates is None else rates[1:])
    start = describe_start(problem, q[0], None if rates is None else rates[0])
    return replace(score, start=start, engine=engine)


def describe_start(problem: Problem, q: Real, rates: Real | None) -> str:
    """Return how a state (4,), (3,) at t = 0 differs from the start; empty if it does not.

    It may be nan: there is no such state.
    A mistake is named if the state is what it makes of the start, and nothing else is.

    Examples
    --------
    >>> problem = read_problems()["cusps"]
    >>> w, x, y, z = problem.facts["orientation"]
    >>> describe_start(problem, np.array([w, x, y, z]), None)
    ''
    >>> describe_start(problem, np.array([w, -x, -y, -z]), None)
    'its attitude is the conjugate'
    """
    given, omega = (np.array(problem.facts[name]) for name in ("orientation", "angular_velocity"))
    unit = given / np.linalg.norm(given)
    w, x, y, z = unit
    body = turn_to_body(unit[np.newaxis], omega[np.newaxis])[0]
    world = turn_to_body(np.array([[w, -x, -y, -z]]), omega[np.newaxis])[0]
    attitudes = {
        "the conjugate": np.array([w, -x, -y, -z]),
        "that of w, x, y, z read as x, y, z, w": np.array([z, w, x, y]),
        "that of x, y, z, w read as w, x, y, z": np.array([x, y, z, w]),
        "none": np.array([1.0, 0.0, 0.0, 0.0]),
    }
    turning = {
        "that of the world frame": world,
        "that of rates of the body taken for those of the world": body,
        "in deg/s": np.degrees(omega),
        "that of rad/s taken for deg/s": np.radians(omega),
        "zero": np.zeros(3),
    }
    texts = [_name_mistake("its attitude is", _measure_turn, q, unit, attitudes, 1.0)]
    if rates is not None:
        size = float(np.linalg.norm(omega))
        words = "its angular velocity is"
        texts.append(_name_mistake(words, _measure_change, rates, omega, turning, size))
    return " and ".join(filter(None, texts))


def _measure_turn(q: Real, p: Real) -> float:
    norm = np.linalg.norm(q)
    return float(measure_angles((q / norm)[np.newaxis], p[np.newaxis], np.zeros((1, 4)))[0])


def _measure_change(a: Real, b: Real) -> float:
    return float(np.linalg.norm(a - b))


def _name_mistake(
    words: str,
    measure: Callable[[Real, Real], float],
    found: Real,
    right: Real,
    mistakes: dict[str, Real],
    size: float,
) -> str:
    if not np.isfinite(found).all() or not (found.any() or size):
        return ""
    with np.errstate(all="ignore"):
        off = measure(found, right)
        limit = SAME_START * size
        if off <= limit or not np.isfinite(off):
            return ""
        named = [name for name, each in mistakes.items() if measure(found, each) <= limit]
    return f"{words} {named[0]}" if len(named) == 1 else f"{words} off by {off:.2g}"


class _Head(NamedTuple):
    """The lines before the rows of a table."""

    columns: list[str]
    separator: str | None  # None: any white space
    engine: str
    lines: int


def _read_head(path: Path, file: Iterator[str]) -> _Head:
    """Return the names of the columns, and what the comments before them say of an engine."""
    engine, lines = "", 0
    while True:
        text = next(file, "").removeprefix(BOM).strip()
        lines += 1
        separator = next((each for each in SEPARATORS if each in text), None)
        cells = text.removeprefix(COMMENT).split(separator)
        columns = [name.strip().strip('"') for name in cells]
        if {"t", *QUATERNION} <= {*columns}:
            return _Head(columns, separator, engine, lines)
        if not text.startswith(COMMENT):
            raise ValueError(
                f"{path} must have the columns t, w, x, y, z, got the header {_show(text)}"
            )
        said = text.removeprefix(COMMENT).strip()
        if said.lower().startswith(ENGINE):
            engine = _show(said[len(ENGINE) :])


def _read_states(path: Path, problem: Problem) -> tuple[Real, Real | None, str]:
    """Return orientations (21, 4) and rates (21, 3), and the engine.

    The first state is that at t = 0, nan without a row.
    """
    if path.stat().st_size > LARGEST_FILE:
        raise ValueError(
            f"{path} must have at most {LARGEST_FILE} bytes, got {path.stat().st_size}"
        )
    # Every byte is a character of Latin-1; names and numbers are ASCII in any encoding that counts.
    with path.open(encoding="latin-1", newline="") as file:
        head = _read_head(path, file)
        names = [*QUATERNION]
        names += next((each for each in (RATES, WORLD_RATES) if {*each} <= {*head.columns}), ())
        places = [head.columns.index(n) for n in ("t", *names)]
        found = _pick(file, head, places, np.array([0.0, *problem.times]))
    q = found[:, :4]
    rates = found[:, 4:] if len(names) > 4 else None
    if rates is not None and names[-1] in WORLD_RATES:
        with np.errstate(all="ignore"):  # zero and infinite quaternions are refused later
            unit = q / np.linalg.norm(q, axis=1, keepdims=True)
            rates = turn_to_body(unit, rates)
    return q, rates, head.engine


def _pick(rows: Iterable[str], head: _Head, places: Sequence[int], times: Real) -> Real:
    """Return the numbers of the rows at the times, nan at the first one if there is no row.

    The place of t comes first.
    """
    found = np.full((len(times), len(places) - 1), np.nan)
    marks = times.tolist()
    tried = array("d")
    for number, row in enumerate(rows, start=head.lines + 1):
        if not row.strip():
            continue
        try:
            cells = row.split(head.separator)
            tried.append(t := _read(cells[places[0]]))
            after = bisect(marks, t)
            for place in range(max(after - 1, 0), min(after + 1, len(marks))):
                if abs(marks[place] - t) <= SAME_TIME * marks[place]:
                    found[place] = [_read(cells[each]) for each in places[1:]]
        except IndexError:
            raise ValueError(f"line {number} must have all columns, got {_show(row)}") from None
        except ValueError:
            raise ValueError(f"line {number} must consist of numbers, got {_show(row)}") from None
    _find_absent(times[1:], np.array(tried))
    return found


def _find_absent(times: Real, tried: Real) -> None:
    """Raise ValueError if no row is at one of the times."""
    tried = tried[np.isfinite(tried)]
    for t in times.tolist():
        near = tried[np.abs(tried - t).argmin()] if tried.size else None
        if near is None or not abs(t - near) <= SAME_TIME * t:
            nearest = "there is no row" if near is None else f"the nearest is {near:.12g} s"
            raise ValueError(
                "trajectory must have a state at each time of the problem, got none at "
                f"{t:.12g} s; {nearest}"
            )


def _read(text: str) -> float:
    """Return a number; Python's own grammar has underscores, too."""
    if "_" in text:
        raise ValueError(text)
    return float(text.strip().strip('"'))


def _show(text: str) -> str:
    """Return the beginning of a line, with other characters than ASCII replaced."""
    line = text.strip().replace("\t", " ")[:SHOWN]
    return "".join(each if " " <= each <= "~" else "?" for each in line) or "nothing"


def _check(name: str, values: ArrayLike, width: int) -> Real:
    numbers = np.asarray(values, dtype=float)
    if numbers.shape != (20, width):
        raise ValueError(f"{name} must be of shape (20, {width}), got {numbers.shape}")
    wrong = numbers[~(np.abs(numbers) <= LARGEST_NUMBER)]
    if wrong.size:
        raise ValueError(
            f"{name} must be finite numbers up to {LARGEST_NUMBER:g}, got {wrong[0]:g}"
        )
    return numbers


def turn_to_body(orientations: Real, vectors: Real) -> Real:
    """Return vectors of the world (n, 3) in the frames of the body, (n, 3).

    Examples
    --------
    >>> turn_to_body(np.array([[0.5, 0.5, 0.5, 0.5]]), np.array([[1.0, 0.0, 0.0]])).tolist()
    [[0.0, 0.0, 1.0]]
    """
    w = orientations[:, :1]
    xyz = -orientations[:, 1:]
    twice = 2 * np.cross(xyz, vectors)
    return np.asarray(vectors + w * twice + np.cross(xyz, twice))


def split_decimals(rows: Sequence[Sequence[str]]) -> tuple[Real, Real]:
    """Return decimals as sums of two doubles, which hold about 32 digits.

    One double is off by up to half an ulp, which is as large as the errors of the best programs.

    Parameters
    ----------
    rows : sequence of n sequences of m str

    Returns
    -------
    high, low : ndarray (n, m)

    Examples
    --------
    >>> high, low = split_decimals([["0.1"]])
    >>> high.tolist(), low.tolist()
    ([[0.1]], [[-5.551115123125783e-18]])
    """
    high = np.array([[float(text) for text in row] for row in rows])
    low = [
        [float(Decimal(text) - Decimal(value)) for text, value in zip(row, values, strict=True)]
        for row, values in zip(rows, high.tolist(), strict=True)
    ]
    return high, np.array(low)


def measure_angles(orientations: Real, high: Real, low: Real) -> Real:
    """Return the errors of attitudes: the angles of the rotations that would correct them.

    Parameters
    ----------
    orientations : ndarray (..., 4)
        Unit quaternions of either sign.
    high, low : ndarray (..., 4)
        The exact quaternions are high + low.

    Returns
    -------
    ndarray (...)
        4 arcsin(|q - q_exact|/2) in rad, with the sign of q that makes it smaller: for small
        errors 2 |q - q_exact|.

    Examples
    --------
    >>> exact = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(4)
    >>> float(measure_angles(np.array([-1.0, 0.0, 0.0, 1e-9]), *exact))
    2e-09
    >>> half_turn = np.array([np.cos(1.5), np.sin(1.5), 0.0, 0.0])  # a rotation by 3 rad
    >>> round(float(measure_angles(half_turn, *exact)), 12)
    3.0
    """
    far = (orientations * high).sum(axis=-1, keepdims=True) < 0
    q = np.where(far, -orientations, orientations)
    half_chord = np.linalg.norm((q - high) - low, axis=-1) / 2
    return np.asarray(4 * np.arcsin(np.minimum(half_chord, 1.0)))


def main(args: Sequence[str] | None = None) -> int:
    """List the problems, or score a trajectory; return 0 (good) or 1 (failed, or too far off)."""
    parser = argparse.ArgumentParser(description="Score a trajectory against the test set.")
    parser.add_argument("problem", nargs="?", help="name of a problem; default: list all")
    parser.add_argument("trajectory", nargs="?", type=Path, help="CSV: t, w, x, y, z, wx, wy, wz")
    parser.add_argument("--json", action="store_true", help="print JSON in place of text")
    parser.add_argument(
        "--max-error",
        type=float,
        metavar="RAD",
        help="status 1 if the largest attitude error exceeds this",
    )
    options = parser.parse_args(args)
    try:
        return _run(options, read_problems())
    except ValueError as error:
        print(error, file=sys.stderr)
    except OSError as error:
        print(f"{error.filename}: {error.strerror}", file=sys.stderr)
    return 1


def _run(options: argparse.Namespace, problems: dict[str, Problem]) -> int:
    if not options.problem:
        print(list_problems(problems))
        return 0
    score = score_file(problems, options.problem, options.trajectory)
    if options.json:
        print(_dump(score, options.trajectory))
    else:
        print(score.format())
        print(format_engine(score.engine))
        print(format_citation(f"{Path(__file__).name} {VERSION}", describe_testset()))
    enforce_limit(float(score.angles.max()), options.max_error)
    return 0


def enforce_limit(error: float, limit: float | None, verb: str = "is") -> None:
    """Raise ValueError for an error of the attitude above the limit, if there is one.

    Examples
    --------
    >>> enforce_limit(1e-6, None)
    """
    if limit is not None and not error <= limit:
        raise ValueError(f"the attitude {verb} off by {error:.3g} rad, limit {limit:g} rad")


def _dump(score: Score, path: Path) -> str:
    """Return a score as JSON, as `top_testset PROBLEM FILE --json` has it."""
    header = {
        "schema": "symtop_ros/score/1",
        "version": VERSION,
        "files": [{"name": str(path), "sha256": sha256(path.read_bytes()).hexdigest()}],
        "testset": describe_testset(),
        "platform": describe_platform(),
        "entry": path.stem,
    }
    return json.dumps(header | score.facts(), indent=1)


def list_problems(problems: dict[str, Problem]) -> str:
    """Return a table of the problems.

    Examples
    --------
    >>> list_problems(read_problems()).splitlines()[18].split()[:4]
    ['2', 'cusps', '10', 's']
    """
    rows = [
        f"{facts['level']:5}  {facts['name']:18}{facts['times'][-1]:>6g} s  {facts['what']}"
        for facts in (each.facts for each in problems.values())
    ]
    return "\n".join(["level  name              duration  what", *rows])


def score_file(problems: dict[str, Problem], name: str, path: Path | None) -> Score:
    """Return the score of a CSV file.

    Raises
    ------
    ValueError
        If there is no such problem, no file is named, or the file is refused.
    OSError
        If the file cannot be read.
    """
    problem = find_problem(problems, name)
    if path is None:
        raise ValueError(f"trajectory must be a CSV file for {name}, got none")
    return score_trajectory(path, problem)


def find_problem(problems: dict[str, Problem], name: str) -> Problem:
    """Return a problem by its name, in the description that follows a dot, such as cusps.turned.

    Raises
    ------
    ValueError
        If there is none.
    """
    base, _, description = name.partition(".")
    if base not in problems:
        raise ValueError(
            f"problem must be one of {', '.join(problems)}, got {' '.join(name.split())[:60]}"
        )
    if base == name:
        return problems[name]
    if description not in (known := list_descriptions(base)):
        got = " ".join(description.split())[:60]
        raise ValueError(f"description must be one of {', '.join(known)}, got {got}")
    facts = problems[base].facts | {"name": name}
    if description in TURNED:
        facts |= {each: facts[f"turned_{each}"] for each in ("orientations", "angular_velocities")}
        facts |= _turn_start(facts)
    return Problem(facts)


def list_descriptions(name: str) -> tuple[str, ...]:
    """Return the descriptions that a problem has of its body.

    Examples
    --------
    >>> list_descriptions("looping")
    ('turned', 'inertial', 'offset', 'nested', 'nested_half')
    """
    return (*DESCRIPTIONS, *(FORMS if name == FORMED else ()))


def _turn_start(facts: dict[str, Any]) -> dict[str, list[float]]:
    """Return the start as the turned frame has it."""
    w, *v = facts["orientation"]
    a, *u = TURN
    vector = np.multiply(w, u) + np.multiply(a, v) + np.cross(v, u)
    omega = turn_to_body(np.array([TURN]), np.array([facts["angular_velocity"]]))[0]
    q = [w * a - float(np.dot(v, u)), *vector.tolist()]
    return {"orientation": q, "angular_velocity": omega.tolist()}


if __name__ == "__main__":
    sys.exit(main())
