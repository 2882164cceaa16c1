"""What `top_judge` prints, read as a person reads it."""

import re
from dataclasses import dataclass, field

import numpy as np

from workshop.judge.causes import COLUMNS, Fault
from workshop.judge.motion import Real

NUMBER = r"(-?\d[\d.]*(?:e[-+]\d+)?)"
MEASURED = rf"{NUMBER}(?: \+- {NUMBER})?"
AXIS = rf"(?: about \({NUMBER}, {NUMBER}, {NUMBER}\)| \({NUMBER} degrees about (\S+?)\))?"
PARTS = {  # name: sentence, and its unit
    "delay": (rf"a delay of {MEASURED} ms(?: \+ n x {NUMBER} ms)?", 1e-3),
    "drift": (rf"a drift of the heading of {MEASURED} rad/s", 1.0),
    "spin": (rf"a drift of {MEASURED} rad/s about the axis", 1.0),
    "scale": (rf"gyroscope, too large by {MEASURED} %", 1e-2),
    "clock": (rf"runs fast by {MEASURED} ppm", 1e-6),
    "heading": (rf"a heading of {MEASURED} rad(?: \+ n x {NUMBER} rad)?", 1.0),
    "world": (rf"rotation of the world by {MEASURED} rad{AXIS}", 1.0),
    "body": (rf"of the body by {MEASURED} rad{AXIS}", 1.0),
}
SHARE = re.compile(rf" leaves? {NUMBER} of {NUMBER} (mrad|rad) rms")
NAMED = re.compile(rf"best explained by (.*); this leaves {NUMBER} rad rms")
OR = re.compile(r"^or equally well by (.*)$", re.M)
LETTERS = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
MISTAKES = {  # the sentence of a note, and what its columns hold
    "have the order x, y, z, w": "xyzw",
    "the quaternions are conjugate: world": "conjugate",
    "columns are mixed up: x has the other sign": "sign of x",
    "columns are mixed up: y and z are exchanged": "y and z exchanged",
    "columns are mixed up: w, x, y and z hold": "mixed",
    "is north-east-down, not east-north-up": "ned",
}


@dataclass(frozen=True, eq=False)
class Said:
    """One cause that is said: values, deviations (nan: none), and steps of a family of delays."""

    values: dict[str, float]
    deviations: dict[str, float]
    steps: dict[str, float]
    axes: dict[str, tuple[float, ...]]
    columns: str = ""

    @property
    def names(self) -> set[str]:
        """What it consists of."""
        return {*self.values, *([self.columns] if self.columns else [])}

    def as_fault(self) -> Fault:
        """Return it as what is wrong with estimates."""
        turns = {
            name: tuple(self.values[name] * np.array(self.axes.get(name, (0, 0, 1))))
            for name in ("world", "body")
            if name in self.values
        }
        if "heading" in self.values:
            turns["world"] = (0.0, 0.0, self.values["heading"])
        others = {k: v for k, v in self.values.items() if k not in ("heading", "world", "body")}
        return Fault("said", others, **turns, columns=self.columns)


@dataclass(frozen=True, eq=False)
class Verdict:
    """What a text says: the causes (equally good ones, too), whether one is named, and shares."""

    causes: list[Said] = field(default_factory=list)
    is_named: bool = False
    left: float = float("nan")  # rad
    whole: float = float("nan")  # rad, of a share


def read_verdict(text: str) -> Verdict:
    """Return what a text says."""
    lines = text.splitlines()
    named = NAMED.search(text)
    share = next((line for line in lines if SHARE.search(line)), None)
    columns = next((held for words, held in MISTAKES.items() if words in text), "")
    if not columns and "likely mistake: the quaternions" in text:
        columns = "others"
    first = named[1] if named else share
    if first is None:
        return Verdict()
    causes = [read_parts(each, columns) for each in (first, *OR.findall(text))]
    if named:
        return Verdict(causes, True, float(named[2]))
    found = SHARE.search(first)
    assert found
    unit = {"mrad": 1e-3, "rad": 1.0}[found[3]]
    return Verdict(causes, False, unit * float(found[1]), unit * float(found[2]))


def read_parts(text: str, columns: str) -> Said:
    """Return one cause of a sentence; `columns` are those of the mistake below, if it is one."""
    values, deviations, steps, axes = {}, {}, {}, {}
    for name, (sentence, unit) in PARTS.items():
        if found := re.search(sentence, text):
            groups = found.groups()
            values[name] = unit * float(groups[0])
            deviations[name] = unit * float(groups[1]) if groups[1] else float("nan")
            if name in ("delay", "heading") and groups[2]:
                steps[name] = unit * float(groups[2])
            if name in ("world", "body"):
                axes[name] = read_axis(groups[2:5], groups[5], groups[6])
                if groups[5]:
                    values[name] = abs(values[name])
    return Said(values, deviations, steps, axes, columns if "the mistake below" in text else "")


def read_axis(vector: tuple[str, ...], degrees: str, name: str) -> tuple[float, ...]:
    """Return an axis of length one, as it is printed."""
    if vector[0]:
        found = np.array([*map(float, vector)])
    elif name:
        found = np.array(LETTERS.get(name) or [*map(float, name.strip("()").split(","))])
        found = found * (-1 if float(degrees) < 0 else 1)
    else:
        found = np.array([0.0, 0.0, 1.0])
    return tuple((found / np.sqrt(float((found**2).sum()))).tolist())


def undo_columns(rows: Real, columns: str) -> Real:
    """Return the attitudes of columns that were said to hold others."""
    if columns == "ned":
        return rows
    if columns not in COLUMNS:
        return rows
    places, signs = COLUMNS[columns]
    found = np.empty_like(rows)
    found[:, list(places)] = rows * np.array(signs, dtype=float)
    return found
