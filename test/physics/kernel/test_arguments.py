"""Arguments that the functions of symtop.h refuse or normalise, for every caller."""

import math
from ctypes import byref, c_double, c_int, c_size_t, c_void_p
from functools import partial

import numpy as np
import pytest
from drawn import Numbers
from mpmath import mp, mpf
from physics.tops import ARTICLE, EPS

from symtop_ros.physics import Motion, State, hurry, set_precession_rate
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.kernel.records import BodyRecord, SolutionsRecord, TopRecord

DOOR = bindings.bind_functions()
SPIN_RATE, SPIN_MOMENTUM, NOTHING = range(3)
NEW_RATE, CHANGE_OF_RATE, FACTOR_OF_RATE, IMPULSE, AXLE_IMPULSE = range(5)
# Of symtop_status.
TOP, ORIENTATION, RATE_OF_BODY, KICK = 2, 3, 4, 14
POINTER, COUNT, HOLD, KIND, RATE, STEPS, DISC = range(17, 24)
SEEN, PART = 26, 27
DISC_KIND = 3
START = State.from_euler(theta=0.5, phi=0.3, psi=-1.1, phi_dot=6.5, psi_dot=200.0)
TOP_ROW = np.array(ARTICLE.moments)
TURN, OMEGA = START._parts


def pack(*numbers):
    return np.array(numbers, float).tobytes()


def find_angles(*q, count=1, room=3):
    return DOOR.find_angles(pack(*q), count, (c_double * room)())


def find_rates(q, omega=OMEGA):
    found = (c_double * 3)()
    return DOOR.find_angle_rates(pack(*q), pack(*omega), 1, found), list(found)


def kick(kind, hold, *amounts, top=TOP_ROW, q=TURN, omega=OMEGA, kicked=None):
    kicked = (c_double * 3)() if kicked is None else kicked
    given = pack(*top), pack(*q), pack(*omega), kind, hold, pack(*amounts)
    return DOOR.kick(*given, 1, kicked, c_size_t())


NAN, INF = math.nan, math.inf
NO_ORIENTATIONS = [
    *((0.6, 0.8, x, 0.0) for x in (NAN, INF)),
    *((x, 0.0, 0.0, 0.0) for x in (NAN, 0.0, 0.9, 1.002)),
    (INF, 1.0, 0.0, 0.0),
]


@pytest.mark.parametrize("q", NO_ORIENTATIONS)
def test_what_is_no_orientation_is_refused_by_all_functions_of_it(q):
    assert find_angles(*q) == ORIENTATION
    assert find_rates(q)[0] == ORIENTATION
    assert kick(NEW_RATE, SPIN_RATE, 9.1, q=q) == ORIENTATION


def scale(norm):
    return norm * TURN


@pytest.mark.parametrize("norm", [1.0009, 0.9991])
def test_an_orientation_of_another_norm_is_normalised_by_all_functions_of_it(norm):
    found = (c_double * 3)()
    expected = bindings.find_angles(TURN)
    assert DOOR.find_angles(pack(*scale(norm)), 1, found) == bindings.OK
    assert list(found) == pytest.approx(expected.tolist(), rel=8 * EPS)
    status, rates = find_rates(scale(norm))
    assert status == bindings.OK
    # As docs/accuracy.md promises: 12 eps of the angular velocity over sin(theta).
    bound = 12 * EPS * float(np.linalg.norm(OMEGA)) / math.sin(0.5)
    assert rates == pytest.approx([6.5, 0.0, 200.0], abs=bound)


@pytest.mark.parametrize(
    "act",
    [
        partial(kick, NEW_RATE, SPIN_RATE, 9.1),
        partial(kick, CHANGE_OF_RATE, SPIN_MOMENTUM, 2.6),
        partial(kick, FACTOR_OF_RATE, SPIN_RATE, 1.4),
        partial(kick, IMPULSE, NOTHING, 1e-4, 2e-4, -1e-4),
        partial(kick, AXLE_IMPULSE, NOTHING, 1e-4),
    ],
)
def test_a_kick_of_an_orientation_of_another_norm_is_that_of_the_normalised_one(act):
    kicked, expected = (c_double * 3)(), (c_double * 3)()
    assert act(q=scale(1.0009), kicked=kicked) == act(kicked=expected) == bindings.OK
    assert list(kicked) == pytest.approx(list(expected), rel=16 * EPS)  # of three roundings more


def test_an_orientation_of_norm_1_to_rounding_keeps_its_bits():
    for q in random_units(500):
        given = State(q, OMEGA)
        again = State(given.orientation, OMEGA)
        for state in (given, again):
            kicked = (c_double * 3)()
            assert kick(NEW_RATE, SPIN_RATE, 9.1, q=state.given_orientation, kicked=kicked) == 0
            assert list(kicked) == set_precession_rate(again, 9.1).angular_velocity.tolist()


def random_units(count):
    """Quaternions of norm 1 within some EPS, and a quarter of them further off."""
    rng = Numbers(70)
    q = rng.quaternions(count)
    q[::2] *= [[1 + EPS * rng.randrange(-8, 9)] for _ in q[::2]]
    q[::4] *= 1.0007
    return q


HOLDS_OF_RATES = [(kind, hold) for kind in (0, 1, 2) for hold in (-1, NOTHING, 3, 2**31 - 1)]


@pytest.mark.parametrize(("kind", "hold"), [*HOLDS_OF_RATES, (IMPULSE, 3), (AXLE_IMPULSE, -1)])
def test_a_hold_that_is_none_is_refused_by_its_name(kind, hold):
    assert kick(kind, hold, 1.0, 0.0, 0.0) == HOLD


def test_nothing_is_held_by_impulses_alone():
    given = pack(*TOP_ROW), pack(0.5), pack(200.0), 1, NOTHING, (c_double * 2)()
    assert DOOR.find_regular_rates(*given) == HOLD
    start = Motion(ARTICLE, START)._packed_start
    assert DOOR.find_tilt_accelerations(start, NOTHING, pack(1.0), 1, (c_double * 1)()) == HOLD
    verdict = bindings.VerdictRecord()
    assert DOOR.judge(start, pack(1.4), 1, NOTHING, verdict, c_size_t()) == HOLD
    angles = (c_double * 2)()
    rule = (bindings.c_uint8 * 1)()
    row = pack(*TOP_ROW), pack(0.5), pack(6.5), pack(200.0), 1, 1.4
    assert DOOR.compare_hurried(*row, NOTHING, angles, rule) == HOLD
    assert DOOR.judge_kick(start, start, NOTHING, verdict) == bindings.OK
    assert kick(IMPULSE, NOTHING, 1e-4, 0.0, 0.0) == bindings.OK


@pytest.mark.parametrize("kind", [-1, 5, 6, 7, 2**31 - 1])
def test_a_kind_of_kick_that_is_none_is_refused_by_its_name(kind):
    assert kick(kind, SPIN_RATE, 1.0, 0.0, 0.0) == KIND


def test_what_is_no_top_is_refused_by_all_functions_of_it():
    for top in ((-1.0, 1.0, 1.0), (1.0, 2.5, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, NAN)):
        assert kick(NEW_RATE, SPIN_RATE, 9.1, top=top) == TOP
        torques = (c_double * 4)()
        given = pack(*top), pack(0.5), pack(1.0), pack(2.0), 1
        assert DOOR.find_tilt_torques(*given, torques) == TOP
        assert DOOR.find_disc(pack(*top), 9.81, torques) == TOP


def test_rates_and_amounts_that_are_not_finite_are_refused():
    for odd in (NAN, INF, -1e101):
        assert find_rates(TURN, (0.0, odd, 1.0))[0] == RATE_OF_BODY
        assert kick(NEW_RATE, SPIN_RATE, 9.1, omega=(odd, 0.0, 0.0)) == RATE_OF_BODY
        assert kick(NEW_RATE, SPIN_RATE, odd) == KICK
        given = pack(*TOP_ROW), pack(0.5), pack(odd), pack(2.0), 1, (c_double * 4)()
        assert DOOR.find_tilt_torques(*given) == RATE


def find_body(kind, *part, count=1):
    found = BodyRecord()
    return DOOR.find_body(bytes(c_int(kind)), pack(*part), count, found, c_size_t())


def test_a_part_has_a_kind_a_mass_and_a_size():
    for part in ((0.0, 0.1, 0.1), (1.0, -0.1, 0.1), (1.0, 0.0, 0.1), (1.0, 0.1, NAN)):
        assert find_body(DISC_KIND, *part) == PART
    for kind in (-1, 5, 2**31 - 1):
        assert find_body(kind, 1.0, 0.1, 0.1) == PART
    assert find_body(DISC_KIND, 1.0, 0.1, 0.1, count=0) == PART
    assert find_body(DISC_KIND, 1.0, 0.1, 0.1) == find_body(0, 1.0, NAN, 0.1) == bindings.OK


def test_gravity_is_finite():
    found = TopRecord()
    assert DOOR.find_body_top(pack(1.0, 0.1, 0.1, 0.1), NAN, found) == DISC
    assert DOOR.find_body_top(pack(1.0, NAN, 0.1, 0.1), 9.81, found) == PART
    assert DOOR.find_disc(pack(*TOP_ROW), INF, (c_double * 3)()) == DISC


def test_what_is_seen_is_one_of_seven():
    for seen in (-1, 7, 2**31 - 1):
        assert DOOR.solve_start(pack(*TOP_ROW), seen, pack(1, 1, 1), SolutionsRecord()) == SEEN


def test_null_pointers_are_refused_and_arrays_without_elements_may_be_null():
    handle = c_void_p()
    found = (c_double * 4)()
    done = c_size_t()
    start = Motion(ARTICLE, START)._packed_start
    assert DOOR.new(None, byref(handle)) == DOOR.new(start, None) == POINTER
    assert DOOR.find_angles(None, 1, found) == DOOR.find_angles(pack(*TURN), 1, None) == POINTER
    assert DOOR.find_angles(None, 0, None) == bindings.OK
    assert DOOR.from_angles(pack(0, 0, 0), pack(0, 0, 0), 1, found, None, done) == POINTER
    assert DOOR.describe_many(None, 0, None, None) == POINTER
    assert DOOR.find_rates(None, bindings.RatesRecord()) == POINTER
    assert DOOR.states(None, None, 0, 1.0, None, None, done) == POINTER
    assert DOOR.find_kind(None) == len(bindings.KINDS)
    assert DOOR.find_engine(None) == len(bindings.ENGINES)


def test_a_count_beyond_all_memory_and_steps_that_are_no_number_are_refused():
    assert find_angles(*TURN, count=2**62) == COUNT
    handle = c_void_p()
    assert DOOR.new(Motion(ARTICLE, START)._packed_start, byref(handle)) == bindings.OK
    q = (c_double * 4)()
    omega = (c_double * 3)()
    done = c_size_t()
    for steps in (NAN, -1.0):
        assert DOOR.states(handle, pack(1.0), 1, steps, q, omega, done) == STEPS
        assert DOOR.reach(handle, 1.0, steps, q) == STEPS
    DOOR.free(handle)


def test_every_status_has_a_sentence():
    unknown = DOOR.describe_status(99)
    sentences = [DOOR.describe_status(each) for each in range(29)]
    assert len({*sentences, unknown}) == 30
    assert {DOOR.describe_status(each) for each in (-1, 29, 2**31 - 1)} == {unknown}


@pytest.mark.parametrize("phi", [1e300, 1.7e308, -1e217])
def test_angles_of_any_size_are_taken_without_their_turns(phi):
    for psi in (1.7e308, 1e217, -3.0):
        state = State.from_euler(theta=0.5, phi=phi, psi=psi)
        one = State.from_euler(theta=0.5, phi=take_turns_off(phi), psi=take_turns_off(psi))
        # of the same attitude: a turn less of one angle changes the sign
        sign = math.copysign(1.0, float(state.orientation @ one.orientation))
        assert state.orientation.tolist() == pytest.approx(
            (sign * one.orientation).tolist(), abs=1e-15
        )


def take_turns_off(angle):
    """The angle without its whole turns."""
    with mp.workdps(400):
        return float(mpf(angle) - 2 * mp.pi * mp.nint(mpf(angle) / (2 * mp.pi)))


def test_a_kicked_state_of_python_has_the_digits_of_the_kernel():
    long = State(scale(1.0009), OMEGA)
    kicked = (c_double * 3)()
    assert (
        kick(FACTOR_OF_RATE, SPIN_RATE, 1.4, q=long.given_orientation, kicked=kicked) == bindings.OK
    )
    assert list(kicked) == hurry(long, 1.4).angular_velocity.tolist()
