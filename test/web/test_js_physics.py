"""The physics of the page, in Chromium: states, records and sentences are those of Python."""

import dataclasses
import math
import random

import numpy as np

from symtop_ros.physics import (
    EffectivePotential,
    Motion,
    State,
    Top,
    apply_impulse,
    hurry,
    kick_verdict,
    perrys_rule,
    precessing_frame_torques,
    regular_precession_rates,
    set_precession_rate,
    theta_acceleration,
)
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
        slow = regular_precession_rates(Top(**top), theta=theta, psi_dot=spin)
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
        return apply_impulse(top, state, kick["value"])
    change = hurry if kick["kind"] == "factor" else set_precession_rate
    return change(state, kick["value"], kick["hold"])


def judge_in_python(case):
    top, kick = Top(**case["top"]), case["kick"]
    rates = {f"{name}_dot": rate for name, rate in case["rates"].items()}
    state = State.from_euler(**case["angles"], **rates)
    after = kick_in_python(top, state, kick)
    verdict = perrys_rule(top, state, hold=kick.get("hold", "spin_rate"))
    record = kick_verdict(Motion(top, after), state, kick.get("hold"))
    angles, own = state.euler_angles, state.euler_rates
    torques = precessing_frame_torques(top, angles.theta, own.phi, own.psi)
    potential = EffectivePotential.of(top, state)
    return {
        "start": np.concatenate(state.parts).tolist(),
        "after": np.concatenate(after.parts).tolist(),
        "angles": angles._asdict(),
        "rates": own._asdict(),
        "world": state.to_world(state.angular_velocity).tolist(),
        "verdict": dataclasses.asdict(verdict),
        "record": dataclasses.asdict(record),
        "texts": [
            write(name, each, variant)
            for variant in ("radians", "degrees")
            for name, each in (("verdict", verdict), ("kick", record))
        ],
        "regular": regular_precession_rates(top, case["angles"]["theta"], case["rates"]["psi"]),
        "torques": {
            name: float(getattr(torques, name))
            for name in ("gravity", "coriolis", "centrifugal", "total")
        },
        "acceleration": float(theta_acceleration(top, angles.theta, own.phi, own.psi)),
        "constants": constants_of_motion(top, state),
        "potential": potential.at([0.3, 1.0, 2.5]).tolist(),
        "energy": potential.energy,
    }


# Sums whose terms cancel: 4 eps of the largest term, not of the sum.
CANCELLING = {"torques", "acceleration", "constants", "potential", "energy", "world"}


def assert_close(found, wanted, scale, path):
    """Compare records; numbers to 4 eps of themselves, or of the scale of what they belong to."""
    if isinstance(wanted, dict):
        assert found.keys() == wanted.keys(), path
        for name, value in wanted.items():
            assert_close(found[name], value, scale, f"{path}.{name}")
    elif isinstance(wanted, list | tuple):
        assert len(found) == len(wanted), path
        for n, value in enumerate(wanted):
            assert_close(found[n], value, scale, f"{path}[{n}]")
    elif isinstance(wanted, float) and not isinstance(found, bool) and found is not None:
        assert abs(found - wanted) <= 4 * EPS * max(abs(wanted), scale), (path, found, wanted)
    elif isinstance(wanted, float):
        assert math.isnan(wanted), path  # JSON has no such number
    else:
        assert found == wanted, path


def list_terms(case, wanted):
    """Return the sizes of the largest terms of the cancelling sums of a case."""
    (Ix, Iz, Mgl), rates = case["top"].values(), [abs(each) for each in wanted["start"][4:]]
    top = max(rates)
    phi = abs(wanted["rates"]["phi"])
    torque = abs(Mgl) + (Iz * abs(wanted["rates"]["psi"]) + (Ix + Iz) * phi) * phi
    energy = abs(Mgl) + (Ix + Iz) * top * top
    potential = max(map(abs, wanted["potential"])) + energy
    return {
        "torques": torque,
        "acceleration": torque / Ix,
        "constants": max(energy, (Ix + Iz) * top),
        "potential": potential,
        "energy": energy,
        "world": 2 * top,
    }


def test_kicks_records_and_sentences_are_those_of_python(tab):
    cases = list(list_cases(500))
    answers = tab.evaluate("(cases) => judgeCases(cases)", cases)
    kinds = set()
    for case, found in zip(cases, answers, strict=True):
        wanted = judge_in_python(case)
        for name in ("start", "after"):
            assert found[name] == wanted[name], (name, case)
        assert found["texts"] == wanted["texts"], case
        kinds.add(wanted["record"]["reason"]["kind"])
        terms = list_terms(case, wanted)
        for name, value in wanted.items():
            assert_close(found[name], value, terms.get(name, 0.0), f"{name} of {case}")
    assert len(kinds) >= 7  # hurried, delayed, and why the rule is silent


def test_equal_roots_have_the_order_of_python_at_a_spin_of_minus_zero(tab):
    top = {**ARTICLE, "Mgl": -0.068}
    found = tab.evaluate(
        """async (top) => {
            const { findRegularRates } = await import("/physics/precession.js");
            return [0, -0].map((spin) => findRegularRates(top, 0.5, spin));
        }""",
        top,
    )
    expected = [regular_precession_rates(Top(**top), 0.5, spin) for spin in (0.0, -0.0)]
    assert [*map(tuple, found)] == expected
