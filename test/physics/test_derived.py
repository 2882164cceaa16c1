"""Angles, rates, angular momentum and torque of a state, compared with 50 digits."""

import math
import random

import pytest
from mpmath import mp, mpf
from physics.tops import ARTICLE, EPS, Case, exact_euler, exact_parts, turn
from trials import trials

from symtop_ros.physics import Motion, State

# docs/accuracy.md. A rotation is two cross products: their roundings give 7.2 eps at most, and a
# quaternion whose norm is off by d gives 2 d.
PROMISED, TURNED = 5 * EPS, 8 * EPS


def make_size(rng, bits):
    """A number of 2^-bits to 1, of any size with the same chance."""
    return math.ldexp(rng.uniform(1.0, 2.0), -rng.randint(1, bits))


def make_orientation(rng):
    """A quaternion with parts down to 1e-12."""
    parts = [rng.choice((-1, 1)) * make_size(rng, 40) for _ in range(4)]
    size = math.sqrt(sum(part * part for part in parts))
    return [part / size for part in parts]


def states(near, count):
    """States with theta anywhere, down to 1e-9 from a pole, or with parts of all sizes.

    Their numbers come from sums, products and square roots alone, so that they have the same bits
    on every processor: powers and norms of NumPy do not.
    """
    rng = random.Random(5)
    for _ in range(count):
        small = make_size(rng, 30)
        theta = {"pole": small, "lower pole": math.pi - small}.get(near, rng.uniform(0.1, 3.0))
        phi, psi = rng.uniform(-3, 3), rng.uniform(-3, 3)
        rates = {name: rng.uniform(-2, 2) for name in ("theta_dot", "phi_dot", "psi_dot")}
        state = State.from_euler(theta=theta, phi=phi, psi=psi, **rates)
        if near == "zero":
            state = State(make_orientation(rng), state.angular_velocity)
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
            angles, size, sine = state.euler_angles, mp.norm(omega), mp.sin(theta)
            assert abs(angles.theta - theta) <= PROMISED * theta
            for angle, value in ((angles.phi, phi), (angles.psi, psi)):
                turns = (angle - value) / (2 * mp.pi)
                assert abs(turns - mp.nint(turns)) * 2 <= PROMISED
            for rate, value in zip(state.euler_rates, rates, strict=True):
                assert abs(rate - value) <= PROMISED * size / sine


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
    motion, chance = Motion(ARTICLE, start), random.Random(theta_dot)
    times = [chance.uniform(1.0, 1e6) for _ in range(1000)]
    tilts = zip(times, motion.at(times).euler_angles.theta.tolist(), strict=True)
    for t, tilt in [each for each in tilts if 1e-3 < each[1] < 0.05][:8]:
        with mp.workdps(30):
            (_, theta, _), _ = exact_euler(*Case(ARTICLE, start, t).exact)
            # As promised. Below 1e-3 rad 2^-62 of a turn, to which phases are known, counts.
            assert abs(tilt - theta) <= 4 * EPS * theta
