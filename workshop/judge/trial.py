"""Two hundred fresh files: what the program says of each, and whether that is true."""

import json
import math
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable
from contextlib import redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from symtop_ros.truth.judge.main import main
from workshop.judge import filters
from workshop.judge.causes import CAUSES, NED, Fault, draw_fault, make_attitudes
from workshop.judge.motion import (
    BEGIN,
    Course,
    Real,
    conjugate,
    draw_path,
    find_angles,
    multiply,
    turn,
)
from workshop.judge.noise import NOISES, SIZES
from workshop.judge.reading import Said, Verdict, read_verdict, undo_columns

FILES = 200
MOTIONS = "steady", "nutating", "nutating", "kicked"
ALL_NOISES = (*NOISES, "filter")
# Parameters and rotations of each cause, as they are said.
NAMES = {
    "world and body": {"world", "body"},
    "heading and delay": {"heading", "delay"},
    "two parameters": {"delay", "drift"},
}
WITHOUT = "nothing", "another top"  # no cause that the program has
FAR = 5.0  # deviations
OUTCOMES = "right", "share", "silent", "wrong"


@dataclass(frozen=True, eq=False)
class File:
    """A run, the rows of estimates of it, and what is wrong with them."""

    number: int
    cause: str
    noise: str
    course: Course
    times: Real
    rows: Real  # the columns w, x, y, z
    fault: Fault
    size: float  # rad, of the noise of a component; of a filter its own error
    options: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """What it is, in words."""
        return f"{self.number}: {self.cause}, {self.noise}, {self.course.kind}"


def draw_file(number: int) -> File:
    """Return a file; numbers that are equal give equal files."""
    random = Random(f"fresh, {number}")
    noise = ALL_NOISES[number % len(ALL_NOISES)]
    cause = draw_cause(random, number)
    kind = "slow" if noise == "filter" else random.choice(MOTIONS)
    if cause == "scale" and kind == "kicked":
        kind = "nutating"
    course, fault = draw_path(random, kind), draw_fault(random, cause)
    if noise == "filter":
        return draw_filtered(random, number, course, fault)
    rate, seconds = random.choice((100, 200, 250)), random.uniform(4.0, 7.0)
    stamps = round(BEGIN * 1e9) + np.arange(round(rate * seconds)) * (10**9 // rate)
    size = random.choice(SIZES[:2] if noise in ("flicker", "sinusoid") else SIZES)
    vectors = size * NOISES[noise](random, stamps / 1e9)
    q = make_attitudes(fault, course, stamps / 1e9)
    q = multiply(q, turn(vectors)) if random.random() < 0.7 else multiply(turn(vectors), q)
    options = ("--robust",) if noise == "outliers" else ()
    return File(number, cause, noise, course, stamps / 1e9, fault.write(q), fault, size, options)


def draw_cause(random: Random, number: int) -> str:
    """Return a cause: each fourth file has none."""
    if number // len(ALL_NOISES) % 4 == 0:
        return "nothing"
    return random.choice(CAUSES[1:])


def draw_filtered(random: Random, number: int, course: Course, fault: Fault) -> File:
    """Return what a filter makes of a sensor, with a constant fault on top of it."""
    if fault.values or fault.name == "another top":
        fault = draw_fault(random, "heading")
    names = [*filters.FILTERS]
    name = names[number // len(ALL_NOISES) % len(names)]
    times = (120 + np.arange(1400)) / filters.RATE
    rates, forces = filters.measure(random, course, times)
    start = course.attitudes(times[:1])[0]
    own = filters.FILTERS[name](rates, forces, start)
    exact = course.attitudes(times)
    if find_angles(own, exact).mean() > find_angles(conjugate(own), exact).mean():
        own = conjugate(own)
    error = math.sqrt(float((find_angles(own, exact) ** 2).mean()))
    q = multiply(multiply(turn(fault.world), own), turn(fault.body))
    return File(number, fault.name, "filter", course, times, fault.write(q), fault, error)


def judge(file: File, folder: Path) -> str:
    """Return what the program prints of a file."""
    stamps = np.rint(file.times * 1e9).astype(np.int64)
    file.course.write_run(folder / "run.json", int(stamps[-1]) + 10**9)
    rows = [
        f"{stamp},{','.join(f'{each:.9f}' for each in row)}"
        for stamp, row in zip(stamps.tolist(), file.rows, strict=True)
    ]
    (folder / "estimates.csv").write_text("\n".join(["stamp,w,x,y,z", *rows, ""]))
    words = [str(folder / "run.json"), "--estimates", str(folder / "estimates.csv")]
    with redirect_stdout(StringIO()) as out:
        assert main([*words, *file.options]) == 0
    return out.getvalue()


def rate(file: File, text: str) -> tuple[str, dict[str, float]]:
    """Return the outcome of a file, and the pulls of its values as printed."""
    verdict = read_verdict(text)
    if not verdict.causes:
        return ("right" if file.cause in WITHOUT else "silent"), {}
    wanted = find_names(file)
    for said in verdict.causes:
        if said.names == wanted and file.cause not in WITHOUT:
            pulls = pull(file, said)
            if all(abs(each) <= FAR for each in pulls.values()) and is_near(file, said):
                return ("right" if verdict.is_named else "share"), pulls
            return "wrong", pulls
    # a part of two causes, or what a filter is off by, is right if it leaves what is said
    has_more = file.cause == "two parameters" or file.noise == "filter"
    is_true = has_more and is_true_share(file, verdict)
    return ("share" if is_true else "wrong"), {}


def find_names(file: File) -> set[str]:
    """Return what a right answer consists of."""
    if file.fault.columns:
        return {file.fault.columns}
    return NAMES.get(file.cause, {file.cause})


def list_made(file: File) -> dict[str, float]:
    """Return the values that were made, by the names of what is said."""
    fault = file.fault
    made = dict(fault.values)
    if file.cause.startswith("heading"):
        return made | {"heading": fault.world[2]}
    sizes = {"world": math.hypot(*fault.world), "body": math.hypot(*fault.body)}
    return made | {name: size for name, size in sizes.items() if size}


def settle(said: Said, made: dict[str, float]) -> dict[str, float]:
    """Return the values said, those of a family of delays for the member next to the truth."""
    values = dict(said.values)
    if "delay" in said.steps:
        n = round((made["delay"] - values["delay"]) / said.steps["delay"])
        for name, step in said.steps.items():
            values[name] += n * step
    for name in ("heading",):
        if name in values:
            off = values[name] - made[name]
            values[name] -= 2 * math.pi * round(off / (2 * math.pi))
    return values


def pull(file: File, said: Said) -> dict[str, float]:
    """Return errors of values in their deviations, of those that have one."""
    made = list_made(file)
    values = settle(said, made)
    # the step of a family is printed with a few digits
    room = {name: abs(step) * 2e-4 for name, step in said.steps.items()}
    return {
        name: (values[name] - made[name]) / math.hypot(deviation, room.get(name, 0.0))
        for name, deviation in said.deviations.items()
        if math.isfinite(deviation) and file.noise != "filter"
    }


def is_near(file: File, said: Said) -> bool:
    """Return whether values without a deviation would leave no more than the noise and a half."""
    made = list_made(file)
    values = settle(said, made)
    speed = float(np.abs(file.course.start[4:]).max())
    span = file.times[-1] - file.times[0]
    turns = {"delay": speed, "clock": speed * span, "drift": span, "spin": span}
    turns["scale"] = speed * span
    room = 3 * max(file.size, 1e-6)
    return all(
        abs(values[name] - made[name]) * turns.get(name, 1.0) <= room + 1e-5
        for name, deviation in said.deviations.items()
        if not math.isfinite(deviation)
    )


def is_true_share(file: File, verdict: Verdict) -> bool:
    """Return whether what is said leaves as much as is said, by the values that are printed."""
    said = verdict.causes[0]
    fault = said.as_fault()
    rows = undo_columns(file.rows, said.columns)
    model = fault.model(file.course, file.times)
    model = multiply(NED, model) if said.columns == "ned" else model
    left = math.sqrt(float((find_angles(rows, model) ** 2).mean()))
    plain = find_angles(file.rows, file.course.attitudes(file.times))
    whole = math.sqrt(float((plain**2).mean()))
    # axes have two decimals and more, and a value ends where its changes are seen in what is left
    room = 0.5 * verdict.left + 0.01 * math.hypot(*fault.world, *fault.body)
    is_whole = verdict.is_named or abs(whole - verdict.whole) <= 0.01 * whole
    return is_whole and abs(left - verdict.left) <= room


@dataclass(frozen=True)
class Row:
    """What came of a file."""

    name: str
    cause: str
    noise: str
    motion: str
    outcome: str
    pulls: dict[str, float]
    text: str


def try_file(number: int) -> Row:
    """Judge a file."""
    file = draw_file(number)
    with TemporaryDirectory() as folder:
        text = judge(file, Path(folder))
    outcome, pulls = rate(file, text)
    return Row(file.name, file.cause, file.noise, file.course.kind, outcome, pulls, text)


def count(rows: Iterable[Row], key: str) -> dict[str, Counter[str]]:
    """Return outcomes by cause, noise or motion."""
    found: dict[str, Counter[str]] = defaultdict(Counter)
    for row in rows:
        found[getattr(row, key)][row.outcome] += 1
    return found


def find_rms(rows: Iterable[Row]) -> tuple[float, int]:
    """Return the root mean square of all pulls, and their number."""
    pulls = [each for row in rows for each in row.pulls.values()]
    return math.sqrt(sum(each**2 for each in pulls) / max(len(pulls), 1)), len(pulls)


def format_counts(rows: list[Row]) -> str:
    """Return tables of outcomes, and the pulls."""
    lines = []
    for key in ("noise", "cause", "motion"):
        lines.append(f"{key:22}" + "".join(f"{each:>8}" for each in OUTCOMES))
        for name, counts in sorted(count(rows, key).items()):
            lines.append(f"{name:22}" + "".join(f"{counts[each]:8}" for each in OUTCOMES))
    for noise in ALL_NOISES:
        own = [row for row in rows if row.noise == noise and row.cause in WITHOUT]
        wrong = sum(row.outcome == "wrong" for row in own)
        lines.append(f"without a cause, {noise}: {wrong} wrong of {len(own)}")
    rms, number = find_rms(rows)
    return "\n".join([*lines, f"pulls as printed: {rms:.2f} rms of {number}"])


def measure_judge(folder: Path) -> None:
    """Judge all files, print the counts, and write all that was said into a folder."""
    rows = []
    for number in range(FILES):
        rows.append(try_file(number))
        print(f"{rows[-1].name}: {rows[-1].outcome}", file=sys.stderr)
    facts: list[dict[str, Any]] = [vars(row) for row in rows]
    (folder / "judge_trial.json").write_text(json.dumps(facts, indent=1), encoding="utf-8")
    print(format_counts(rows))
