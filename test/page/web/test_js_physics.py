"""The states, records and sentences of the page, from the kernel, are those of Python."""

import dataclasses
import math
import random
import re

import numpy as np
import pytest
from page.web.page_words import write_as_page
from physics.tops import find_roots
from trials import trials

from symtop_ros import physics
from symtop_ros.physics import Top, regular_precession_rates, theta_acceleration
from symtop_ros.physics.values import EPS
from symtop_ros.run.session.diagnostics import constants_of_motion

HOLDS = "spin_rate", "spin_momentum"
ARTICLE = {"Ix": 0.000228, "Iz": 0.0000572, "Mgl": 0.068}


def list_cases(count):
    """Random starts and kicks, and those that decide: at rest, steady, vertical, upside down."""
    rng = random.Random("cases of the page")
    for n in range(count):
        top = ARTICLE
        if n % 2:
            Ix = 10 ** rng.uniform(-5, 0)
            Iz = Ix * rng.choice([rng.uniform(0.05, 2.0), 1.0, 2.0])
            Mgl = rng.choice([1, 1, -1, 0]) * 10 ** rng.uniform(0, 2) * Ix
            top = {"Ix": Ix, "Iz": Iz, "Mgl": Mgl}
        scale = math.sqrt(abs(top["Mgl"]) / top["Ix"]) or 1.0
        theta = rng.choice([rng.uniform(0, math.pi), 0.5, math.pi / 2, 1e-6])
        spin = rng.choice([0.0, rng.uniform(-10, 10) * scale, 200.0])
        roots = find_roots(physics.Top(**top), theta, spin)
        phi_dot = rng.choice([0.0, rng.uniform(-3, 3) * scale, *roots])
        angles = {"phi": rng.uniform(-3, 3), "theta": theta, "psi": rng.choice([0.0, 1.5, 300.0])}
        rates = {"phi": phi_dot, "theta": rng.choice([0.0, 0.0, scale * 0.1]), "psi": spin}
        kick = make_kick(rng, top, phi_dot, scale)
        yield {"top": top, "angles": angles, "rates": rates, "kick": kick}


def make_kick(rng, top, phi_dot, scale):
    kind = rng.choice(["factor", "factor", "rate", "impulse"])
    if kind == "impulse":
        impulse = [top["Ix"] * scale * rng.choice([0.0, rng.uniform(-2, 2)]) for _ in range(3)]
        return {"kind": kind, "value": impulse}
    value = rng.choice([1.4, 1 / 1.4, 1.0, -1.0, 2.5])
    if kind == "rate":
        value = rng.choice([phi_dot + scale, 0.0, rng.uniform(-3, 3) * scale])
    return {"kind": kind, "value": value, "hold": rng.choice(HOLDS)}


def kick_in_python(top, state, kick):
    if kick["kind"] == "impulse":
        return physics.apply_impulse(top, state, kick["value"])
    change = physics.hurry if kick["kind"] == "factor" else physics.set_precession_rate
    return change(state, kick["value"], kick["hold"])


def judge_in_python(case):
    top = physics.Top(**case["top"])
    kick = case["kick"]
    start = case["angles"] | {f"{name}_dot": rate for name, rate in case["rates"].items()}
    state = physics.State.from_euler(**start)
    after = kick_in_python(top, state, kick)
    verdict = physics.perrys_rule(top, state, hold=kick.get("hold", "spin_momentum"))
    record = physics.kick_verdict(physics.Motion(top, after), state, kick.get("hold"))
    return {
        "start": np.concatenate(state._parts).tolist(),
        "after": np.concatenate(after._parts).tolist(),
        "angles": state.euler_angles._asdict(),
        "rates": dict(zip(physics.Angles._fields, state.euler_rates, strict=True)),
        "verdict": dataclasses.asdict(verdict),
        "record": dataclasses.asdict(record),
        "texts": [
            write_as_page(name, each, variant)
            for variant in ("radians", "degrees")
            for name, each in (("verdict", verdict), ("kick", record))
        ],
        "regular": find_roots(top, start["theta"], start["psi_dot"]),
    }, draw_in_python(top, state)


def draw_in_python(top, state):
    """Return what the page draws in its doubles, each with the size of its largest term."""
    theta = state.euler_angles.theta
    phi, _, psi = state.euler_rates
    torques = physics.precessing_frame_torques(top, theta, phi, psi)
    torque = abs(top.Mgl) + (top.Iz * abs(psi) + (top.Ix + top.Iz) * abs(phi)) * abs(phi)
    fastest = float(np.abs(state.angular_velocity).max())
    momentum = (top.Ix + top.Iz) * fastest
    energy = abs(top.Mgl) + momentum * fastest
    potential = physics.EffectivePotential.from_state(top, state)
    heights = potential.at([0.3, 1.0, 2.5]).tolist()
    return {
        "world": (state.to_world(state.angular_velocity).tolist(), 2 * fastest),
        "torques": ([*map(float, torques), float(torques.total)], torque),
        "constants": ([*constants_of_motion(top, state).values()], max(energy, momentum)),
        "pivot": find_pivot_force(top, state, fastest),
        "potential": ([*heights, potential.energy], max(map(abs, heights)) + energy),
    }


MASS, GRAVITY = 2.0, 9.75  # kg, m/s^2: of the body whose pivot is asked


def find_pivot_force(top, state, fastest):
    """Return the size of the force and its part along the vertical, and the size of its terms."""
    arm = (0.0, 0.0, top.Mgl / (MASS * GRAVITY))
    felt = physics.specific_force(physics.Motion(top, state), state, arm, GRAVITY)
    force = MASS * state.to_world(felt)
    turning = fastest * fastest * (1 + top.Iz / top.Ix) + abs(top.Mgl) / top.Ix
    terms = abs(top.Mgl) / GRAVITY * turning + MASS * GRAVITY
    return [math.hypot(*force), float(force[2])], 4 * terms


def to_json(value):
    """Return a record in the form of the page's answer: lists, bits of doubles, and no NaN."""
    if isinstance(value, dict):
        return {name: to_json(each) for name, each in drop_nan(value).items()}
    if isinstance(value, list | tuple):
        return [to_json(each) for each in value]
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    return float(value).hex() if math.isfinite(value) else None


def drop_nan(record):
    """Return a record of Python as the page has it: without regular rates that there are not."""
    rates = record.get("regular_rates", [])
    there = [rate for rate in rates if math.isfinite(rate)]
    return record | ({"regular_rates": there} if rates else {})


# Signs of zero, a norm that is not 1, one that is to rounding, and what is too small to be squared.
ODD_STATES = [
    ((-0.8, 0.6, 0.0, -0.0), (1.0, 2.0, 200.0)),
    ((-0.8, -0.0, 0.6, 0.0), (-0.0, 0.0, -0.0)),
    ((0.8 * 1.0005, 0.0, 0.6 * 1.0005, -0.0), (1.0, 2.0, 200.0)),
    ((0.8, 0.6 + 2**-52, 0.0, 0.0), (1.0, 0.0, 200.0)),
    ((-0.8, 0.6, 0.0, -1e-120), (-1e-130, 2.0, 200.0)),
]


def test_a_state_has_the_doubles_that_the_kernel_takes(tab):
    for (q, omega), found in zip(ODD_STATES, tab.evaluate("takeStates", ODD_STATES), strict=True):
        state = physics.State(q, omega)
        angles = state.euler_angles._asdict()
        rates = dict(zip(angles, state.euler_rates, strict=True))
        wanted = [
            list(q),
            state.orientation.tolist(),
            state.angular_velocity.tolist(),
            angles,
            rates,
        ]
        assert to_json(found) == to_json(wanted), q


def test_a_state_without_norm_1_is_refused(tab):
    with pytest.raises(Exception, match="orientation must be a quaternion of norm 1"):
        tab.evaluate("takeStates", [((0.9, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))])


@pytest.mark.slow
@pytest.mark.parametrize("count", trials(100, 400))
def test_kicks_records_and_sentences_are_those_of_python(tab, count):
    cases = list(list_cases(count))
    kinds = set()
    for case, found in zip(cases, tab.evaluate("judgeCases", cases), strict=True):
        wanted, drawn = judge_in_python(case)
        for name, (values, size) in drawn.items():
            close = pytest.approx(values, rel=4 * EPS, abs=4 * EPS * size)
            assert found["drawn"][name] == close, (name, case)
        for name, value in to_json(wanted).items():
            assert to_json(found[name]) == value, (name, case)
        kinds.add(wanted["record"]["reason"]["kind"])
    assert len(kinds) >= 7  # hurried, delayed, and why the rule is silent


IX, IZ, THETA, SPIN = 0.000228, 0.0000572, 0.5, 200.0


def list_starts(Mgl):
    """Starts of every kind: at rest, at the other cusp, steady, and about them."""
    top = Top(IX, IZ, Mgl)
    slow, fast = regular_precession_rates(top, THETA, SPIN)
    rates = [0.0, slow, fast, slow + 1e-9, slow + 1e-4, slow + 1, -3.0, 3 * slow, 100.0]
    if Mgl:
        cosine = math.cos(THETA)  # phi' = 2 Mgl/p_psi, where p_psi has phi' in it
        a = IZ * cosine
        b = IZ * SPIN
        c = -2 * Mgl
        rates.append((-b + math.sqrt(b * b - 4 * a * c)) / (2 * a))
    starts = [{"theta": THETA, "phi_dot": rate, "psi_dot": SPIN} for rate in rates]
    starts += [{"theta": 2.5, "phi_dot": rate, "psi_dot": -SPIN} for rate in rates]
    starts.append({"theta": THETA, "phi_dot": 0.0, "psi_dot": 0.0})
    for pole in (0.0, math.pi):
        starts.append({"theta": pole, "phi_dot": 0.0, "psi_dot": SPIN})
    starts.append({"theta": THETA, "phi_dot": 0.0, "theta_dot": 2.0, "psi_dot": SPIN})
    # p_psi = p_phi with the energy of the upright top: it comes to rest there after all time
    least = 2 * math.sqrt(IX * abs(Mgl)) / IZ
    starts.append({"theta": THETA, "phi_dot": least * IZ / IX / 2, "psi_dot": 0.1 * least})
    return [{"top": {"Ix": IX, "Iz": IZ, "Mgl": Mgl}, **each} for each in starts]


def find_direction(start):
    """Return where theta' leads at first, or theta'' if theta' is zero, and 0 if nothing moves."""
    if start["theta"] in (0.0, math.pi):
        return 0
    rates = start["theta"], start["phi_dot"], start["psi_dot"]
    change = start.get("theta_dot") or float(theta_acceleration(Top(**start["top"]), *rates))
    # A swing of less than 1e-7 rad is no swing: it is 2 theta'' divided by the square of 50 rad/s.
    return 0 if abs(change) < 1e-7 * 50**2 / 2 else math.copysign(1, change)


@pytest.mark.wording
@pytest.mark.parametrize("Mgl", [0.068, -0.068, 0.0])
def test_headline_and_reason_of_every_kind_agree_with_the_motion(tab, Mgl):
    starts = list_starts(Mgl)
    kinds = set()
    for start, (headline, why, kind) in zip(starts, tab.evaluate("sayStarts", starts), strict=True):
        kinds.add(kind)
        direction = find_direction(start)
        verb = {1: "moves down", -1: "moves up", 0: "keeps its tilt"}[direction]
        assert f"At this instant: the axis {verb}" in why, (start, why)
        # how it moves is no way up or down
        assert not re.search("falls|rises|moves|up|down", headline), (start, headline)
        is_steady = "precesses steadily" in headline
        assert is_steady == (kind == "regular" and start["phi_dot"] != 0), (start, headline)
        assert direction == 0 or not is_steady
        if direction == 0:
            assert "constant at" in headline or "on the vertical" in headline
            assert "will stay at" in why
        if "in cusps" in headline or "in loops" in headline or "in waves" in headline:
            assert "with its tilt between" in headline
            assert "will stay between" in why
    expected = {"regular", "sleeping"}
    expected |= {"cusps", "looping", "unidirectional", "through the pole"} if Mgl else set()
    assert expected <= kinds, kinds
