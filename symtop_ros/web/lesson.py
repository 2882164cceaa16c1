"""The steps of the lesson, which the page, docs/lesson.md, the sheets and the pictures share."""

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import yaml

from symtop_ros.physics import Hold

FILE = Path(__file__).with_name("lesson.yaml")
# Scenes of the steps, and the options by which top_ctl finds the node of each.
NODES = {"cusps": "", "perry_fails": "--node /disc "}


@dataclass(frozen=True, slots=True)
class LessonAct:
    """A button of a step: a start, or a hurry of the motion that was started last."""

    button: str
    start: Mapping[str, float | str] | None = None  # fields of ~/set_initial_conditions
    hurry: float | None = None  # factor of the precession rate
    hold: Hold = "spin_rate"  # the quantity that the hurry leaves unchanged

    @property
    def command(self) -> str:
        """The words for top_ctl."""
        fields = [f"{name}={value}" for name, value in (self.start or {}).items()]
        if fields:
            return " ".join(["start", *fields])
        if self.hold == "spin_rate":
            return "hurry"
        return f"kick precession_rate_factor={self.hurry} hold={self.hold}"


@dataclass(frozen=True, slots=True)
class LessonStep:
    """A step of the lesson; `lesson.yaml` says what the fields are."""

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
    also: tuple[str, ...] = ()
    layers: tuple[str, ...] = ()
    scene: str = "cusps"
    plot: str = "tilt"

    @property
    def commands(self) -> list[str]:
        """Shell commands that do with ROS what the buttons do."""
        acts = [f"top_ctl {NODES[self.scene]}{act.command}" for act in self.acts]
        return [*acts, *self.also]


@functools.cache
def read_lesson() -> tuple[LessonStep, ...]:
    """Return all steps."""
    steps = yaml.safe_load(FILE.read_text(encoding="utf-8"))
    return tuple(
        LessonStep(**{**step, "acts": tuple(LessonAct(**act) for act in step["acts"])})
        for step in steps
    )
