"""Theta functions in balls: sound at each precision, and agreeing with the series."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest
from flint import arb, ctx
from physics.families import DRAWS, draw_motion
from physics.reference.cases import CASES
from trials import choose, trials

from symtop_ros.physics.reference.balls import ProvedState
from symtop_ros.physics.reference.enclosure import Enclosure
from symtop_ros.physics.reference.fall import Fall, Nutation, find_fall
from symtop_ros.physics.reference.proved import prove_state
from symtop_ros.physics.reference.series import Inputs

MANY = 1500  # bits
FEW = (53, 64, 80, 110, 160, 240)  # bits
RADIANS = 3.0  # so far the series follows random motions
TIMES = Fraction(13, 8), Fraction(-3, 4)


def _balls(state: ProvedState) -> tuple[arb, ...]:
    return (*state.orientation, *state.angular_velocity)


def _fall(inputs: Inputs, t: Fraction, bits: int) -> tuple[arb, ...]:
    """Return the balls of some bits, none if they are too few."""
    try:
        with ctx.workprec(bits):
            return _balls(find_fall(inputs, t))
    except (ArithmeticError, ValueError):
        return ()


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("t", TIMES)
def test_balls_of_few_bits_contain_those_of_many(name: str, t: Fraction) -> None:
    inputs = Inputs.of(*CASES[name])
    sharp = _fall(inputs, t, MANY)
    assert all(ball.is_finite() for ball in sharp)
    with ctx.workprec(MANY):
        for bits in FEW:
            found = _fall(inputs, t, bits)
            pairs = zip(found, sharp, strict=True) if found else ()
            assert all(not a.is_finite() or a.contains(b) for a, b in pairs)
        assert _fall(inputs, t, FEW[-1])  # so that some were compared


@pytest.mark.parametrize("family", DRAWS)
@pytest.mark.parametrize("count", trials(1, 10))
def test_balls_of_random_motions_contain_those_of_many_bits(family: str, count: int) -> None:
    for number in range(count):
        motion, t = draw_motion(family, number)
        inputs = Inputs.of(motion.top, motion.start)
        sharp = _fall(inputs, Fraction(t), MANY)
        with ctx.workprec(MANY):
            for bits in FEW:
                pairs = zip(_fall(inputs, Fraction(t), bits) or sharp, sharp, strict=True)
                assert all(not a.is_finite() or a.contains(b) for a, b in pairs)


def _find_time(inputs: Inputs) -> Fraction:
    """Return a time in s at which a motion has turned by some rad."""
    swing = float(abs(inputs.Mgl) / inputs.Ix) ** 0.5
    fastest = max(map(abs, (*inputs.angular_velocity, Fraction(swing))))
    return Fraction(RADIANS) / (fastest or 1)


def _agree(inputs: Inputs, t: Fraction) -> bool:
    """Return whether two proofs that share no formula overlap, with small balls."""
    closed = prove_state(inputs, t, 40)
    series = Enclosure(inputs, 200).at(t)
    assert all(bool(each.rad() < 1e-25) for each in series.orientation)
    with ctx.workprec(300):
        pairs = zip(_balls(closed), _balls(series), strict=True)
        return all(a.overlaps(b) for a, b in pairs)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("sign", choose((1, -1), (-1,)))
def test_hard_cases_agree_with_the_series_which_shares_no_formula(name: str, sign: int) -> None:
    inputs = Inputs.of(*CASES[name])
    assert _agree(inputs, sign * _find_time(inputs))


@pytest.mark.parametrize("family", DRAWS)
@pytest.mark.parametrize("count", trials(1, 25))  # 500 motions of 20 families
def test_random_motions_agree_with_the_series_which_shares_no_formula(
    family: str, count: int
) -> None:
    for number in range(count):
        motion, _ = draw_motion(family, number)
        inputs = Inputs.of(motion.top, motion.start)
        assert _agree(inputs, (-1) ** number * _find_time(inputs)), number


def turn_rotation_of_A(before: Callable[..., Any]) -> Callable[..., Any]:
    def parts(self: Fall) -> Any:
        A, *others = before(self)
        return [(*A[:3], -A[3]), *others]

    return parts


def turn_phase(before: Callable[..., Any]) -> Callable[..., Any]:
    return lambda self, k, v: before(self, k, v) * (-1 if k == 1 else 1)


def turn_slope(before: Callable[..., Any]) -> Callable[..., Any]:
    return lambda self, v: -before(self, v)


def turn_time(before: Callable[..., Any]) -> Callable[..., Any]:
    return lambda self, X: before(self, X) * -1


WRONG = {
    "the rotation of A": (Fall, "parts", turn_rotation_of_A),
    "the phase of B": (Nutation, "_find_xi", turn_phase),
    "the slope of u'^2, at a root": (Fall, "f1", turn_slope),
    "the phase of the start": (Nutation, "_reduce", turn_time),
}


@pytest.mark.parametrize("formula", WRONG)
def test_a_wrong_sign_in_a_formula_is_noticed(
    formula: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("symtop_ros.physics.reference.balls.MOST_BITS", 1000)
    owner, name, change = WRONG[formula]
    monkeypatch.setattr(owner, name, change(getattr(owner, name)))
    noticed = []
    for case in ("tilted", "released", "through the top"):
        inputs = Inputs.of(*CASES[case])
        try:
            noticed.append(not _agree(inputs, _find_time(inputs)))
        except ArithmeticError:
            noticed.append(True)  # no ball is small
    assert any(noticed)
