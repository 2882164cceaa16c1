"""Balls of states: they prove errors of the kernel, and agree with the series."""

from fractions import Fraction

import pytest
from flint import arb, ctx
from mpmath import mp, mpf, nstr
from physics.exact_motions import read_motions

from symtop_ros.physics import Motion, State, Top
from symtop_ros.physics.reference import Inputs, Series
from symtop_ros.physics.reference.proved import ProvedState, find_state, prove_state

# The largest errors that climbs have found, of attitude and of rates, with the time in s.
ASYMPTOTIC = (
    Top(1.0, 1.0, 50.222816944122314),
    State((0.5, 0.5, 0.5, 0.5), (5.55078125, -8.3447265625, -8.3447265625)),
    0.43182089813532337,
)
PENDULUM = (
    Top(0.014633484357533307, 0.016382813191500745, 1.1433905460050728),
    State(
        (0.4584543754896997, 0.04332316165706265, 0.19438869428189803, -0.866115306869567),
        (2.4468000659284788, 5.8403579107068255, 0.0),
    ),
    2.326967634349247,
)
TILTED, OMEGA = (0.7, 0.5, 0.1, -0.5), (0.5, -1.25, 3.0)
UPRIGHT, HANGING = (1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)
CASES = {
    "asymptotic": ASYMPTOTIC[:2],
    "pendulum": PENDULUM[:2],
    "tilted": (Top(1.0, 0.5, 2.0), State(TILTED, OMEGA)),
    "hung": (Top(1.0, 1.5, -2.0), State(TILTED, OMEGA)),
    "no weight": (Top(1.0, 0.5, 0.0), State(TILTED, OMEGA)),
    "at rest upright": (Top(1.0, 0.5, 2.0), State(UPRIGHT, (0.0, 0.0, 0.0))),
    "sleeping": (Top(1.0, 0.5, 2.0), State(UPRIGHT, (0.0, 0.0, 20.0))),
    "through the top": (Top(1.0, 0.5, 2.0), State(UPRIGHT, (1.0, 0.5, 3.0))),
    "through the bottom": (Top(1.0, 0.5, 2.0), State(HANGING, (1.0, 0.5, 3.0))),
    "released": (Top(1.0, 0.5, 2.0), State(TILTED, (0.0, 0.0, 3.0))),
    "tiny": (Top(1e-100, 1e-100, 1e-100), State(TILTED, OMEGA)),
    "huge": (Top(1e100, 1e100, 1e100), State(TILTED, OMEGA)),
}


def _balls(state: ProvedState) -> tuple[arb, ...]:
    return (*state.orientation, *state.angular_velocity)


def _errors(top: Top, start: State, t: float) -> tuple[arb, arb]:
    """Return the errors of the kernel's attitude and rates, in eps, as balls."""
    found, exact = Motion(top, start).at(t), prove_state(Inputs.of(top, start), t)
    with ctx.workprec(256):
        a, b, c, d = exact.orientation
        w, x, y, z = map(arb, found.orientation.tolist())
        across = (
            a * x - b * w - c * z + d * y,
            a * y + b * z - c * w - d * x,
            a * z - b * y + c * x - d * w,
        )
        sine = sum((s * s for s in across), arb(0)).sqrt()
        angle = 2 * arb.atan2(sine, abs(a * w + b * x + c * y + d * z))
        omega = zip(found.angular_velocity.tolist()[:2], exact.angular_velocity, strict=False)
        off = sum(((arb(p) - r) ** 2 for p, r in omega), arb(0)).sqrt()
        eps = arb(2) ** -52
        return angle / eps, off / exact.size / eps


def test_an_attitude_next_to_the_separatrix_is_proved_within_the_promise() -> None:
    attitude, rate = _errors(*ASYMPTOTIC)
    assert bool(attitude < 20)
    assert bool(rate < 10)
    assert bool(attitude > 10)  # so a promise of 10 eps would be false


def test_a_rate_of_a_pendulum_is_proved_within_the_promise() -> None:
    attitude, rate = _errors(*PENDULUM)
    assert bool(attitude < 20)
    assert bool(rate < 10)
    assert bool(rate > 5)  # so a promise of 5 eps would be false


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("t", [1.625, -0.75])
def test_balls_contain_those_of_1500_bits(name: str, t: float) -> None:
    inputs = Inputs.of(*CASES[name])
    with ctx.workprec(1500):
        sharp = _balls(find_state(inputs, Fraction(t)))
    assert all(ball.is_finite() for ball in sharp)
    for digits in (10, 30, 60):
        found = _balls(prove_state(inputs, t, digits))
        with ctx.workprec(1500):
            assert all(a.contains(b) for a, b in zip(found, sharp, strict=True))


@pytest.mark.parametrize("name", CASES)
def test_balls_agree_with_the_series_which_shares_no_formula(name: str) -> None:
    inputs = Inputs.of(*CASES[name])
    found, series = prove_state(inputs, 0.75, 30), Series(inputs, 50).at(0.75)
    with ctx.workprec(300):
        # the series has no proof: what it may be off is far below the radius that is asked for
        least = arb(10) ** -28
        for ball, other in zip(_balls(found), (*series[0], *series[1]), strict=True):
            assert bool(abs(ball - arb(nstr(other, 45))) <= least * (1 + abs(ball)))


def test_a_wrong_sign_is_noticed() -> None:
    inputs = Inputs.of(*CASES["tilted"])
    wrong = inputs._replace(Mgl=-inputs.Mgl)
    pairs = zip(_balls(prove_state(inputs, 0.75)), _balls(prove_state(wrong, 0.75)), strict=True)
    assert not all(a.overlaps(b) for a, b in pairs)


@pytest.mark.parametrize("t", [float("nan"), float("inf")])
def test_a_time_that_is_not_finite_is_refused(t: float) -> None:
    with pytest.raises(ValueError, match="t must be a finite number"):
        prove_state(Inputs.of(*CASES["tilted"]), t)


def _is_proved(stored: list[str], found: ProvedState) -> bool:
    """Return True if 25 digits are proved: to half a unit of the last, and 1e-27."""
    with ctx.workprec(200):
        q, omega = list(map(arb, stored[:4])), list(map(arb, stored[4:]))
        size = sum((abs(x) for x in found.angular_velocity), arb(0))
        turns = (1, -1)  # q and -q are one attitude
        pairs = zip(omega, found.angular_velocity, strict=True)
        rates = all(bool(abs(a - b) <= size * arb("5.1e-25")) for a, b in pairs)
        return rates and any(
            all(
                bool(abs(s * a - b) <= arb("5.1e-26"))
                for a, b in zip(q, found.orientation, strict=True)
            )
            for s in turns
        )


def test_stored_states_under_gravity_are_proved_and_a_wrong_digit_is_noticed() -> None:
    falls = [each for each in read_motions() if not each.motion.is_driven]
    assert falls
    for each in falls:
        for t, stored in zip(each.times, each.row["states"], strict=True):
            found = prove_state(each.inputs, t, 35)
            assert _is_proved(stored, found), (each.family, t)
            with mp.workdps(40):
                wrong = [nstr(mpf(stored[0]) + mpf(10) ** -24, 30), *stored[1:]]
            assert not _is_proved(wrong, found)
