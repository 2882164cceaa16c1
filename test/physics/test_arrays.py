"""Functions of arrays: each element is that of the scalars alone, bit for bit."""

from functools import partial

import numpy as np
import pytest
from drawn import Numbers
from physics.tops import ARTICLE, CUSPS

from symtop_ros.physics import (
    HOLDS,
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
EULER = {
    "theta": RNG.uniforms(0.0, np.pi, COUNT),
    "phi": np.array(RNG.choices([0.1, 1.0, 1e4, 1e9, 1e20], k=COUNT)) * RNG.normals(COUNT),
    "psi": np.array(RNG.choices([0.0, 3.0, 1e5, 1e12], k=COUNT)) * RNG.normals(COUNT),
    **{
        name: np.array(RNG.choices([0.0, 1e-200, 3.0, 200.0], k=COUNT))
        for name in ("theta_dot", "phi_dot", "psi_dot")
    },
}
STATES = State.from_euler(**EULER)
TOPS = Top(RNG.uniforms(0.5, 1.0, COUNT), 0.4, RNG.normals(COUNT))
NUMBERS, IMPULSES = RNG.normals(COUNT) * 3, RNG.normals(COUNT, 3)


def from_euler(*values):
    return State.from_euler(**dict(zip(EULER, values, strict=True)))


CALLS = [
    (from_euler, *EULER.values()),
    (apply_impulse, TOPS, STATES, IMPULSES),
    *((partial(set_precession_rate, hold=hold), STATES, NUMBERS) for hold in HOLDS),
    *((partial(hurry, hold=hold), STATES, NUMBERS) for hold in HOLDS),
]


def take(many, n):
    """The n-th of many tops, states, vectors or numbers; a number that is given once is of all."""
    if isinstance(many, Top):
        return Top(*(take(each, n) for each in many.moments))
    if isinstance(many, State) or np.ndim(many) > 1:
        return many[n]
    return float(np.broadcast_to(many, COUNT)[n])


@pytest.mark.parametrize("call", CALLS)
def test_states_that_follow_from_arrays_are_those_of_each(call):
    function, *arguments = call
    many = function(*arguments)
    for n in range(COUNT):
        assert many[n] == function(*(take(each, n) for each in arguments))


@pytest.mark.parametrize("name", ["euler_angles", "euler_rates"])
def test_angles_and_rates_of_many_are_those_of_each(name):
    for n, state in enumerate(STATES):
        assert [part[n] for part in getattr(STATES, name)] == list(getattr(state, name))


def test_arguments_are_broadcast():
    states = State.from_euler(theta=[[0.4], [0.5]], psi_dot=[1.0, 2.0, 3.0])
    assert states.orientation.shape == (2, 3, 4)
    assert states[1, 2] == State.from_euler(theta=0.5, psi_dot=3.0)
    assert hurry(CUSPS, [[0.5], [1.5]]).orientation.shape == (2, 1, 4)
    assert hurry(STATES, 2.0)[3] == hurry(STATES[3], 2.0)
    assert apply_impulse(ARTICLE, CUSPS, IMPULSES * 1e-6).orientation.shape == (COUNT, 4)
    verdicts = perrys_rule(ARTICLE, CUSPS, [[0.5], [1.4]])
    assert verdicts.direction.shape == verdicts.turning_angles[0].shape == (2, 1)
    assert not verdicts.rule_applies.any()  # there is no precession to hurry


@pytest.mark.parametrize("hold", HOLDS)
def test_verdicts_on_arrays_are_those_on_each(hold):
    tops = Top(0.000228, 0.0000572, RNG.normals(COUNT) * 0.1)
    states = State.from_euler(theta=EULER["theta"], phi_dot=9.0, psi_dot=150.0)
    factors = RNG.uniforms(-1, 3, COUNT)
    many = perrys_rule(tops, states, factors, hold)
    for n in range(COUNT):
        one = perrys_rule(take(tops, n), states[n], take(factors, n), hold)
        assert many.direction[n] == one.direction
        assert tuple(angles[n] for angles in many.turning_angles) == one.turning_angles
        found = [rates[n] for rates in many.regular_rates if not np.isnan(rates[n])]
        assert found == list(one.regular_rates)
        holds = many.rule_holds[n] if many.rule_applies[n] else None
        assert holds == one.rule_holds
    assert {True, False} <= set(many.rule_holds.tolist())


def test_regular_rates_of_arrays_are_those_of_each():
    tops = Top(0.000228, np.array(RNG.choices([0.0000572, 0.000228, 0.0004], k=COUNT)), 0.068)
    arguments = tops, EULER["theta"], RNG.normals(COUNT) * 150
    slow, fast = regular_precession_rates(*arguments)
    counts = set()
    for n in range(COUNT):
        alone = regular_precession_rates(*(take(each, n) for each in arguments))
        assert [rate for rate in (slow[n], fast[n]) if not np.isnan(rate)] == list(alone)
        counts.add(len(alone))
    assert counts == {0, 1, 2}
