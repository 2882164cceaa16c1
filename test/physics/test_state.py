"""States, and what follows from them, compared with many digits."""

import copy
import hashlib
import math
import pickle
import random
from functools import partial

import numpy as np
import pytest
from drawn import Numbers, normalize
from mpmath import mp, mpf
from physics.refusals import refused
from physics.tops import (
    ARTICLE,
    CUSPS,
    EPS,
    Case,
    distance,
    exact_euler,
    exact_parts,
    random_states,
    turn,
)
from trials import trials

from symtop_ros.physics import (
    Friction,
    Motion,
    Motions,
    State,
    Top,
    apply_impulse,
    hurry,
    push_axle,
    set_precession_rate,
)

pytestmark = pytest.mark.numbers


def test_an_orientation_is_normalised_once_and_then_stays_bit_for_bit():
    once = State((1.0005, 0.0, 1e-3, 0.0), (1.0, 2.0, 3.0))
    assert np.linalg.norm(once.orientation) == pytest.approx(1.0, abs=EPS)
    again = State(*once._parts)
    assert [each.tobytes() for each in again._parts] == [each.tobytes() for each in once._parts]
    states = random_states(1000)
    assert State(*states._parts) == states


@pytest.mark.parametrize(("q", "psi"), [((0.8, 0, 0, 0.6), 1.287), ((0, 0.8, 0.6, 0), -1.287)])
def test_on_the_vertical_all_turning_is_spin(q, psi):
    state = State(q, (0.3, 0.4, 7.0))
    phi, _, spin = state.euler_angles
    assert phi == 0.0
    assert spin == pytest.approx(psi, abs=1e-3)
    assert state.euler_rates == (0.0, 0.5, 7.0)


def find_turn(state, phi, theta, psi):
    """The angle between the quaternion of a start and the exact one of its angles."""
    with mp.workdps(40):
        half = mpf(theta) / 2
        plus = (mpf(phi) + psi) / 2
        minus = (mpf(phi) - psi) / 2
        c, s = mp.cos(half), mp.sin(half)
        exact = c * mp.cos(plus), s * mp.cos(minus), s * mp.sin(minus), c * mp.sin(plus)
        given = [mpf(each) for each in state.given_orientation.tolist()]
        norm = mp.sqrt(sum(each * each for each in given))
        return 2 * mp.sqrt(sum((a / norm - b) ** 2 for a, b in zip(given, exact, strict=True)))


# Each component is a product of two sines: three roundings of EPS/2, and twice that as an angle,
# less what the norm takes off. In the last one phi + psi loses half an EPS of 5.2.
@pytest.mark.parametrize("size", [1.0, math.pi, 1e2, 1e4])
def test_a_quaternion_of_angles_is_right_to_two_eps_as_an_angle(size):
    rng = np.random.default_rng(7)
    for phi, theta, psi in size * rng.uniform(-1, 1, (100, 3)):
        state = State.from_euler(theta=theta, phi=phi, psi=psi)
        assert find_turn(state, phi, theta, psi) <= 2 * EPS
    angles = -2.4550709270551896, 0.25525746461207355, -2.771253615669604
    state = State.from_euler(phi=angles[0], theta=angles[1], psi=angles[2])
    assert find_turn(state, *angles) <= 2 * EPS


@pytest.mark.parametrize("turns", range(-5, 6))
def test_a_multiple_of_pi_is_the_vertical_exactly(turns):
    state = State.from_euler(theta=turns * math.pi, phi=0.3, psi=0.2, phi_dot=3.0, psi_dot=100.0)
    assert state.euler_angles.theta == (math.pi if turns % 2 else 0.0)
    assert state.angular_velocity.tolist() == [0.0, 0.0, 97.0 if turns % 2 else 103.0]
    assert Motion(ARTICLE, state).kind == "sleeping"


def test_matrices_rotate_as_quaternions_do_and_lead_back():
    states = random_states(500)
    vectors = Numbers(3).normals(500, 3)
    turned = np.einsum("nij,nj->ni", states.matrix, vectors)
    # sums of three products of numbers of about 1
    assert np.abs(turned - states.to_world(vectors)).max() < 16 * EPS
    back = State.from_matrix(states.matrix, states.angular_velocity)
    assert distance(states, back) < 8 * EPS


@pytest.mark.parametrize("q", [*np.eye(4).tolist(), (0.5, -0.5, 0.5, 0.5)])
def test_half_turns_have_a_quaternion(q):
    state = State(q, (1, 2, 3))
    assert distance(State.from_matrix(state.matrix, (1, 2, 3)), state) == 0


def test_many_states_have_places_and_a_length():
    states = Motions(Top([1.0, 2.0], 1.0, 1.0), CUSPS).at([0.0, 1.0, 2.0])
    assert len(states) == 2
    assert states[1].orientation.shape == (3, 4)
    assert states[1, 2] == states[1][2] == states[..., 2][1]
    assert bool(states[:0])
    with pytest.raises(IndexError, match="one state has no places"):
        _ = states[1, 2][0]
    with pytest.raises(TypeError, match="one state has no length"):
        len(states[1, 2])


def test_states_and_their_copies_are_read_only_also_through_their_base():
    for state in (CUSPS, Motion(ARTICLE, CUSPS).at([[0.0], [1.0]])):
        for other in (state, copy.deepcopy(state), pickle.loads(pickle.dumps(state))):
            assert other == state
            for part in other._parts:
                assert not part.flags.writeable
                assert part.base is None or not part.base.flags.writeable


# Of norms that are not 1 to rounding: what is kept of them are the doubles that were given.
LONG = np.array([(0.8, 0.6, 0.0, 0.0), (0.6, 0.0, 0.64, 0.48)]) * 1.0005
RATES = np.array([(1.0, 2.0, 200.0), (0.0, 3.0, 150.0)])


def hold_given(state, n):
    return state.given_orientation.tobytes() == LONG[n].tobytes()


def test_a_state_of_many_keeps_the_digits_that_were_given():
    states = State(LONG, RATES)
    one = State(LONG[1], RATES[1])
    assert not hold_given(State(states.orientation, RATES)[1], 1)
    copies = copy.copy(states), copy.deepcopy(states), pickle.loads(pickle.dumps(states))
    for many in (states, *copies):
        for found in (many[1], many[1:][0], list(many)[1], many[[1, 0]][0], many[..., 1]):
            assert found == one
            assert hold_given(found, 1)
    late = [Motion(ARTICLE, each).at(1e10) for each in (states[1], one)]
    assert late[0] == late[1]


def test_a_kick_keeps_the_digits_of_the_attitude_that_were_given():
    states = State(LONG, RATES)
    for kick in (
        partial(set_precession_rate, phi_dot=9.1),
        partial(hurry, factor=[1.2, 1.4], hold="spin_momentum"),
        partial(hurry, factor=1.4),
        partial(lambda state: apply_impulse(ARTICLE, state, (1e-4, 0, 0))),
        partial(lambda state: push_axle(ARTICLE, state, 1e-4)),
    ):
        kicked = kick(states)
        assert kicked.orientation.tobytes() == states.orientation.tobytes()
        assert hold_given(kicked[0], 0)
        assert hold_given(kicked, slice(None))
    assert hold_given(hurry(states[0]), 0)


def test_states_are_equal_if_what_was_given_is():
    one = State(LONG[0], RATES[0])
    normalised = State(one.orientation, RATES[0])
    assert one.orientation.tobytes() == normalised.orientation.tobytes()
    assert one != normalised
    assert eval(repr(one)) == one
    assert {one: 1}[State(LONG[0], RATES[0])] == 1
    assert normalised not in {one: 1}
    assert hash(State((1, 0, 0, 0), (0, 0, 0.0))) == hash(State((1, 0, 0, 0), (0, 0, -0.0)))
    with pytest.raises(TypeError, match="many states cannot be hashed"):
        hash(State(LONG, RATES))


def test_states_tops_and_motions_show_what_they_are():
    start = State((1, 0, 0, 0), (0, 0, 200.0))
    text = "State(orientation=(1.0, 0.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 200.0))"
    assert repr(start) == text
    assert eval(repr(start)) == start
    assert repr(Motion(ARTICLE, start)) == f"Motion({ARTICLE!r}, {start!r})"
    assert repr(Motion(ARTICLE, start).at([1.0, 2.0])) == "<State of shape (2,)>"


def test_the_bits_of_angles_are_those_of_every_other_machine():
    rng = np.random.default_rng(6)
    angles = rng.uniform(-4, 4, (6, 1000)) * [[1], [1], [1e5], [1], [1], [30]]
    names = "theta", "phi", "psi", "theta_dot", "phi_dot", "psi_dot"
    states = State.from_euler(**dict(zip(names, angles, strict=True)))
    found = [*states._parts, *states.euler_angles, *states.euler_rates]
    digest = hashlib.sha256(b"".join(np.ascontiguousarray(each).tobytes() for each in found))
    assert digest.hexdigest()[:12] == "4bcd9fccacbc"


def test_a_table_has_a_column_for_each_quantity_of_many_states():
    times = np.linspace(0.0, 1.0, 7)
    states = Motion(ARTICLE, CUSPS).at(times)
    table = states.table(times)
    assert {column.shape for column in table.values()} == {(7,)}
    assert np.array_equal(table["t"], times)
    assert np.array_equal(np.stack([table[c] for c in "wxyz"], axis=1), states.orientation)
    assert np.array_equal(table["wz"], states.angular_velocity[:, 2])
    assert np.array_equal(table["theta"], states.euler_angles.theta)
    assert np.array_equal(table["psi_dot"], states.euler_rates.psi_dot)
    table["w"][0] = 2.0  # the table is the caller's
    assert states.orientation[0, 0] != 2.0
    with refused("times", "of shape (7,), one for each state", "shape (6,)"):
        states.table(times[1:])
    with refused("states", "of shape (n,)", "shape ()"):
        states[0].table(0.0)


def test_only_an_upright_weight_needs_spin_to_sleep():
    assert Top(1.0, 0.5, 4.0).critical_spin == 8.0
    assert Top(1.0, 0.5, -4.0).critical_spin == 0.0


def test_a_friction_without_a_coefficient_is_false():
    assert not Friction()
    assert Friction(axial=1e-9)
    assert Friction(transverse=1e-9)


# docs/accuracy.md. A rotation is two cross products: their roundings give 7.2 eps at most, and a
# quaternion whose norm is off by d gives 2 d. In halves of eps, and relative to sin(theta), z' in
# the body has 2.4 of its products and sums, and its length 3.3 more of a square root; phi' is a
# product of 2 more, divided twice by that: 2 + 2.4 + 2 (2.4 + 3.3) + 2 = 17.8. psi' adds 2.5 of
# cos(theta) and 2 of a product and a difference: 22.3 halves. A kick adds 9.8 to the 17.8 of phi'.
PROMISED, TURNED, OF_RATES = 5 * EPS, 8 * EPS, 12 * EPS


def states(near, count):
    """States with theta anywhere, down to 1e-9 from a pole, or with parts down to 1e-12."""
    rng = Numbers(5)
    for _ in range(count):
        small = rng.power(-9, 0)
        theta = {"pole": small, "lower pole": math.pi - small}.get(near, rng.uniform(0.1, 3.0))
        phi, psi = rng.uniform(-3, 3), rng.uniform(-3, 3)
        rates = {name: rng.uniform(-2, 2) for name in ("theta_dot", "phi_dot", "psi_dot")}
        state = State.from_euler(theta=theta, phi=phi, psi=psi, **rates)
        if near == "zero":
            parts = [rng.choice((-1, 1)) * rng.power(-12, 0) for _ in range(4)]
            state = State(normalize(parts), state.angular_velocity)
        yield state


def everywhere(test):
    """Run a test with some states of each kind."""
    near = pytest.mark.parametrize("near", ["pole", "lower pole", "nothing", "zero"])
    return near(pytest.mark.parametrize("count", trials(200, 1000))(test))


@everywhere
def test_angles_and_rates_keep_their_digits(near, count):
    for state in states(near, count):
        with mp.workdps(50):
            q, omega = exact_parts(state)
            (phi, theta, psi), rates = exact_euler(q, omega)
            angles = state.euler_angles
            size = mp.norm(omega)
            sine = mp.sin(theta)
            off = abs(mp.norm([mpf(part) for part in state.orientation.tolist()]) - 1)
            assert abs(angles.theta - theta) <= PROMISED * theta
            for angle, value in ((angles.phi, phi), (angles.psi, psi)):
                turns = (angle - value) / (2 * mp.pi)
                assert abs(turns - mp.nint(turns)) * 2 <= PROMISED
            for rate, value in zip(state.euler_rates, rates, strict=True):
                assert abs(rate - value) <= (OF_RATES + 2 * off) * size / sine


@everywhere
def test_angular_momentum_and_torque_keep_their_digits(near, count):
    Ix, Iz, Mgl = map(mpf, ARTICLE.moments)
    for state in states(near, count):
        with mp.workdps(50):
            q, (wx, wy, wz) = exact_parts(state)
            momentum = turn(q, [Ix * wx, Ix * wy, Iz * wz])
            axis = turn(q, [mpf(0), mpf(0), Mgl])
            torque = [-axis[1], axis[0], mpf(0)]
            off = abs(mp.norm([mpf(part) for part in state.orientation.tolist()]) - 1)
            for found, value in (
                (ARTICLE.angular_momentum(state), momentum),
                (ARTICLE.gravity_torque(state), torque),
            ):
                parts = zip(value, found.tolist(), strict=True)
                error = mp.norm([a - b for a, b in parts])
                assert error <= (TURNED + 2 * off) * mp.norm(value)


@pytest.mark.parametrize("theta_dot", [-20.0, 30.0, -60.0])
def test_an_axis_that_passes_the_pole_keeps_the_digits_of_its_tilt(theta_dot):
    start = State.from_euler(theta=0.9, theta_dot=theta_dot, phi=0.3)
    motion = Motion(ARTICLE, start)
    chance = random.Random(theta_dot)
    times = [chance.uniform(1.0, 1e6) for _ in range(1000)]
    tilts = zip(times, motion.at(times).euler_angles.theta.tolist(), strict=True)
    for t, tilt in [each for each in tilts if 1e-3 < each[1] < 0.05][:8]:
        with mp.workdps(30):
            (_, theta, _), _ = exact_euler(*Case(ARTICLE, start, t).exact)
            # As promised. Below 1e-3 rad 2^-62 of a turn, to which phases are known, counts.
            assert abs(tilt - theta) <= 10 * EPS * theta
