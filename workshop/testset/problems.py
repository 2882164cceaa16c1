"""The seventy problems of the test set: tops, starts and times, from easy to hard."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from symtop_ros.physics import Body, State, Top

DATA: dict[str, Any] = yaml.safe_load(
    Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8")
)
BODIES = {name: Body(**each) for name, each in DATA["bodies"].items()}
TOPS = {name: Top(*each) for name, each in DATA["tops"].items()}
TOPS |= {name: body.top for name, body in BODIES.items()}
KNOWN = {body.top: body for body in BODIES.values()}
COUNT = 20  # times of each problem


@dataclass(frozen=True)
class Setting:
    """A problem without its solution; `problems.yaml` says what the levels are."""

    level: int
    name: str
    what: str
    top: Top
    start: State
    duration: float  # s
    has_period: bool  # False if theta does not swing

    @property
    def body(self) -> Body:
        """The body that has a name here, or the one that the package chooses."""
        return KNOWN.get(self.top) or Body.from_top(self.top)

    @property
    def times(self) -> list[float]:
        """Times of the exact states, in s."""
        return [self.duration * k / COUNT for k in range(1, COUNT + 1)]


def _read_setting(
    level: int,
    name: str,
    what: str,
    top: str | list[float],
    duration: float = 10.0,
    has_period: bool = True,
    **start: Any,
) -> Setting:
    """Return a problem; the top is one that has a name, or its constants."""
    known = TOPS[top] if isinstance(top, str) else Top(*top)
    return Setting(level, name, what, known, _read_start(**start), duration, has_period)


def _read_start(
    orientation: str = "", omega: tuple[float, ...] = (), digits: int = 6, **angles: float
) -> State:
    """Return the start with an orientation by its name, or with Euler angles and rates."""
    if orientation:
        return State(DATA["orientations"][orientation], omega)
    parts = State.from_euler(**angles)._parts
    return State(*([float(f"{x:.{digits}g}") for x in part] for part in parts))


SETTINGS = [
    _read_setting(level, name, **facts)
    for level, problems in DATA["problems"].items()
    for name, facts in problems.items()
]
