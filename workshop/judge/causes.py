"""Errors that are made of exact attitudes, and the attitudes of estimates that have them."""

from dataclasses import dataclass, field, replace
from random import Random
from typing import Any

import numpy as np

from workshop.judge.motion import Course, Real, integrate, multiply, turn

# What the columns w, x, y, z hold: places of the components, and their signs.
COLUMNS: dict[str, tuple[tuple[int, ...], tuple[int, ...]]] = {
    "xyzw": ((1, 2, 3, 0), (1, 1, 1, 1)),
    "conjugate": ((0, 1, 2, 3), (1, -1, -1, -1)),
    "sign of x": ((0, 1, 2, 3), (1, -1, 1, 1)),
    "y and z exchanged": ((0, 1, 3, 2), (1, 1, 1, 1)),
    "mixed": ((2, 0, 3, 1), (1, 1, -1, 1)),
}
NED = np.array([0.0, np.sqrt(0.5), np.sqrt(0.5), 0.0])
CAUSES = (
    "nothing",
    "delay",
    "drift",
    "spin",
    "scale",
    "clock",
    "heading",
    "world",
    "body",
    "world and body",
    "heading and delay",
    "ned",
    *COLUMNS,
    "two parameters",
    "another top",
)


@dataclass(frozen=True, eq=False)
class Fault:
    """What is wrong with estimates; delays in s, rates in rad/s, rotations as vectors in rad."""

    name: str
    values: dict[str, float] = field(default_factory=dict)
    world: tuple[float, float, float] = (0.0, 0.0, 0.0)
    body: tuple[float, float, float] = (0.0, 0.0, 0.0)
    columns: str = ""  # of COLUMNS, or "ned"

    def model(self, course: Course, times: Real) -> Real:
        """Return attitudes with these errors at times (n,) in s, which begin with the first."""
        since = times - times[0]
        read = self.values.get
        late = read("delay", 0.0) + read("clock", 0.0) * since
        q = scale_rates(course, times, self.values["scale"]) if "scale" in self.values else None
        q = course.attitudes(times - late) if q is None else q
        vertical = np.array([0.0, 0.0, 1.0])
        left = multiply(turn(np.outer(read("drift", 0.0) * since, vertical)), turn(self.world))
        right = multiply(turn(np.outer(read("spin", 0.0) * since, vertical)), turn(self.body))
        return multiply(multiply(left, q), right)

    def write(self, q: Real) -> Real:
        """Return the columns w, x, y, z that a file has."""
        if self.columns == "ned":
            return multiply(NED, q)
        if not self.columns:
            return q
        places, signs = COLUMNS[self.columns]
        return np.asarray(q[:, list(places)] * np.array(signs, dtype=float))


def scale_rates(course: Course, times: Real, part: float) -> Real:
    """Return the attitudes of rates that are too large by a part, right at the first time."""

    def slope(t: float, state: Real) -> Real:
        own = course.body.slope(t, state[:7])
        p = np.concatenate(([0.0], state[4:7] * (1 + part)))
        return np.concatenate((own, multiply(state[7:], p) / 2))

    first = course.states(times[:1])[0]
    begin = np.concatenate((first, first[:4]))
    found = integrate(slope, begin, float(times[0]), times)[:, 7:]
    return np.asarray(found / np.sqrt((found**2).sum(axis=1, keepdims=True)))


def draw_fault(random: Random, name: str) -> Fault:
    """Return a fault of a name."""
    sign = random.choice((-1, 1))
    sizes = {
        "delay": random.uniform(2e-3, 40e-3),
        "drift": sign * random.uniform(0.02, 0.3),
        "spin": sign * random.uniform(0.05, 1.0),
        "scale": sign * random.uniform(2e-3, 1e-2),
        "clock": sign * random.uniform(1e-4, 1e-3),
    }
    heading = (0.0, 0.0, sign * random.uniform(0.1, 1.0))
    if name in sizes:
        return Fault(name, {name: sizes[name]})
    if name == "two parameters":
        return Fault(name, {each: sizes[each] for each in ("delay", "drift")})
    if name in ("heading", "heading and delay"):
        late = {"delay": sizes["delay"]} if "and" in name else {}
        return Fault(name, late, heading)
    world, body = draw_vector(random), draw_vector(random)
    turns: dict[str, Any] = {"world": {"world": world}, "body": {"body": body}}
    turns["world and body"] = {"world": world, "body": body}
    if name in turns:
        return Fault(name, **turns[name])
    return Fault(name, columns=name if name in ("ned", *COLUMNS) else "")


def draw_vector(random: Random) -> tuple[float, float, float]:
    """Return a rotation vector of 0.1 to 0.8 rad, in any direction."""
    axis = [random.gauss(0, 1) for _ in range(3)]
    size = random.uniform(0.1, 0.8) / sum(each**2 for each in axis) ** 0.5
    return (axis[0] * size, axis[1] * size, axis[2] * size)


def make_attitudes(fault: Fault, course: Course, times: Real) -> Real:
    """Return the attitudes with a fault, before noise; another top has another moment."""
    if fault.name == "another top":
        body = replace(course.body, along=course.body.along * 1.01)
        return replace(course, body=body).attitudes(times)
    return fault.model(course, times)
