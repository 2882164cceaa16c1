"""Every number with decimals in the lesson is one that its motions have, with the digits shown."""

import re

import numpy as np
import pytest

from symtop_ros.physics import Body, Motion, State, hurry, precessing_frame_torques, push_axle
from symtop_ros.physics import regular_precession_rates as find_roots
from symtop_ros.simulation.changes.outcomes import Pushed
from symtop_ros.simulation.segment import PushedMotion, Pushes
from workshop.article.answers.impulses import find_impulses, torques_at
from workshop.article.answers.ledger import hurry_ledger
from workshop.article.motions import FAST, HANGING_DISC, HURRIED, SLOW, TOP
from workshop.article.nutation import times_of_extreme_rate
from workshop.article.pivot import SHORT_ARM
from workshop.lesson.steps import read_lesson

THETA, SPIN, FACTOR = 0.5, 200.0, 1.4
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+\.\d+(?!\w)")
PUSH = max(np.roots([TOP.Iz * np.cos(THETA), TOP.Iz * SPIN, -2 * TOP.Mgl]))
SLOW_STATE = State.from_euler(theta=THETA, phi_dot=SLOW, psi_dot=SPIN)
FAST_STATE = State.from_euler(theta=THETA, phi_dot=FAST, psi_dot=SPIN)
DISC_SPIN = -25.0


def start(phi_dot, spin=SPIN, top=TOP):
    return Motion(top, State.from_euler(theta=THETA, phi_dot=phi_dot, psi_dot=spin))


def hurried(state, hold, top=TOP):
    """The turning angles after a hurry."""
    return Motion(top, hurry(state, FACTOR, hold)).turning_angles


def momentum(state):
    """Size, horizontal part and lean of the angular momentum."""
    x, y, z = TOP.angular_momentum(state)
    return np.sqrt(x * x + y * y + z * z), np.hypot(x, y), np.arctan2(np.hypot(x, y), z)


def let_go():
    motion = start(0.0)
    (first, fell, _), (later, lower, _) = (motion.at(t).euler_angles for t in (1e-3, 1e-2))
    period = motion.nutation_period
    angles = (fell - THETA, first, lower - THETA, later)
    return [*(1e3 * each for each in angles), period, 10 * period, fastest_rate(motion)]


def fastest_rate(motion):
    """The precession rate in the middle of a nutation from a turning angle."""
    return motion.at(motion.nutation_period / 2).euler_rates.phi


def depths():
    p_psi, lowest = TOP.Iz * SPIN, start(0.0).turning_angles[1]
    slow, fast = (start(0.0, spin).turning_angles for spin in (150.0, 300.0))
    return [p_psi, p_psi**2 / (2 * TOP.Ix * TOP.Mgl), np.cos(lowest), lowest, *slow, *fast]


def slow_root():
    size, flat, lean = momentum(SLOW_STATE)
    L, (torque, _, _) = TOP.angular_momentum(SLOW_STATE), TOP.gravity_torque(SLOW_STATE)
    turned = np.cross(SLOW_STATE.to_world(SLOW_STATE.angular_velocity), L)[0]
    turn, rates = 2 * np.pi / SLOW, (SLOW, torque / flat, TOP.Mgl / (TOP.Iz * SPIN))
    return [*rates, turn, 10 * turn, size, lean, flat, torque, torque - turned, turned]


def fast_root():
    size, flat, lean = momentum(FAST_STATE)
    torque, body = TOP.gravity_torque(FAST_STATE)[0], Body.of(TOP)
    friction = np.sin(THETA) * FAST**2 / body.gravity  # that a peg needs, for an arm of 1 m
    momenta = (size, momentum(SLOW_STATE)[0], lean, flat)
    arms = (1e3 * SHORT_ARM, SHORT_ARM * friction, 1e3 / friction)
    arms += (1e3 * body.arm, body.arm * friction)
    return [torque, FAST, 2 * np.pi / FAST, *momenta, torque / flat, *arms, body.mass]


def three_pushes():
    highest = start(PUSH).turning_angles[0]
    p_psi = TOP.Iz * (SPIN + PUSH * np.cos(THETA))
    rates = (fastest_rate(start(push)) for push in (9.0, 20.0, 11.325))
    return [PUSH, *rates, highest, p_psi, np.cos(highest)]


def below_and_above():
    return [SLOW, THETA, start(3.0).turning_angles[1], start(9.0).turning_angles[0]]


def hurry_on():
    found = hurry_ledger(TOP, HURRIED["slow_root"], "spin_rate")
    heights = (hurried(SLOW_STATE, hold)[0] for hold in ("spin_rate", "spin_momentum"))
    energies = (found.far.weight, found.kick.rest, -found.far.precession)
    return [FACTOR, found.kick.spin, *heights, *energies]


def observer():
    torques = [precessing_frame_torques(TOP, THETA, r, SPIN) for r in (SLOW, 9.0, FAST, 73.0)]
    parts = (each for t in torques for each in (t.coriolis, t.centrifugal))
    sums = (t.total for t in torques[1::2])
    return [TOP.Mgl * np.sin(THETA), *parts, *sums, (SLOW + FAST) / 2]


def disc():
    slow, fast = find_roots(HANGING_DISC, THETA, DISC_SPIN)
    states = [State.from_euler(theta=THETA, phi_dot=r, psi_dot=DISC_SPIN) for r in (slow, fast)]
    fallen = hurried(states[0], "spin_rate", HANGING_DISC)[1]
    risen = hurried(states[1], "spin_rate", HANGING_DISC)[0]
    return [fast, THETA, fallen, risen, hurried(states[1], "spin_momentum", HANGING_DISC)[1]]


def one_fall():
    motion = start(0.0)
    fastest, half = times_of_extreme_rate(motion)[0], motion.nutation_period / 2
    moved, taken = (find_impulses(motion, time) for time in (fastest, half))
    gravity, coriolis, centrifugal = torques_at(motion, [half])[:, 0]
    impulses = (1e3 * each for each in (*moved, moved.total, *taken))
    torques = (gravity, coriolis, -coriolis, centrifugal)
    return [*impulses, 1e3 * fastest, moved.total / TOP.Ix, *torques]


def precession_energy(state):
    """Energy of the precession in mJ."""
    return 500 * TOP.Ix * (state.euler_rates.phi * np.sin(state.euler_angles.theta)) ** 2


def pushed_along():
    values, pushes = [THETA, precession_energy(SLOW_STATE)], Pushes(5e-5, 20.0, 20)
    for state in (SLOW_STATE, FAST_STATE):
        motion = PushedMotion(TOP, push_axle(TOP, state, pushes.impulse), pushes)
        found, last = Pushed.of(motion, state), motion.pieces[-1]
        values += [*found.turning_angles, found.work, found.weight.amount]
        values += [found.means.before, found.means.after]
        if state is SLOW_STATE:
            nutation = last.at(np.arange(256) / 256 * last.nutation_period)
            values.append(precession_energy(nutation).mean())
    return values


GIVEN = {"0.5", "0.000228", "0.0000572", "0.068"}  # starts and tops
NUMBERS = {
    1: let_go,
    3: depths,
    4: slow_root,
    5: fast_root,
    6: three_pushes,
    7: below_and_above,
    8: hurry_on,
    10: observer,
    11: disc,
    12: one_fall,
    13: pushed_along,
}


@pytest.mark.parametrize(
    ("number", "step"),
    [*enumerate(read_lesson(), 1)],
    ids=lambda each: str(getattr(each, "title", each)),
)
def test_the_numbers_of_a_step_are_those_of_its_motions(number, step):
    """Numbers without decimals are those of the buttons, and tested elsewhere."""
    texts = (step.predict, step.compute, step.look, step.seen, step.question, step.answer)
    shown = {each for text in texts for each in NUMBER.findall(text)} | GIVEN
    values = [*map(float, NUMBERS[number]() if number in NUMBERS else [])]
    pairs = [(text, value) for text in shown for value in values if shows(text, value)]
    assert shown - {text for text, _ in pairs} <= GIVEN
    assert set(values) == {value for _, value in pairs}


def shows(text, value):
    """Return if a text is a number rounded to as many decimals."""
    sign, decimals = "+" * text.startswith("+"), len(text.partition(".")[2])
    return text == f"{value:{sign}.{decimals}f}"
