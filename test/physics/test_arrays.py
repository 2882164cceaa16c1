"""Functions of arrays: each element is that of the scalars alone, bit for bit."""

import numpy as np
import pytest
from drawn import Numbers
from physics.tops import ARTICLE, CUSPS

from symtop_ros.physics import (
    State,
    Top,
    apply_impulse,
    hurry,
    perrys_rule,
    regular_precession_rates,
    set_precession_rate,
)

COUNT = 200
RNG = Numbers(8)
ANGLES = {
    "theta": RNG.uniforms(0.0, np.pi, COUNT),
    "phi": np.array(RNG.choices([0.1, 1.0, 1e4, 1e9, 1e20], k=COUNT)) * RNG.normals(COUNT),
    "psi": np.array(RNG.choices([0.0, 3.0, 1e5, 1e12], k=COUNT)) * RNG.normals(COUNT),
}
RATES = {
    name: np.array(RNG.choices([0.0, 1e-200, 3.0, 200.0], k=COUNT))
    for name in ("theta_dot", "phi_dot", "psi_dot")
}
STATES = State.from_euler(**ANGLES, **RATES)
HOLDS = ["spin_rate", "spin_momentum"]


def take(n, arrays):
    return {name: float(array[n]) for name, array in arrays.items()}


def test_states_from_arrays_of_angles_are_those_of_each():
    for n, state in enumerate(STATES):
        assert state == State.from_euler(**take(n, ANGLES), **take(n, RATES))
        for many, alone in (
            (STATES.euler_angles, state.euler_angles),
            (STATES.euler_rates, state.euler_rates),
        ):
            assert [part[n] for part in many] == list(alone)


def test_angles_and_rates_are_broadcast():
    states = State.from_euler(theta=[[0.4], [0.5]], psi_dot=[1.0, 2.0, 3.0])
    assert states.orientation.shape == (2, 3, 4)
    assert states[1, 2] == State.from_euler(theta=0.5, psi_dot=3.0)


@pytest.mark.parametrize("hold", HOLDS)
def test_kicks_of_arrays_are_those_of_each(hold):
    rates, factors = RNG.normals(COUNT) * 10, RNG.uniforms(-1, 3, COUNT)
    one, other = set_precession_rate(STATES, rates, hold), hurry(STATES, factors, hold)
    for n, state in enumerate(STATES):
        assert one[n] == set_precession_rate(state, float(rates[n]), hold)
        assert other[n] == hurry(state, float(factors[n]), hold)


def test_one_state_takes_many_kicks_and_many_states_one():
    kicked = hurry(CUSPS, [[0.5], [1.5]])
    assert kicked.orientation.shape == (2, 1, 4)
    assert hurry(STATES, 2.0)[3] == hurry(STATES[3], 2.0)


def test_impulses_on_many_tops_are_those_on_each():
    tops = Top(RNG.uniforms(0.5, 1.0, COUNT), 0.4, RNG.normals(COUNT))
    impulses = RNG.normals(COUNT, 3)
    kicked = apply_impulse(tops, STATES, impulses)
    for n, state in enumerate(STATES):
        top = Top(float(tops.Ix[n]), 0.4, float(tops.Mgl[n]))
        assert kicked[n] == apply_impulse(top, state, impulses[n])
    assert apply_impulse(ARTICLE, CUSPS, impulses * 1e-6).orientation.shape == (COUNT, 4)


@pytest.mark.parametrize("hold", HOLDS)
def test_verdicts_on_arrays_are_those_on_each(hold):
    tops = Top(0.000228, 0.0000572, RNG.normals(COUNT) * 0.1)
    states, factors = (
        State.from_euler(theta=ANGLES["theta"], phi_dot=9.0, psi_dot=150.0),
        RNG.uniforms(-1, 3, COUNT),
    )
    many = perrys_rule(tops, states, factors, hold)
    for n in range(COUNT):
        top = Top(0.000228, 0.0000572, float(tops.Mgl[n]))
        one = perrys_rule(top, states[n], float(factors[n]), hold)
        assert many.direction[n] == one.direction
        assert tuple(angles[n] for angles in many.turning_angles) == one.turning_angles
        found = [rates[n] for rates in many.regular_rates if not np.isnan(rates[n])]
        assert found == list(one.regular_rates)
        holds = many.rule_holds[n] if many.rule_applies[n] else None
        assert holds == one.rule_holds
    assert {True, False} <= set(many.rule_holds.tolist())


def test_one_state_has_verdicts_for_many_factors():
    verdicts = perrys_rule(ARTICLE, CUSPS, [[0.5], [1.4]])
    assert verdicts.direction.shape == verdicts.turning_angles[0].shape == (2, 1)
    assert not verdicts.rule_applies.any()  # there is no precession to hurry


def test_regular_rates_of_arrays_are_those_of_each():
    tops = Top(0.000228, np.array(RNG.choices([0.0000572, 0.000228, 0.0004], k=COUNT)), 0.068)
    spins = RNG.normals(COUNT) * 150
    slow, fast = regular_precession_rates(tops, ANGLES["theta"], spins)
    kinds = set()
    for n in range(COUNT):
        top = Top(0.000228, float(tops.Iz[n]), 0.068)
        alone = regular_precession_rates(top, float(ANGLES["theta"][n]), float(spins[n]))
        found = [float(rate) for rate in (slow[n], fast[n]) if not np.isnan(rate)]
        assert found == list(alone)
        kinds.add(len(alone))
    assert kinds == {0, 1, 2}
