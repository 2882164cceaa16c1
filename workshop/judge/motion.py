"""Motions of tops by integration, without the closed form: attitudes at any time.

Quaternions are w, x, y, z, and turn the body into a world whose z axis is up.
"""

import json
import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from symtop_ros.physics import Motion, State, Top
from symtop_ros.run.simulation.changes.follow import Act, Change
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.segment import Segment

Real = NDArray[np.float64]
KINDS = "steady", "nutating", "kicked", "slow"
BEGIN, END = 0.6, 8.0  # s, between which there are estimates
ROOM = 0.55  # s before and after them, by which estimates may be late or early
WEIGHT = 0.068  # J
EXACT = 1e-12  # tolerance of a step, relative and absolute


def integrate(slope: Callable[[float, Real], Real], start: Real, begin: float, marks: Real) -> Real:
    """Return the states at marks (n,) in s, by an explicit method of order eight, (n, m)."""
    found: Any = solve_ivp(
        slope, (begin, marks[-1]), start, "DOP853", t_eval=marks, rtol=EXACT, atol=EXACT
    )
    return np.asarray(found.y.T)


def multiply(p: Real, q: Real) -> Real:
    """Return the products of quaternions (..., 4), by Hamilton's rule."""
    s, t = p[..., :1], q[..., :1]
    u, v = p[..., 1:], q[..., 1:]
    scalar = s * t - (u * v).sum(axis=-1, keepdims=True)
    return np.concatenate((scalar, s * v + t * u + np.cross(u, v)), axis=-1)


def turn(vectors: Any) -> Real:
    """Return the quaternions of rotations about vectors (..., 3) by their lengths."""
    vectors = np.asarray(vectors, dtype=float)
    angle = np.sqrt((vectors**2).sum(axis=-1, keepdims=True))
    return np.concatenate((np.cos(angle / 2), vectors * np.sinc(angle / (2 * np.pi)) / 2), axis=-1)


def conjugate(q: Real) -> Real:
    """Return the inverse rotations."""
    return np.asarray(q * np.array([1.0, -1.0, -1.0, -1.0]))


def find_angles(p: Real, q: Real) -> Real:
    """Return the angles in rad between attitudes (n, 4)."""
    between = multiply(conjugate(p), q)
    sines = np.sqrt((between[:, 1:] ** 2).sum(axis=1))
    return np.asarray(2 * np.arctan2(sines, np.abs(between[:, 0])))


@dataclass(frozen=True)
class Body:
    """Moments of inertia in kg m^2, and the weight times the arm in J."""

    across: float
    along: float
    weight: float

    def slope(self, _: float, state: Real) -> Real:
        """Return the derivative of a quaternion and of rates in the body: Euler's equations."""
        w, x, y, z, p, q, r = state
        upward = 2 * (x * z - w * y), 2 * (y * z + w * x)  # the vertical, in the body
        excess = (self.across - self.along) / self.across * r
        return np.array(
            [
                -(x * p + y * q + z * r) / 2,
                (w * p + y * r - z * q) / 2,
                (w * q + z * p - x * r) / 2,
                (w * r + x * q - y * p) / 2,
                excess * q + self.weight * upward[1] / self.across,
                -excess * p - self.weight * upward[0] / self.across,
                0.0,
            ]
        )


@dataclass(frozen=True, eq=False)
class Course:
    """A motion from t = 0 on, which a kick may change at once."""

    body: Body
    start: Real  # quaternion, and rates in the body, (7,)
    kind: str
    kick: float | None = None  # s
    push: tuple[float, float, float] = (0.0, 0.0, 0.0)  # change of the rates, rad/s

    def states(self, times: Real) -> Real:
        """Return quaternions and rates in the body at times (n,) in s, (n, 7)."""
        order = np.argsort(times, kind="stable")
        wanted, found = times[order], np.empty((len(times), 7))
        early = wanted < (math.inf if self.kick is None else self.kick)
        found[early] = self._solve(self.start, 0.0, wanted[early])
        if self.kick is not None:
            found[~early] = self._solve(self.after_kick, self.kick, wanted[~early])
        back = np.empty_like(found)
        back[order] = found
        return back

    @property
    def before_kick(self) -> Real:
        """The state at the kick without it, (7,)."""
        return np.asarray(self._solve(self.start, 0.0, np.array([self.kick or 0.0]))[0])

    @property
    def after_kick(self) -> Real:
        """The state that the kick leaves, (7,)."""
        return np.asarray(self.before_kick + np.array((0.0, 0.0, 0.0, 0.0, *self.push)))

    def _solve(self, start: Real, begin: float, times: Real) -> Real:
        if not len(times) or times[-1] == begin:
            return np.tile(start, (len(times), 1))
        marks = np.unique(times)
        states = integrate(self.body.slope, start, begin, marks)[np.searchsorted(marks, times)]
        states[:, :4] /= np.sqrt((states[:, :4] ** 2).sum(axis=1, keepdims=True))
        return states

    def attitudes(self, times: Real) -> Real:
        """Return quaternions at times (n,) in s, (n, 4)."""
        return np.asarray(self.states(times)[:, :4])

    def write_run(self, path: Path, end: int) -> None:
        """Write the events of the run, until a stamp in ns, as the program reads them."""
        top = Top(self.body.across, self.body.along, self.body.weight)
        segment = Segment.begin(Motion(top, _make_state(self.start)), 0, 1.0)
        events = [Event.of(Change(Act("start", 0, {}), _make_state(self.start), segment))]
        if self.kick is not None:
            stamp = round(self.kick * 1e9)
            kicked = segment.change(stamp, _make_state(self.after_kick))
            change = Change(Act("kick", stamp, {}), _make_state(self.before_kick), kicked)
            events.append(Event.of(change))
        facts = {"events": [asdict(each) for each in events], "end": end}
        path.write_text(json.dumps(facts, default=str), encoding="utf-8")


def _make_state(state: Real) -> State:
    return State(state[:4], state[4:])


def draw_path(random: Random, kind: str) -> Course:
    """Return a motion of a kind: steady, nutating, kicked, or slow enough for a filter."""
    across = 2.3e-4 * random.uniform(0.6, 1.6)
    body = Body(across, across * random.uniform(0.25, 1.4), WEIGHT)
    tilt, azimuth, turned = random.uniform(0.4, 1.1), random.uniform(-3, 3), random.uniform(-3, 3)
    if kind == "slow":
        body = Body(2e-3, 2e-3 * random.uniform(0.4, 1.2), WEIGHT)
        spin, rates = random.uniform(1.0, 3.0), (random.uniform(-1, 1), random.uniform(-1, 1))
        return Course(body, _start(tilt, azimuth, turned, *rates, spin), kind)
    least = 2 * math.sqrt(across * WEIGHT * math.cos(tilt)) / body.along
    spin = random.choice((-1, 1)) * least * random.uniform(1.5, 3.0)
    if kind == "steady":
        return Course(body, _start_steadily(body, tilt, azimuth, turned, spin), kind)
    rates = random.uniform(-3, 3), random.uniform(-6, 6)
    start = _start(tilt, azimuth, turned, *rates, spin)
    if kind == "nutating":
        return Course(body, start, kind)
    push = [random.choice((-1, 1)) * random.uniform(1.0, 6.0) for _ in range(2)]
    return Course(body, start, kind, random.randint(200, 400) / 100, (push[0], push[1], 0.0))


def _start(
    tilt: float, azimuth: float, turned: float, nodding: float, precession: float, spin: float
) -> Real:
    """Return the state of angles phi, theta, psi and rates theta', phi', and of a spin r."""
    q = multiply(
        multiply(turn([0.0, 0.0, azimuth]), turn([tilt, 0.0, 0.0])), turn([0.0, 0.0, turned])
    )
    p = precession * math.sin(tilt) * math.sin(turned) + nodding * math.cos(turned)
    s = precession * math.sin(tilt) * math.cos(turned) - nodding * math.sin(turned)
    return np.array([*q, p, s, spin])


def _start_steadily(body: Body, tilt: float, azimuth: float, turned: float, spin: float) -> Real:
    """Return a regular precession: Ix cos(theta) phi'^2 - Iz r phi' + Mgl = 0, the slower root."""
    momentum = body.along * spin
    root = math.sqrt(momentum**2 - 4 * body.across * body.weight * math.cos(tilt))
    precession = 2 * body.weight / (momentum + math.copysign(root, momentum))
    return _start(tilt, azimuth, turned, 0.0, precession, spin)
