"""The steps of the lesson, for docs/lesson.md and the pictures."""

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from symtop_ros.page.web.join import read_steps, read_texts
from symtop_ros.physics import Hold
from symtop_ros.words.templates import write_number

TEXTS = ("title", "predict", "look", "seen", "question", "answer", "picture", "source")
RECORDED = "top_fit --example --run run.json"  # the run of a record, which no node makes
# Scenes of the steps, and the options by which top_ctl finds the node of each.
NODES = {"cusps": "", "perry_fails": "--node /disc "}


@dataclass(frozen=True, slots=True)
class LessonAct:
    """A button of a step: a start, or what is done to the motion that was started last."""

    button: str
    start: Mapping[str, float | str] | None = None  # fields of ~/set_initial_conditions
    hurry: float | None = None  # factor of the precession rate
    hold: Hold = "spin_rate"  # the quantity that the hurry leaves unchanged
    push: Mapping[str, float] | None = None  # fields of ~/kick for a series of pushes
    clamp: bool = False  # whether a hand takes hold of the precession
    record: float | None = None  # of the example's run: so many times its spin

    @property
    def command(self) -> str:
        """The words for top_ctl."""
        fields = [f"{name}={value}" for name, value in (self.start or {}).items()]
        if fields:
            return " ".join(["start", *fields])
        if self.clamp:
            return "clamp on"
        if self.push:
            return " ".join(["kick", *(f"{name}={value:g}" for name, value in self.push.items())])
        if self.hold == "spin_rate":
            return "hurry"
        return f"kick precession_rate_factor={self.hurry} hold={self.hold}"


@dataclass(frozen=True, slots=True)
class LessonTable:
    """Numbers that a step explains: in rows, with a form and a heading of each column."""

    forms: tuple[str, ...]
    rows: tuple[tuple[float, ...], ...]
    headings: tuple[str, ...]

    @property
    def cells(self) -> list[list[str]]:
        """The rows, written out."""
        return [list(map(write_number, row, self.forms)) for row in self.rows]


@dataclass(frozen=True, slots=True)
class LessonStep:
    """A step of the lesson; `lesson.yaml` says what the fields are."""

    name: str
    title: str
    predict: str
    acts: tuple[LessonAct, ...]
    look: str
    charts: tuple[str, ...]
    seen: str
    question: str
    answer: str
    picture: str
    source: str
    compute: str = ""
    ask: Mapping[str, float] | None = None  # a number that is predicted, and how near
    table: LessonTable | None = None
    also: tuple[str, ...] = ()
    layers: tuple[str, ...] = ()
    scene: str = "cusps"
    plot: str = "tilt"

    @property
    def has_record(self) -> bool:
        """True if the step is about measured points."""
        return any(act.record for act in self.acts)

    @property
    def commands(self) -> list[str]:
        """Shell commands that do with ROS what the buttons do; those of a record need no node."""
        acts = [f"top_ctl {NODES[self.scene]}{act.command}" for act in self.acts if not act.record]
        recorded = [RECORDED] if self.has_record else []
        return [*recorded, *acts, *self.also]


@functools.cache
def read_lesson() -> tuple[LessonStep, ...]:
    """Return all steps, in English."""
    return tuple(_read_step(step, read_texts("en")) for step in read_steps())


def _read_step(step: Mapping[str, Any], texts: Mapping[str, str]) -> LessonStep:
    key = f"lesson.{step['name']}"
    acts = [LessonAct(texts[f"{key}.act_{k}"], **act) for k, act in enumerate(step["acts"], 1)]
    # the page marks letters of formulas within sentences: $u$
    said = {name: texts[f"{key}.{name}"].replace("$", "") for name in TEXTS}
    compute = texts.get(f"{key}.compute", "").replace("$", "")  # not in every step
    table = _read_table(step["table"], key, texts) if "table" in step else None
    return LessonStep(**{**step, **said, "acts": tuple(acts), "compute": compute, "table": table})


def _read_table(data: Mapping[str, Any], key: str, texts: Mapping[str, str]) -> LessonTable:
    forms, rows = tuple(data["forms"]), tuple(map(tuple, data["rows"]))
    headings = (texts[f"{key}.column_{k}"] for k in range(1, len(forms) + 1))
    return LessonTable(forms, rows, tuple(headings))
