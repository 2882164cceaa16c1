"""Statements next to a boundary are true of the start, or of one that rounding makes of it.

A boundary is where a number vanishes, and a sentence says its sign, or that it is zero. Each number
is walked by single last places from both sides, and is known with 40 digits here. A sign that is
said is wrong if the number has the other one beyond rounding; so is a zero of a number beyond
rounding. How large rounding is, says docs/derivation.md, section 14, for each of them.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from drawn import PI, Numbers, cos
from mpmath import mp, mpf
from physics.tops import EPS, exact_euler, exact_parts
from trials import seeds

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import (
    Motion,
    State,
    Top,
    clamp_verdict,
    perrys_rule,
    set_precession_rate,
    solve_start,
)

FEW, MANY = 50, 5000  # starts around each boundary, in a run of all tests and in the long trials
PLACES = 3  # by which each number is moved, at most
DIGITS = 40
STATE = 8 * EPS  # of a state: kernel/rule/tilt.hpp
START = 64 * EPS  # of what is computed from a start: kernel/exact/nutation.hpp
Inputs = tuple[float, ...]


@dataclass(frozen=True)
class Said:
    """The sign that is said, or 0, the number that is meant, and how large rounding of it is."""

    sign: int
    number: mpf
    rounding: mpf

    def is_true_nearby(self) -> bool:
        if self.sign == 0:
            return abs(self.number) <= self.rounding
        return self.sign * self.number > -self.rounding


@dataclass(frozen=True)
class Boundary:
    draw: Callable[[Numbers], Inputs]
    judge: Callable[..., Said | None]  # None where the number is not what decides


def draw_top(rng: Numbers, signs=(-1, 1)) -> Top:
    Ix = rng.power(-5, 1)
    return Top(Ix, Ix * rng.uniform(0.05, 1.9), Ix * rng.choice(signs) * rng.power(-1, 4))


def pack(top: Top, state: State) -> Inputs:
    return (*top.moments, *state.orientation.tolist(), *state.angular_velocity.tolist())


def unpack(numbers: Inputs) -> tuple[Top, State]:
    return Top(*numbers[:3]), State(numbers[3:7], numbers[7:])


def swing(top: Top) -> float:
    return math.sqrt(abs(top.Mgl) / top.Ix) or 1.0


def draw_rates(rng: Numbers, top: Top) -> dict[str, float]:
    rate = swing(top)
    return {
        "phi": rng.uniform(-3, 3),
        "psi": rng.uniform(-3, 3),
        "theta": rng.choice([rng.uniform(0.05, 3.1), PI / 2]),
        "theta_dot": rng.choice([0, 1, -1]) * rate * rng.power(-2, 1),
        "psi_dot": rng.choice([0, 1, -1]) * rate * rng.power(-1, 1.5),
    }


def sign_of(number: float) -> int:
    return (number > 0) - (number < 0)


def look(top: Top, state: State):
    """The tilt, phi', theta', psi', the largest component of omega, and the moments, exactly."""
    (_, theta, _), (phi_dot, theta_dot, psi_dot) = exact_euler(*exact_parts(state))
    largest = max(map(abs, map(mpf, state.angular_velocity.tolist())))
    return theta, (phi_dot, theta_dot, psi_dot), largest, tuple(map(mpf, top.moments))


def draw_no_precession(rng: Numbers) -> Inputs:
    """A start without phi', or one at which a kick ended it."""
    top = draw_top(rng, (-1, 0, 1))
    rates = draw_rates(rng, top)
    state = State.from_euler(**rates)
    if rng.random() < 0.5:
        precessing = State.from_euler(**rates, phi_dot=swing(top) * rng.power(-1, 1))
        hold = rng.choice(["spin_rate", "spin_momentum"])
        state = set_precession_rate(precessing, 0.0, hold)
    return pack(top, state)


def judge_precession(*numbers: float) -> Said:
    top, state = unpack(numbers)
    theta, (phi_dot, *_), largest, (Ix, _, Mgl) = look(top, state)
    reason = perrys_rule(top, state).reason
    sign = 0 if reason.kind == "no_precession" else sign_of(reason.before)
    scale = max(largest, mp.sqrt(abs(Mgl) / Ix))
    return Said(sign, phi_dot * mp.sin(theta), 1.001 * STATE * scale)


def draw_regular(rng: Numbers) -> Inputs:
    """A regular precession: theta'' = 0."""
    top = draw_top(rng)
    theta = rng.uniform(0.05, 3.1)
    period = 2 * PI / (swing(top) * rng.power(-1, 1))
    start = rng.choice(solve_start(top, theta=theta, precession_period=period))
    turned = State.from_euler(
        phi=rng.uniform(-3, 3),
        theta=theta,
        psi=rng.uniform(-3, 3),
        phi_dot=start.phi_dot,
        psi_dot=start.psi_dot,
    )
    return pack(top, turned)


def judge_departure(*numbers: float) -> Said:
    top, state = unpack(numbers)
    theta, (p, _, spin), largest, (Ix, Iz, Mgl) = look(top, state)
    found = perrys_rule(top, state).reason.theta_ddot_without
    number = (Ix - Iz) * mp.cos(theta) * p * p - Iz * spin * p + Mgl
    terms = (abs(Ix - Iz) * abs(p) + Iz * max(abs(spin), largest)) * abs(p) + abs(Mgl)
    return Said(sign_of(found), number, (START + STATE) * terms)


def draw_no_effect(rng: Numbers) -> Inputs:
    """A hurry by 1.4 changes nothing: phi' and 1.4 phi' lie on both sides of the vertex alike."""
    top = draw_top(rng)
    rates = draw_rates(rng, top) | {"theta": rng.uniform(0.05, 3.1)}
    phi_dot = swing(top) * rng.power(-1, 1)
    spin = (top.Ix - top.Iz) * cos(rates["theta"]) * 2.4 * phi_dot / top.Iz
    return pack(top, State.from_euler(**rates | {"psi_dot": spin}, phi_dot=phi_dot))


def judge_rule(*numbers: float) -> Said:
    top, state = unpack(numbers)
    theta, (p, _, spin), largest, (Ix, Iz, _) = look(top, state)
    reason = perrys_rule(top, state, 1.4).reason
    assert reason.kind in ("if_hurried", "no_effect")
    after = mpf(1.4) * p
    slope = (Ix - Iz) * mp.cos(theta) * (p + after) - Iz * spin
    terms = abs(Ix - Iz) * (abs(p) + abs(after)) + Iz * max(abs(spin), largest)
    sign = {"holds": -1, "fails": 1, None: 0}[reason.rule]
    return Said(sign * sign_of(p), slope, (START + STATE) * terms)


def draw_critical(rng: Numbers) -> Inputs:
    """A top upright at rest with the critical spin."""
    top = draw_top(rng, (1,))
    return pack(
        top, State.from_euler(theta=0.0, psi_dot=rng.choice([-1, 1]) * float(top.critical_spin))
    )


def judge_critical(*numbers: float) -> Said:
    top, state = unpack(numbers)
    Ix, Iz, Mgl = map(mpf, top.moments)
    critical = 2 * mp.sqrt(Ix * Mgl)
    kind = perrys_rule(top, state).reason.kind
    number = Iz * abs(mpf(numbers[-1])) - critical
    # 8 EPS, and the rounding of the critical spin itself.
    return Said(1 if kind == "stable" else -1, number, 9 * EPS * critical)


def draw_cusp(rng: Numbers) -> Inputs:
    """Let go at rest."""
    top = draw_top(rng)
    spin = swing(top) * rng.power(-1, 1.5) * rng.choice([-1, 1])
    theta = rng.uniform(0.2, 2.9)
    state = State.from_euler(phi=rng.uniform(-3, 3), theta=theta, psi=rng.uniform(-3, 3))
    spinning = State(state.orientation, (0.0, 0.0, spin))
    return pack(top, set_precession_rate(spinning, spin * 2.0**-48 * rng.uniform(-1, 1)))


def judge_cusp(*numbers: float) -> Said | None:
    top, state = unpack(numbers)
    theta, (phi_dot, *_), _, (Ix, Iz, Mgl) = look(top, state)
    motion = Motion(top, state)
    away = float(motion.at(motion.nutation_period / 2).euler_rates.phi_dot)
    sign = {"looping": -1, "cusps": 0, "unidirectional": 1}[motion.kind]
    spin = Iz / Ix * abs(mpf(numbers[-1]))
    # Of the terms of sin(theta)^2 phi' during a nutation: the axis is never faster than a pendulum.
    return Said(
        sign,
        phi_dot * mp.sin(theta) ** 2 * sign_of(away),
        START * (2 * mp.sqrt(abs(Mgl) / Ix) + spin),
    )


def judge_rest(*numbers: float) -> Said | None:
    top, state = unpack(numbers)
    _, (_, theta_dot, _), _, _ = look(top, state)
    across = mp.sqrt(mpf(numbers[-3]) ** 2 + mpf(numbers[-2]) ** 2)
    sign = 0 if clamp_verdict(top, state).kind == "falls" else 1
    return Said(sign, abs(theta_dot), 1.001 * START * across)


def draw_constants(rng: Numbers) -> Inputs:
    """Constants of a regular precession."""
    numbers = draw_regular(rng)
    top, state = unpack(numbers)
    constants = top.energy(state), top.vertical_momentum(state), top.axial_momentum(state)
    return (*top.moments, *map(float, constants))


def judge_constants(*numbers: float) -> Said:
    Ix, Iz, Mgl, energy, p_phi, p_psi = map(mpf, numbers)

    def find_potential(theta: mpf) -> mpf:
        turn = (p_phi - p_psi * mp.cos(theta)) / mp.sin(theta)
        return turn * turn / (2 * Ix) + Mgl * mp.cos(theta)

    try:
        starts = solve_start(
            Top(*numbers[:3]), **dict(zip(("energy", "p_phi", "p_psi"), numbers[3:], strict=True))
        )
    except RefusedError:
        starts = ()
    begin = mpf(starts[0].theta) if starts else find_bottom(numbers)
    bottom = mp.findroot(lambda theta: mp.diff(find_potential, theta), begin)
    along = p_psi * p_psi / (2 * Iz)
    number = energy - along - find_potential(bottom)
    return Said(len(starts) - 1, number, 1.001 * START * (abs(energy) + along + abs(Mgl)))


def find_bottom(numbers: Inputs) -> mpf:
    """The tilt of the least energy, from the refusal."""
    Ix, Iz, Mgl, energy, p_phi, p_psi = numbers
    (start, *_) = solve_start(
        Top(Ix, Iz, Mgl), energy=energy + 1e-9 * abs(energy), p_phi=p_phi, p_psi=p_psi
    )
    return mpf(start.theta)


BOUNDARIES = {
    "no precession": Boundary(draw_no_precession, judge_precession),
    "theta'' = 0": Boundary(draw_regular, judge_departure),
    "a hurry without effect": Boundary(draw_no_effect, judge_rule),
    "the critical spin": Boundary(draw_critical, judge_critical),
    "cusps": Boundary(draw_cusp, judge_cusp),
    "clamped at rest": Boundary(draw_regular, judge_rest),
    "the least energy": Boundary(draw_constants, judge_constants),
}


def move(rng: Numbers, numbers: Inputs) -> Inputs:
    """Numbers that are some last places away; what is zero stays."""

    def step(number: float) -> float:
        places = rng.randint(-PLACES, PLACES)
        for _ in range(abs(places) if number else 0):
            number = float(np.nextafter(number, math.copysign(math.inf, places)))
        return number

    return tuple(map(step, numbers))


@pytest.mark.parametrize("seed", seeds(1, MANY // FEW))
@pytest.mark.parametrize("name", BOUNDARIES)
def test_what_is_said_is_true_of_the_start_or_of_one_of_its_neighbours(name, seed):
    boundary = BOUNDARIES[name]
    rng = Numbers(f"{name} {seed}")
    with mp.workdps(DIGITS):
        for _ in range(FEW):
            numbers = move(rng, boundary.draw(rng))
            said = boundary.judge(*numbers)
            assert said is None or said.is_true_nearby(), (numbers, said)


@pytest.mark.parametrize("name", ["no precession", "theta'' = 0", "the least energy"])
def test_both_sides_of_a_boundary_are_said_to_be_on_it(name):
    # What was drawn on the boundary is so close to it that all of it counts as on it.
    boundary = BOUNDARIES[name]
    rng = Numbers(f"on {name}")
    with mp.workdps(DIGITS):
        said = [boundary.judge(*boundary.draw(rng)) for _ in range(FEW)]
    assert [each.sign for each in said] == [0] * FEW
    assert {sign_of(each.number) for each in said} >= {-1, 1}
