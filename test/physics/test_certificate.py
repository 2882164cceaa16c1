"""Certificates: proved bounds of the errors of states that are asked for."""

import math

import numpy as np
import pytest
from mpmath import mp, mpf
from physics.clamped import follow_clamped
from physics.reference.cases import ASYMPTOTIC, CASES, PENDULUM
from physics.tops import ARTICLE, CUSPS, EPS
from programs import run_python

from symtop_ros.physics import ExactTimes, Friction, Motion, Pushes, State, Top
from symtop_ros.physics.reference.proved import prove_state
from symtop_ros.physics.reference.series import Inputs

FRICTION = Friction(axial=2e-6, transverse=1e-5)


def test_a_bound_of_an_attitude_next_to_the_separatrix_is_a_large_error() -> None:
    top, start, t = ASYMPTOTIC
    found = Motion(top, start).certify(t)
    assert 10 * EPS < found.attitude < 11 * EPS


def test_a_bound_of_a_rate_of_a_pendulum_is_a_large_error() -> None:
    top, start, t = PENDULUM
    largest = float(prove_state(Inputs.of(top, start), t).size.mid())
    found = Motion(top, start).certify(t)
    assert 5 * EPS < found.angular_velocity / largest < 7 * EPS


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("is_driven", [False, True])
def test_bounds_of_hard_cases_are_within_what_is_promised(name: str, is_driven: bool) -> None:
    top, start = CASES[name]
    friction = Friction(0.01 * top.Ix, 0.02 * top.Ix) if is_driven else Friction()
    found = Motion(top, start, friction).certify([0.0, 0.75, -0.25])
    assert found.attitude.shape == found.angular_velocity.shape == (3,)
    assert (found.attitude >= 0).all()
    assert (found.attitude < 20 * EPS).all()
    assert (found.angular_velocity < 10 * EPS * 20).all()  # of at most 20 rad/s


def test_a_bound_is_that_of_the_states_which_are_given(monkeypatch: pytest.MonkeyPatch) -> None:
    """Attitudes that are turned by 1e-9 rad, and rates that are 1e-7 rad/s off."""
    motion = Motion(ARTICLE, CUSPS)
    right = Motion.at

    def at(self: Motion, t: float) -> State:
        state = right(self, t)
        w, x, y, z = state.orientation.T
        turned = np.stack((w - z * 5e-10, x + y * 5e-10, y - x * 5e-10, z + w * 5e-10), axis=-1)
        return State._wrap(turned, state.angular_velocity + np.array([1e-7, 0.0, 0.0]))

    monkeypatch.setattr(Motion, "at", at)
    found = motion.certify([1.0, 2.0])
    assert found.attitude == pytest.approx([1e-9] * 2, rel=1e-5)
    assert found.angular_velocity == pytest.approx([1e-7] * 2, rel=1e-5)


def test_exact_times_are_taken_exactly() -> None:
    motion = Motion(ARTICLE, CUSPS)
    year = 365 * 86_400 * 10**9
    times = ExactTimes(np.array([year, year + 1]), factor=0.1)
    assert (motion.certify(times).attitude < 20 * EPS).all()
    assert isinstance(motion.certify(ExactTimes(year)).attitude, float)
    # a double of seconds is up to 2 ns off: the state at that time differs, and is as right
    assert motion.certify(times.seconds).attitude.max() < 20 * EPS
    assert motion.at(times[0:1]) != motion.at(times.seconds[0:1] + 1e-9)


def test_shapes_are_those_of_the_times() -> None:
    motion = Motion(ARTICLE, CUSPS, FRICTION)
    assert motion.certify(np.zeros((2, 3))).attitude.shape == (2, 3)
    assert motion.certify([]).angular_velocity.shape == (0,)
    assert isinstance(motion.certify(0.125).angular_velocity, float)


@pytest.mark.parametrize("Mgl", [0.068, -0.068, 0.0])
def test_a_clamped_motion_is_proved_as_one_in_its_vertical_plane(Mgl: float) -> None:
    top = Top(ARTICLE.Ix, ARTICLE.Iz, Mgl)
    start = State.from_euler(
        theta=0.5, phi=1.0, psi=2.0, theta_dot=-3.0, phi_dot=4.0, psi_dot=200.0
    )
    found = Motion(top, start, clamped=True).certify([0.0, 0.1, -2.0, 1e3])
    assert found.attitude.max() < 20 * EPS
    assert found.angular_velocity.max() < 10 * EPS * 50  # rad/s: the fastest fall has 35
    exact = prove_state(Inputs.of(top, start).clamp(), 0.1)
    with mp.workdps(40):
        q, omega = follow_clamped(top, start, 0.1)
        pairs = zip(exact.orientation + exact.angular_velocity, q + omega, strict=True)
        assert all(abs(mpf(ball.mid().str(38, radius=False)) - x) < 1e-28 for ball, x in pairs)


@pytest.mark.parametrize("t", [math.nan, math.inf, [1.0, -math.inf], "soon"])
def test_a_time_that_is_no_finite_number_is_refused(t: object) -> None:
    with pytest.raises(ValueError, match="t must be an array of finite numbers"):
        Motion(ARTICLE, CUSPS).certify(t)


def test_a_time_beyond_the_farthest_is_refused_as_by_at() -> None:
    motion = Motion(ARTICLE, CUSPS)
    with pytest.raises(ValueError, match="t must be"):
        motion.certify(2 * motion.farthest_time)


def test_pushes_are_refused() -> None:
    motion = Motion(ARTICLE, CUSPS, pushes=Pushes(5e-5, 20.0, 20))
    with pytest.raises(ValueError, match="pushes must be none for a certificate: take a piece"):
        motion.certify(1.0)


def test_without_the_extra_a_certificate_is_refused_in_words() -> None:
    code = "import sys; sys.modules['flint'] = None\n"
    code += "from symtop_ros.physics import Motion, State, Top\n"
    code += "motion = Motion(Top(1.0, 0.5, 2.0), State.from_euler(theta=0.5))\n"
    code += "try: motion.certify(1.0)\nexcept ValueError as error: print(error)"
    done = run_python(code)
    advice = "pip install python-flint, on Debian and Ubuntu into a venv"
    assert done.stdout == f"a certificate needs flint: {advice}\n"
    assert (done.returncode, done.stderr) == (0, "")


def test_a_proof_of_too_many_bits_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("symtop_ros.physics.reference.balls.MOST_BITS", 100)
    with pytest.raises(ValueError, match="t must be one that 100 bits can prove, got 1 s"):
        Motion(Top(1.0, 0.5, 2.0), CUSPS).certify(1.0)
