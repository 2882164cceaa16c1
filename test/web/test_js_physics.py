"""The states, records and sentences of the page, from the kernel, are those of Python."""

import dataclasses
import math
import random

import numpy as np
import pytest
from trials import trials

from symtop_ros import physics
from symtop_ros.physics.values import EPS
from symtop_ros.session.diagnostics import constants_of_motion
from symtop_ros.wording import write

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
            top = {
                "Ix": Ix,
                "Iz": Iz,
                "Mgl": rng.choice([1, 1, -1, 0]) * 10 ** rng.uniform(0, 2) * Ix,
            }
        scale = math.sqrt(abs(top["Mgl"]) / top["Ix"]) or 1.0
        theta = rng.choice([rng.uniform(0, math.pi), 0.5, math.pi / 2, 1e-6])
        spin = rng.choice([0.0, rng.uniform(-10, 10) * scale, 200.0])
        slow = physics.regular_precession_rates(physics.Top(**top), theta=theta, psi_dot=spin)
        phi_dot = rng.choice([0.0, rng.uniform(-3, 3) * scale, *slow])
        angles = {"phi": rng.uniform(-3, 3), "theta": theta, "psi": rng.choice([0.0, 1.5, 300.0])}
        rates = {"phi": phi_dot, "theta": rng.choice([0.0, 0.0, scale * 0.1]), "psi": spin}
        yield {
            "top": top,
            "angles": angles,
            "rates": rates,
            "kick": make_kick(rng, top, phi_dot, scale),
        }


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
    top, kick = physics.Top(**case["top"]), case["kick"]
    start = case["angles"] | {f"{name}_dot": rate for name, rate in case["rates"].items()}
    state = physics.State.from_euler(**start)
    after = kick_in_python(top, state, kick)
    verdict = physics.perrys_rule(top, state, hold=kick.get("hold", "spin_rate"))
    record = physics.kick_verdict(physics.Motion(top, after), state, kick.get("hold"))
    return {
        "start": np.concatenate(state.parts).tolist(),
        "after": np.concatenate(after.parts).tolist(),
        "angles": state.euler_angles._asdict(),
        "rates": state.euler_rates._asdict(),
        "verdict": dataclasses.asdict(verdict),
        "record": dataclasses.asdict(record),
        "texts": [
            write(name, each, variant)
            for variant in ("radians", "degrees")
            for name, each in (("verdict", verdict), ("kick", record))
        ],
        "regular": physics.regular_precession_rates(top, start["theta"], start["psi_dot"]),
    }, draw_in_python(top, state)


def draw_in_python(top, state):
    """Return what the page draws in doubles of its own, each with the size of its largest term."""
    theta, (phi, _, psi) = state.euler_angles.theta, state.euler_rates
    torques = physics.precessing_frame_torques(top, theta, phi, psi)
    torque = abs(top.Mgl) + (top.Iz * abs(psi) + (top.Ix + top.Iz) * abs(phi)) * abs(phi)
    fastest = float(np.abs(state.angular_velocity).max())
    momentum = (top.Ix + top.Iz) * fastest
    energy = abs(top.Mgl) + momentum * fastest
    potential = physics.EffectivePotential.of(top, state)
    heights = potential.at([0.3, 1.0, 2.5]).tolist()
    return {
        "world": (state.to_world(state.angular_velocity).tolist(), 2 * fastest),
        "torques": ([*map(float, torques), float(torques.total)], torque),
        "constants": ([*constants_of_motion(top, state).values()], max(energy, momentum)),
        "potential": ([*heights, potential.energy], max(map(abs, heights)) + energy),
    }


def to_json(value):
    """Return a record in the form of the page's answer: lists, doubles, no NaN and one zero."""
    if isinstance(value, dict):
        return {name: to_json(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [to_json(each) for each in value]
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    return None if math.isnan(value) else float(value) + 0.0


@pytest.mark.parametrize("count", trials(100, 400))
def test_kicks_records_and_sentences_are_those_of_python(tab, count):
    cases, kinds = list(list_cases(count)), set()
    for case, found in zip(cases, tab.evaluate("judgeCases", cases), strict=True):
        wanted, drawn = judge_in_python(case)
        for name, (values, size) in drawn.items():
            close = pytest.approx(values, rel=4 * EPS, abs=4 * EPS * size)
            assert found["drawn"][name] == close, (name, case)
        for name, value in to_json(wanted).items():
            assert to_json(found[name]) == value, (name, case)
        kinds.add(wanted["record"]["reason"]["kind"])
    assert len(kinds) >= 7  # hurried, delayed, and why the rule is silent
