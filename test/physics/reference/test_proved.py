"""States as balls: they prove errors of the kernel, and are as small as is asked for."""

import math

import pytest
from flint import arb, ctx
from physics.proofs import find_errors
from physics.reference.cases import ASYMPTOTIC, CASES, PENDULUM
from trials import choose

from symtop_ros.physics import Motion
from symtop_ros.physics.reference.balls import ProvedState, TooFewBitsError
from symtop_ros.physics.reference.proved import bound_errors, prove_state
from symtop_ros.physics.reference.series import Inputs


def test_an_attitude_next_to_the_separatrix_is_proved_within_the_promise() -> None:
    top, start, t = ASYMPTOTIC
    attitude, rate = find_errors(Motion(top, start), t)
    assert bool(attitude < 20)
    assert bool(rate < 10)
    assert bool(attitude > 10)  # so a promise of 10 eps would be false


def test_a_rate_of_a_pendulum_is_proved_within_the_promise() -> None:
    top, start, t = PENDULUM
    attitude, rate = find_errors(Motion(top, start), t)
    assert bool(attitude < 20)
    assert bool(rate < 10)
    assert bool(rate > 5)  # so a promise of 5 eps would be false


@pytest.mark.parametrize("t", [math.nan, math.inf, -math.inf])
def test_a_time_that_is_not_finite_is_refused(t: float) -> None:
    with pytest.raises(ValueError, match="t must be a finite number"):
        prove_state(Inputs.of(*CASES["tilted"]), t)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("friction", choose(((0.0, 0.0), (0.01, 0.02)), ((0.0, 0.0),)))
def test_radii_are_as_small_as_is_asked_for(name: str, friction: tuple[float, float]) -> None:
    inputs = Inputs.of(*CASES[name])
    drag = [each * float(inputs.Ix) for each in friction]
    for digits in (5, 40):
        found = prove_state(inputs, 0.75, digits, drag)
        assert found.is_within(arb(10) ** -digits)


def test_a_state_that_would_take_too_many_bits_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("symtop_ros.physics.reference.balls.MOST_BITS", 200)
    with pytest.raises(TooFewBitsError, match="need more than 200 bits"):
        prove_state(Inputs.of(*CASES["tilted"]), 1.0, 100)


def test_an_error_is_an_angle_and_a_length() -> None:
    exact = ProvedState((arb(1), arb(0), arb(0), arb(0)), (arb(1), arb(2), arb(3)), arb(3))
    with ctx.workprec(100):
        half = arb(0.125)
        q = [float(half.cos()), 0.0, float(half.sin()), 0.0]
        for sign in (1, -1):  # q and -q are one attitude
            angle, length = bound_errors(exact, [sign * each for each in q], [1.0, 5.0, 7.0])
            assert bool(abs(angle - arb(0.25)) < 1e-15)
            assert bool(abs(length - 5) < 1e-15)


def test_a_ball_that_is_not_finite_is_never_small() -> None:
    nan = arb.nan()
    state = ProvedState((nan,) * 4, (nan,) * 3, arb(1))
    assert not state.is_within(arb(1e9))
    angle, length = bound_errors(state, [1.0, 0, 0, 0], [0.0] * 3)
    assert bool(angle.upper() > 3)  # as any angle may be
    assert not length.is_finite()
