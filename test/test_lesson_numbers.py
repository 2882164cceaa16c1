"""Every number with decimals in the lesson is one that its motions have, with the digits shown."""

import re
from functools import cache

import numpy as np
import pytest
from by_hand import follow_by_hand
from scipy.optimize import brentq, minimize_scalar

from symtop_ros.base.measured import write_measured
from symtop_ros.page.web.join import read_record
from symtop_ros.physics import (
    Body,
    EffectivePotential,
    Motion,
    Pushes,
    State,
    gimbal_shares,
    hurry,
    precessing_frame_torques,
    push_axle,
)
from symtop_ros.physics import regular_precession_rates as find_roots
from symtop_ros.run.simulation.changes.outcomes import Pushed
from symtop_ros.truth.fit.main import describe_record, make_parser
from symtop_ros.truth.fit.plan_options import make_plan
from symtop_ros.truth.fit.plan_report import PlanReport
from symtop_ros.truth.fit.report import Report
from symtop_ros.truth.fit.runs import make_run
from workshop.article.answers.impulses import find_impulses, torques_at
from workshop.article.answers.ledger import hurry_ledger
from workshop.article.motions import FAST, HANGING_DISC, HURRIED, SLOW, TOP
from workshop.article.nutation import times_of_extreme_rate
from workshop.article.pivot import SHORT_ARM
from workshop.lesson.euler import Tilted, count_steps, fall
from workshop.lesson.example import fit_example, write_content
from workshop.lesson.pictures import read_motion
from workshop.lesson.steps import read_lesson

THETA, SPIN, FACTOR = 0.5, 200.0, 1.4
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+\.\d+(?!\w)")
PUSH = max(np.roots([TOP.Iz * np.cos(THETA), TOP.Iz * SPIN, -2 * TOP.Mgl]))
SLOW_STATE = State.from_euler(theta=THETA, phi_dot=SLOW, psi_dot=SPIN)
FAST_STATE = State.from_euler(theta=THETA, phi_dot=FAST, psi_dot=SPIN)
DISC_SPIN = -25.0
PUSHES = Pushes(5e-5, 20.0, 20)


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
    fastest = motion.at(period / 2).euler_rates.phi_dot
    return [
        f"{1e3 * (fell - THETA):.3f}",
        f"{1e3 * first:.4f}",
        f"{1e3 * (lower - THETA):.1f}",
        f"{1e3 * later:.1f}",
        f"{period:.2f}",
        f"{10 * period:.1f}",
        f"{fastest:.1f}",
    ]


def depths():
    p_psi = TOP.Iz * SPIN
    lowest = start(0.0).turning_angles[1]
    slow, fast = (start(0.0, spin).turning_angles for spin in (150.0, 300.0))
    return [
        f"{p_psi:.5f}",
        f"{p_psi**2 / (2 * TOP.Ix * TOP.Mgl):.2f}",
        f"{np.cos(lowest):.3f}",
        f"{lowest:.3f}",
        *(f"{angle:.2f}" for angle in (*slow, *fast)),
        f"{lowest:.4f}",
    ]


def slow_root():
    size, flat, lean = momentum(SLOW_STATE)
    L, (torque, _, _) = TOP.angular_momentum(SLOW_STATE), TOP.gravity_torque(SLOW_STATE)
    turned = np.cross(SLOW_STATE.to_world(SLOW_STATE.angular_velocity), L)[0]
    turn = 2 * np.pi / SLOW
    return [
        f"{SLOW:.2f}",
        f"{turn:.2f}",
        f"{10 * turn:.1f}",
        f"{size:.4f}",
        f"{lean:.2f}",
        f"{flat:.5f}",
        f"{torque:.4f}",
        f"{torque / flat:.2f}",
        f"{TOP.Mgl / (TOP.Iz * SPIN):.2f}",
        f"{torque - turned:+.3f}",
        f"{turned:+.3f}",
        f"{torque:+.3f}",
    ]


def fast_root():
    size, flat, lean = momentum(FAST_STATE)
    torque = TOP.gravity_torque(FAST_STATE)[0]
    body = Body.from_top(TOP)
    friction = np.sin(THETA) * FAST**2 / body.gravity  # that a peg needs, for an arm of 1 m
    return [
        f"{torque:.4f}",
        f"{FAST:.1f}",
        f"{2 * np.pi / FAST:.3f}",
        f"{size:.4f}",
        f"{momentum(SLOW_STATE)[0]:.4f}",
        f"{lean:.2f}",
        f"{flat:.6f}",
        f"{torque / flat:.1f}",
        f"{1e3 * SHORT_ARM:.1f}",
        f"{SHORT_ARM * friction:.2f}",
        f"{TOP.Mgl / (body.gravity * SHORT_ARM):.2f}",
        f"{1e3 / friction:.1f}",
        f"{1e3 * body.arm:.1f}",
        f"{body.arm * friction:.1f}",
        f"{body.mass:.3f}",
    ]


def three_pushes():
    def at_top(push):
        motion = start(push)
        return motion.at(motion.nutation_period / 2).euler_rates.phi_dot

    highest = start(PUSH).turning_angles[0]
    p_psi = TOP.Iz * (SPIN + PUSH * np.cos(THETA))
    return [
        f"{PUSH:.3f}",
        f"{at_top(9.0):.2f}",
        f"{highest:.3f}",
        f"{at_top(20.0):.1f}",
        f"{p_psi:.4f}",
        f"{np.cos(highest):.3f}",
        f"{at_top(11.325):.4f}",
    ]


def below_and_above():
    down, up = start(3.0).turning_angles[1], start(9.0).turning_angles[0]
    first, second = begin_alike()
    period = first.nutation_period
    # the one that began downwards is at the start of the other when it first rises through theta
    later = brentq(lambda t: first.at(t).euler_angles.theta - THETA, 0.1 * period, 0.9 * period)
    return [
        *(f"{SLOW:.2f}", f"{THETA:.1f}", f"{down:.3f}", f"{up:.3f}"),
        *(f"{angle:.3f}" for angle in second.turning_angles),
        *(f"{period:.3f}", f"{later:.3f}"),
    ]


def begin_alike():
    """Two motions with equal constants, which begin downwards and upwards."""
    rates = {"theta": THETA, "phi_dot": 6.0, "psi_dot": SPIN}
    return [Motion(TOP, State.from_euler(theta_dot=rate, **rates)) for rate in (2.0, -2.0)]


def hurry_on():
    found = hurry_ledger(TOP, HURRIED["slow_root"], "spin_rate")
    heights = (hurried(SLOW_STATE, hold)[0] for hold in ("spin_rate", "spin_momentum"))
    energies = (found.far.weight, found.kick.rest, -found.far.precession)
    return [
        f"{FACTOR:.1f}",
        f"{found.kick.spin:.1f}",
        *(f"{height:.3f}" for height in heights),
        *(f"{energy:.2f}" for energy in energies),
    ]


def observer():
    torques = [precessing_frame_torques(TOP, THETA, r, SPIN) for r in (SLOW, 9.0, FAST, 73.0)]
    return [
        f"{TOP.Mgl * np.sin(THETA):.4f}",
        *(f"{each:.4f}" for t in torques for each in (t.coriolis, t.centrifugal)),
        *(f"{t.total:.4f}" for t in torques[1::2]),
        f"{(SLOW + FAST) / 2:.1f}",
    ]


def disc():
    slow, fast = find_roots(HANGING_DISC, THETA, DISC_SPIN)
    states = [State.from_euler(theta=THETA, phi_dot=r, psi_dot=DISC_SPIN) for r in (slow, fast)]
    fallen = hurried(states[0], "spin_rate", HANGING_DISC)[1]
    risen = hurried(states[1], "spin_rate", HANGING_DISC)[0]
    pushed = hurried(states[1], "spin_momentum", HANGING_DISC)[1]
    return [f"{fast:.2f}", *(f"{angle:.3f}" for angle in (THETA, fallen, risen, pushed))]


def one_fall():
    motion = start(0.0)
    fastest = times_of_extreme_rate(motion)[0]
    half = motion.nutation_period / 2
    moved, taken = (find_impulses(motion, time) for time in (fastest, half))
    gravity, coriolis, centrifugal = torques_at(motion, [half])[:, 0]
    return [
        *(f"{1e3 * each:+.3f}" for each in (*moved, moved.total, *taken)),
        f"{1e3 * fastest:.1f}",
        f"{moved.total / TOP.Ix:.2f}",
        *(f"{each:.3f}" for each in (gravity, coriolis, -coriolis, centrifugal)),
    ]


def precession_energy(state):
    """Energy of the precession in mJ."""
    return 500 * TOP.Ix * (state.euler_rates.phi_dot * np.sin(state.euler_angles.theta)) ** 2


def pushed_along():
    numbers = [f"{precession_energy(SLOW_STATE):.2f}"]
    pushes = PUSHES
    numbers += [f"{pushes.impulse:.5f}", f"{TOP.axial_momentum(SLOW_STATE):.5f}"]
    numbers += [f"{TOP.vertical_momentum(SLOW_STATE):.5f}"]
    for state, form in ((SLOW_STATE, ".2f"), (FAST_STATE, ".1f")):
        motion = Motion(TOP, push_axle(TOP, state, pushes.impulse), pushes=pushes)
        found = Pushed.of(motion, pushes, state)
        last = motion.piece_at(1.0).motion
        numbers += [f"{angle:.3f}" for angle in (*found.turning_angles, THETA)]
        numbers += [f"{found.work:.3g}", f"{found.weight.amount:.2f}"]
        added = TOP.vertical_momentum(last.start) - TOP.vertical_momentum(state)
        numbers += [f"{added:.6f}", f"{find_bottom(last):.4f}"]
        numbers += [f"{rate:{form}}" for rate in (found.means.before, found.means.after)]
        if state is SLOW_STATE:
            nutation = last.at(np.arange(256) / 256 * last.nutation_period)
            numbers.append(f"{precession_energy(nutation).mean():.2f}")
    for sum_of_pushes, tilt in follow_by_hand(SLOW)[2]:
        numbers += [f"{sum_of_pushes:.6f}", f"{tilt:.4f}"]
    return [*numbers, f"{follow_by_hand(FAST)[2][1][1]:.3f}"]


def find_bottom(motion):
    """The bottom of the valley of the effective potential, in rad."""
    potential = EffectivePotential.from_state(TOP, motion.start)
    found = minimize_scalar(lambda theta: float(potential.at(theta)), motion.turning_angles)
    return found.x


def held():
    motion = Motion(TOP, SLOW_STATE, clamped=True)
    half = motion.nutation_period / 2
    shares = gimbal_shares(motion.added_torque(motion.at(half)))
    assert abs(shares.ring) < 1e-9  # the hand feels nothing
    return [f"{half:.2f}", f"{10 * half:.1f}", f"{shares.stand:.3f}"]


@cache
def fitted():
    return fit_example()


def unseen_spin():
    fit = fitted()
    values = {each.name: each for each in Report("record", 240, fit, {}).values}
    measured = (values[name] for name in ("mean_precession_rate", "Mgl/Ix", "p_psi/Ix"))
    motion = make_run(fit, 240, {}).motion
    spin = motion.start.angular_velocity[2]
    ends = [f"{angle:.3f}" for angle in motion.turning_angles]
    highest = minimize_scalar(
        lambda t: motion.at(t).euler_angles.theta,
        bounds=np.array([0.5, 1.5]) * motion.nutation_period,
        method="bounded",
    ).x
    instants = highest, highest + motion.nutation_period / 2
    rates = [f"{motion.at(t).euler_rates.phi_dot:.2f}" for t in instants]
    momentum, weight = solve_by_hand(*map(float, (*ends, *rates)))
    assert f"Mgl/Ix = {weight:.0f} 1/s^2" in STEPS[14].seen
    return [
        *(text for each in measured for text in write_measured(each.value, each.deviation)),
        f"{fit.residuals.std():.4f}",
        *(f"{each:.1f}" for each in (spin, 2 * spin)),
        *ends,
        *rates,
        f"{momentum:.1f}",
        *plan_starts(),
    ]


def solve_by_hand(high, low, slow, fast):
    """p_psi/Ix and Mgl/Ix of the tilts and rates at the highest and the lowest point."""
    matrix = np.cos([high, low])
    sines = np.sin([high, low]) ** 2
    rates = np.array([slow, fast])
    momentum = np.diff(rates * sines) / -np.diff(matrix)
    weight = np.diff(rates**2 * sines / 2) / -np.diff(matrix)
    return float(momentum[0]), float(weight[0])


def plan_starts():
    """The deviations of p_psi/Ix of two starts, and how far the second is off."""
    words = STEPS[14].also[0].split()
    assert words[:2] == ["top_fit", "--plan"]
    options = make_parser().parse_args(words[1:])
    plan = make_plan(options, options.kind, describe_record(options.kind, options))
    starts = PlanReport("", plan, {}).facts()["starts"]
    (rest,) = (each for each in starts if each["kind"] in ("given", "rest"))
    nearest = min((each for each in starts if each["kind"] == "off"), key=lambda each: each["off"])
    return [
        f"{rest['deviation']:.2g}",
        f"{nearest['deviation']:.2g}",
        f"{nearest['off']:g}",
    ]


NUMBERS = {1: let_go, 3: depths, 4: slow_root, 5: fast_root, 6: three_pushes, 7: below_and_above}
NUMBERS |= {8: hurry_on, 10: observer, 11: disc, 12: one_fall, 13: pushed_along, 14: held}
NUMBERS |= {15: unseen_spin}


STEPS = read_lesson()


@pytest.mark.parametrize("number", range(1, len(STEPS) + 1))
def test_the_numbers_of_a_step_are_those_of_its_motions(number):
    """Numbers without decimals are those of the buttons, and tested elsewhere."""
    step = STEPS[number - 1]
    texts = (step.predict, step.compute, step.look, step.seen, step.question, step.answer)
    shown = {each for text in texts for each in NUMBER.findall(text)}
    computed = set(NUMBERS[number]()) if number in NUMBERS else set()
    given = {"0.5", "0.000228", "0.0000572", "0.068"}  # starts and tops
    assert shown - given == computed - given


def test_the_steps_of_the_table_are_those_that_eulers_scheme_takes():
    step, depth = STEPS[2], start(0.0).turning_angles[1]
    begin = Tilted(THETA, 0.0, 0.0, SPIN)
    counts = count_steps(TOP, begin, depth, len(step.table.rows))
    found = [(each.digits, each.dt, each.steps, round(each.theta, 5)) for each in counts]
    assert [*step.table.rows] == found
    # of first order, so that a tenth of the step leaves a tenth of the error
    errors = [fall(TOP, begin, dt)[1] - depth for dt in (1e-4, 1e-5)]
    assert errors[0] / errors[1] == pytest.approx(10, rel=0.01)


def test_eulers_scheme_has_the_accelerations_of_the_motion():
    here = {"theta_dot": 1.0, "phi_dot": 3.0, "psi_dot": 150.0}
    motion = Motion(TOP, State.from_euler(theta=0.6, **here))
    span = 1e-5  # s; the rates change like sines of 200 rad/s at most
    before, after = (motion.at(t).euler_rates for t in (-span, span))
    changes = [(getattr(after, name) - getattr(before, name)) / (2 * span) for name in here]
    assert Tilted(0.6, *here.values()).accelerate(TOP) == pytest.approx(changes, rel=1e-6)


def test_the_numbers_that_are_asked_for_are_those_of_the_motions():
    asked = {number: step.ask for number, step in enumerate(STEPS, start=1) if step.ask}
    last = Motion(TOP, push_axle(TOP, SLOW_STATE, PUSHES.impulse), pushes=PUSHES).piece_at(1.0)
    right = {3: start(0.0).turning_angles[1], 13: find_bottom(last.motion)}
    assert {number: ask["value"] for number, ask in asked.items()} == pytest.approx(right, abs=5e-5)


def test_two_rounds_by_hand_find_the_bottom_of_the_valley():
    """As step 13 says: the sine at the start, then halfway, and phi' unchanged."""
    found = [tilt for _, tilt in follow_by_hand(SLOW)[2]]
    ask = STEPS[12].ask
    assert [abs(each - ask["value"]) <= ask["within"] for each in found] == [False, True]


def test_equal_constants_make_one_band_and_shifted_curves():
    first, second = begin_alike()
    for constant in (TOP.energy, TOP.vertical_momentum, TOP.axial_momentum):
        assert constant(first.start) == constant(second.start)
    assert first.turning_angles == second.turning_angles
    shift = float(below_and_above()[-1])  # s, to three decimals
    times = np.linspace(0.0, 1.0, 50)
    later = first.at(times + shift).euler_angles.theta
    fastest = np.abs(second.at(times).euler_rates.theta_dot).max()
    assert np.abs(later - second.at(times).euler_angles.theta).max() < 5e-4 * fastest * 1.1


def test_the_run_of_the_record_is_what_the_fit_of_the_example_gives():
    """Else: python -m workshop.lesson.example."""
    kept, fresh = read_record(1), write_content()
    assert kept["points"]["times"] == fresh["points"]["times"]
    assert kept["points"]["values"] == fresh["points"]["values"]
    left = [np.array(each["points"]["residuals"]) for each in (kept, fresh)]
    # a search ends within a hundredth of a deviation of the least, and that is 0.07 of the noise
    assert np.abs(left[0] - left[1]).max() < 1e-3 * left[0].std()
    (event,), (again,) = kept["events"], fresh["events"]
    assert event["top"] == pytest.approx(again["top"], rel=1e-5)
    assert event["angular_velocity"][2] == pytest.approx(again["angular_velocity"][2], rel=1e-5)


def test_twice_the_spin_moves_the_axle_alike():
    motions = [read_motion(spin) for spin in (1, 2)]
    times = np.array(read_record(1)["points"]["times"])
    first, second = (each.at(times) for each in motions)
    axes = [each.to_world([0.0, 0.0, 1.0]) for each in (first, second)]
    # of phases up to 700 rad, through a dozen roundings
    assert np.abs(axes[0] - axes[1]).max() < 1e-11
    spins = [each.start.angular_velocity[2] for each in motions]
    assert spins[1] == 2 * spins[0]
    assert motions[0].top.Iz == 2 * motions[1].top.Iz
