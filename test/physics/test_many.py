"""Many motions at once, and functions of arrays: each element is that of one alone, bit for bit."""

import copy
import pickle
from functools import partial
from itertools import product

import numpy as np
import pytest
from documents import ROOT, names, rows
from drawn import Numbers
from physics.refusals import refused
from physics.tops import ARTICLE, CUSPS, random_case

from symtop_ros.base.deprecation import OldName
from symtop_ros.physics import (
    HOLDS,
    ExactTimes,
    Friction,
    Motion,
    Motions,
    State,
    Top,
    apply_impulse,
    hurry,
    perrys_rule,
    regular_precession_rates,
    set_precession_rate,
)

PROPERTIES = (
    "kind",
    "nutation_period",
    "mean_precession_rate",
    "precession_period",
    "farthest_time",
    "rounding_shows_at",
    "is_driven",
    "engine",
    "mean_spin_rate",
    "nutation_rate",
    "precession_per_nutation",
    "mean_cosine",
    "spin_reverses",
    "fast_top_precession_rate",
    "fast_top_nutation_rate",
    "turning_angles",
)
TIMES = np.array([[0.0, 1e-4, 0.7], [-3.0, 12.0, 1e4]])


def list_names(motion):
    """The public names of a motion, without old names, which warn."""
    names = {*dir(type(motion)), *vars(motion)}
    old = {name for each in type(motion).mro() for name in find_old_names(each)}
    return {name for name in names - old if not name.startswith("_")}


def find_old_names(owner):
    return {name for name, each in vars(owner).items() if isinstance(each, OldName)}


def draw_motions():
    """Motions of all families, one without weight, one asleep."""
    families = product(("any", "fast", "critical", "pendulum", "from below"), range(10))
    cases = [random_case(n, family) for family, n in families]
    tops, starts = [case.top for case in cases], [case.start for case in cases]
    tops[3] = Top(tops[3].Ix, tops[3].Iz, 0.0)
    starts[4] = State((1, 0, 0, 0), (0, 0, 3.0))
    return [*map(Motion, tops, starts)]


ALONE = draw_motions()
MANY = Motions(
    Top(*np.transpose([each.top.moments for each in ALONE])),
    State(*(np.stack([each.start._parts[k] for each in ALONE]) for k in range(2))),
)


@pytest.mark.parametrize("times", [TIMES, 2.5, ExactTimes(np.array([0, 10**9 + 1]))])
def test_each_state_is_that_of_the_motion_alone(times):
    states = MANY.at(times)
    assert len(states) == len(ALONE)
    for n, single in enumerate(ALONE):
        for one, other in zip(states[n]._parts, single.at(times)._parts, strict=True):
            assert one.tobytes() == other.tobytes()


@pytest.mark.parametrize("name", PROPERTIES)
def test_each_property_is_that_of_the_motion_alone(name):
    found = getattr(MANY, name)
    singles = [getattr(each, name) for each in ALONE]
    if isinstance(found, tuple):
        found = np.stack(found, axis=1)
    np.testing.assert_array_equal(found, singles)


QUANTITIES = (
    "energy",
    "axial_momentum",
    "vertical_momentum",
    "angular_momentum",
    "gravity_torque",
    "total_torque",
)


@pytest.mark.parametrize("name", QUANTITIES)
def test_quantities_of_broadcast_motions_belong_to_their_tops(name):
    # three tops and three by one starts: the tops are those of the last axis, and there are as
    # many times as motions, so that a wrong axis would not be noticed by its length
    tops = Top([1.0, 1.5, 2.0], 1.0, [1.0, -2.0, 3.0])
    starts = State(np.tile([0.8, 0.6, 0, 0], (3, 1, 1)), np.zeros((3, 1, 3)))
    torque = [[0, 0, 1], [0, 1, 0], [1, 0, 0]]
    motions = Motions(tops, starts, Friction([0.0, 0.1, 0.2]), torque)
    times = [0.0, 0.5, 1.0]
    found = getattr(motions, name)(motions.at(times))
    for row, column in np.ndindex(3, 3):
        member = motions[row, column]
        owner = member if name == "total_torque" else member.top
        assert np.array_equal(found[row, column], getattr(owner, name)(member.at(times)))


def test_motions_are_indexed_and_counted_as_arrays():
    motions = Motions(Top(0.000228, 0.0000572, np.arange(1, 7).reshape(2, 3) / 64), CUSPS)
    assert (len(motions), len(motions[1]), motions[:, 1:].shape) == (2, 3, (2, 2))
    assert motions[1, 2].top == Top(0.000228, 0.0000572, 6 / 64)
    assert motions[1, 2].at(0.7) == motions.at(0.7)[1, 2] == motions[:, 1:].at(0.7)[1, 1]
    assert [motion.top.Mgl for row in motions for motion in row] == [n / 64 for n in range(1, 7)]
    with pytest.raises(IndexError):
        motions[2]


def test_each_motion_has_states_at_its_own_times():
    motions = Motions(Top(0.000228, 0.0000572, [0.06, 0.07]), CUSPS, Friction([0.0, 1e-6]))
    times = np.array([[0.5, -1.0, 0.0], [0.25, 3.0, 1.0]])
    states = motions.at_each(times)
    for n, motion in enumerate(motions):
        assert states[n] == motion.at(times[n])
    with refused("times", "an array whose shape begins with that of the motions, (2,)"):
        motions.at_each([0.0, 1.0, 2.0])


STAMPS = np.array([10**9 + 1, 3 * 10**15 + 7, 5])


def test_each_motion_has_states_at_its_own_exact_times():
    motions = MANY[:3]
    exact = ExactTimes(STAMPS, 0.5)
    states = motions.at_each(exact)
    for n, alone in enumerate(ALONE[:3]):
        one = alone.at(ExactTimes(int(STAMPS[n]), 0.5))
        assert states[n] == one
    refusal = refused("times", "begins with that of the motions, (2,)", "shape (3,)")
    with refusal:
        MANY[:2].at_each(exact)


def test_a_table_at_exact_times_has_their_states_and_the_nearest_seconds():
    exact = ExactTimes(STAMPS, 0.5)
    table = MANY[:2].table(exact)
    assert table["t"].tolist() == 2 * exact.seconds.tolist()
    for n, alone in enumerate(ALONE[:2]):
        single = alone.at(exact).table(exact)
        assert all(
            np.array_equal(table[name].reshape(2, 3)[n], column) for name, column in single.items()
        )


def test_a_motion_of_arrays_is_refused_and_told_of_motions():
    refusal = r"^top must be one top \(`Motions` takes many\), got tops of shape \(2,\)$"
    with pytest.raises(ValueError, match=refusal):
        Motion(Top(1.0, 1.0, [1.0, 2.0]), CUSPS)


def test_each_motion_of_many_has_its_own_engine_and_one_motion_alone_can_be_reached():
    tops = Top(1.0, 1.0, [1.0, 0.0, 1.0])
    motions = Motions(tops, CUSPS, Friction([0.0, 0.0, 0.1]))
    assert motions.engine.tolist() == ["closed form", "free", "taylor"]
    assert not hasattr(motions, "reach")


def test_one_top_compares_and_hashes_by_its_numbers():
    top = Top(1.0, 1.0, 2.0)
    assert top == Top(1, 1, 2) != Top(1, 1, 3)
    assert {top: 1}[Top(1, 1, 2)] == 1
    assert Friction(1e-3) == Friction(0.001, 0) != Friction(0, 1e-3)
    tops = Top([1.0, 1.0], 1.0, 2.0)
    assert tops == Top(1.0, [1.0, 1.0], 2.0) != top
    for each in (top, tops):
        assert copy.copy(each) == pickle.loads(pickle.dumps(each)) == each


def test_an_empty_array_of_motions_has_empty_states():
    motion = Motions(ARTICLE, State(np.empty((0, 4)), np.empty((0, 3))))
    assert motion.at([1.0, 2.0]).orientation.shape == (0, 2, 4)
    assert [angles.shape for angles in motion.turning_angles] == [(0,), (0,)]


COUNT = 200
RNG = Numbers(8)
RATES = (0.0, 1e-200, 3.0, 200.0)
EULER = {
    "theta": RNG.uniforms(0.0, np.pi, COUNT),
    "phi": np.array(RNG.choices([0.1, 1.0, 1e4, 1e9, 1e20], k=COUNT)) * RNG.normals(COUNT),
    "psi": np.array(RNG.choices([0.0, 3.0, 1e5, 1e12], k=COUNT)) * RNG.normals(COUNT),
    **{f"{name}_dot": RNG.choices(RATES, k=COUNT) for name in ("theta", "phi", "psi")},
}
STATES = State.from_euler(**EULER)
TOPS = Top(RNG.uniforms(0.5, 1.0, COUNT), 0.4, RNG.normals(COUNT))
NUMBERS = RNG.normals(COUNT) * 3
IMPULSES = RNG.normals(COUNT, 3)


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


def test_the_table_of_many_says_what_each_has():
    table = rows(ROOT / "docs/many.md", "Members of `Motion` and `Motions`")
    for column, motion in ((1, ALONE[0]), (2, MANY)):
        said = {name for row in table for name in names(row[0]) if row[column] == "yes"}
        assert said == list_names(motion)
    assert {row[1:3] == ["yes", "yes"] for row in table if not row[3]} == {True}
    assert all("no" in row[1:3] for row in table if row[3])


def test_many_are_driven_and_certified_as_each_alone():
    frictions = Friction(axial=[0.0, 1e-6], transverse=0.0)
    many = Motions(ARTICLE, CUSPS, frictions)
    assert many.is_driven.tolist() == [each.is_driven for each in many] == [False, True]
    states = many.at([0.0, 0.25])
    proved = many.certify([0.0, 0.25])
    for n, one in enumerate(many):
        alone = one.certify([0.0, 0.25])
        assert proved.attitude[n].tolist() == alone.attitude.tolist()
        assert proved.angular_velocity[n].tolist() == alone.angular_velocity.tolist()
        assert many.added_torque(states)[n].tolist() == one.added_torque(states[n]).tolist()
        found = [each[n].tolist() for each in many.euler_rates(states)]
        assert found == [each.tolist() for each in one.euler_rates(states[n])]


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
        found = [rates[n] for rates in many.regular_rates]
        assert np.array_equal(found, one.regular_rates, equal_nan=True)
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
        assert np.array_equal((slow[n], fast[n]), alone, equal_nan=True)
        counts.add(int(np.isfinite(alone).sum()))
    assert counts == {0, 1, 2}
