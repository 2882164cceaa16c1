"""Polynomials and their defect: states with friction and torques as balls."""

from fractions import Fraction

import pytest
from flint import arb, ctx
from physics.reference.cases import CASES
from trials import choose

from symtop_ros.physics.reference.balls import ProvedState, TooFewBitsError, to_ball
from symtop_ros.physics.reference.enclosure import Enclosure, Field
from symtop_ros.physics.reference.proved import prove_state, prove_states
from symtop_ros.physics.reference.series import Inputs, Series

DRIVES = {
    "friction": ((0.03, 0.02), (0.0, 0.0, 0.0)),
    "torque": ((0.0, 0.0), (0.3, -0.2, 0.1)),
    "both": ((0.03, 0.02), (0.3, -0.2, 0.1)),
}


def _balls(state: ProvedState) -> tuple[arb, ...]:
    return (*state.orientation, *state.angular_velocity)


def _drive(name: str, inputs: Inputs) -> tuple[list[float], list[float]]:
    """Return friction and torque for a top of any size."""
    friction, torque = DRIVES[name]
    return tuple([each * float(inputs.Ix) for each in part] for part in (friction, torque))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("drive", choose(DRIVES, ("both",)))
@pytest.mark.parametrize("t", choose((0.75, -0.5), (-0.5,)))
def test_balls_agree_with_a_series_of_more_digits(name: str, drive: str, t: float) -> None:
    inputs = Inputs.of(*CASES[name])
    found = prove_state(inputs, t, 30, *_drive(drive, inputs))
    series = Series(inputs, 60, *_drive(drive, inputs))
    with ctx.workprec(400):
        # the series has no proof: of 60 digits it has 40 and more
        doubt = arb(0, 1e-40) * (1 + found.size)
        second = to_ball(series.second)
        numbers = [arb(each) / 2**series.bits for each in series.find(Fraction(t))]
        numbers[4:] = [each * second for each in numbers[4:]]
        pairs = zip(_balls(found), numbers, strict=True)
        assert all(ball.overlaps(other + doubt) for ball, other in pairs)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", choose(("tilted", "hung", "through the top", "released"), ("hung",))
)
def test_balls_of_few_bits_contain_those_of_many(name: str) -> None:
    inputs = Inputs.of(*CASES[name])
    drive = _drive("both", inputs)
    t = Fraction(3, 4)
    sharp = Enclosure(inputs, 400, *drive).at(t)
    for bits in (80, 110, 160, 240):
        found = Enclosure(inputs, bits, *drive).at(t)
        with ctx.workprec(1000):
            pairs = zip(_balls(found), _balls(sharp), strict=True)
            assert all(a.contains(b) for a, b in pairs)


def test_one_integration_serves_for_times_in_any_order() -> None:
    inputs = Inputs.of(*CASES["tilted"])
    times = [1.5, -0.25, 0.0, 0.5]
    drive = _drive("both", inputs)
    together = prove_states(inputs, times, 30, *drive)
    for t, one in zip(times, together, strict=True):
        with ctx.workprec(200):
            alone = prove_state(inputs, t, 30, *drive)
            pairs = zip(_balls(one), _balls(alone), strict=True)
            assert all(a.overlaps(b) for a, b in pairs)


def test_a_spin_decays_as_an_exponential() -> None:
    inputs = Inputs.exact(1, Fraction(1, 2), 0, (1, 0, 0, 0), (0, 0, 4))
    found = prove_state(inputs, 6.0, 30, (10.0, 0.0))
    with ctx.workprec(300):
        assert found.angular_velocity[2].overlaps(4 * arb(-120).exp())
        angle = arb(4) / 20 * (1 - arb(-120).exp())
        assert found.orientation[0].overlaps((angle / 2).cos())


@pytest.mark.parametrize("number", range(7))
def test_a_wrong_sign_in_an_equation_leaves_no_ball(
    number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The polynomials obey other equations, and their defect is as large as the slopes."""
    right = Field.slopes

    def slopes(self: Field, state: list[arb]) -> list[arb]:
        found = right(self, state)
        found[number] = -found[number]
        return found

    monkeypatch.setattr(Field, "slopes", slopes)
    inputs = Inputs.of(*CASES["tilted"])
    with pytest.raises(TooFewBitsError):
        Enclosure(inputs, 200, *_drive("both", inputs)).at(Fraction(1, 2))


def test_a_wrong_digit_of_a_coefficient_widens_the_ball(monkeypatch: pytest.MonkeyPatch) -> None:
    """The polynomials need no trust."""
    inputs = Inputs.of(*CASES["tilted"])
    sharp = Enclosure(inputs, 400).at(Fraction(1, 2))
    right = Series._expand

    def expand(self: Series, state: list[int]) -> list[list[int]]:
        found = right(self, state)
        found[1][3] += 1 << (self.bits - 40)
        return found

    monkeypatch.setattr(Series, "_expand", expand)
    wide = Enclosure(inputs, 400).at(Fraction(1, 2))
    with ctx.workprec(500):
        pairs = list(zip(_balls(wide), _balls(sharp), strict=True))
        assert all(a.contains(b) for a, b in pairs)
        assert bool(wide.orientation[1].rad() > 2.0**-60)
