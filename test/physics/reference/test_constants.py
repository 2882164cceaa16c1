"""Constants in balls: against those that are stored, which two precisions gave, and the kernel."""

import math
from collections.abc import Iterator
from typing import Any

import pytest
from drawn import Numbers
from flint import arb, ctx
from physics.exact_motions import DIGITS, read_motions
from physics.families import draw_motion
from physics.kernel.exact.test_weightless import draw_motion as draw_weightless
from physics.reference.cases import ASYMPTOTIC, CASES
from physics.tops import EPS
from trials import trials

from symtop_ros.physics import Motion, State, Top
from symtop_ros.physics.reference import ProvedConstants, exact_constants
from symtop_ros.physics.reference.constants import find_constants, prove_constants
from symtop_ros.physics.reference.fall import Fall
from symtop_ros.physics.reference.series import Inputs

FALLS = [each for each in read_motions() if not each.motion.is_driven]
STEPS = trials(10, 1)  # every tenth of them, or all
# The kernel takes numbers as equal that differ by the rounding of a start.
ROUNDED = "regular", "through the pole", "cusps"


def _is_near(ball: arb, text: str) -> bool:
    """Return whether a stored number may be that of a ball, to half a unit and the radius."""
    with ctx.workdps(60):
        stored = arb(text)
        return (ball - stored).overlaps(abs(stored) * arb(0, 0.5 * 10 ** (1.0 - DIGITS)))


@pytest.mark.parametrize("step", STEPS)
def test_periods_and_mean_rates_that_are_stored_are_proved(step: int) -> None:
    compared = 0
    for each in FALLS[::step]:
        found = prove_constants(each.inputs, 35)
        if found.period.is_finite():
            assert _is_near(found.period, each.row["period"])
        if each.row["rates"] and found.mean_rates[0].is_finite():
            compared += 1
            assert all(map(_is_near, found.mean_rates, each.row["rates"])), each.family
    assert compared > 1000 / step


@pytest.mark.parametrize("step", STEPS)
def test_kinds_are_those_of_the_kernel_but_for_what_it_takes_as_equal(step: int) -> None:
    for each in FALLS[::step]:
        exact = prove_constants(each.inputs, 10).kind
        kind = each.motion.kind
        assert exact == kind or (kind in ROUNDED and exact not in ("asymptotic", "sleeping"))


@pytest.mark.parametrize("step", STEPS)
def test_turning_angles_are_those_of_the_kernel(step: int) -> None:
    for each in FALLS[::step]:
        found = prove_constants(each.inputs, 20).turning_angles
        # a turning angle next to a pole is as uncertain as the root of a rounding
        pairs = zip(found, each.motion.turning_angles, strict=True)
        assert all(abs(float(a) - b) < 3e-8 for a, b in pairs), each.family


@pytest.mark.parametrize("name", CASES)
def test_balls_contain_those_of_more_bits(name: str) -> None:
    inputs = Inputs.of(*CASES[name])
    few, many = (prove_constants(inputs, digits) for digits in (20, 200))
    assert few.kind == many.kind
    with ctx.workprec(1000):
        for a, b in zip((*few[2], *few[3]), (*many[2], *many[3]), strict=True):
            assert a.contains(b) or (a.is_nan() and b.is_nan())


def test_equal_roots_are_decided_and_an_ulp_next_to_them_is_not_equal() -> None:
    top, start, _ = ASYMPTOTIC
    assert exact_constants(top, start).kind == "asymptotic"
    nudged = Top(*top.moments[:2], top.Mgl * (1 - 2.0**-52))
    found = exact_constants(nudged, start)
    assert found.kind != "asymptotic"
    assert found.period.is_finite()


def test_a_pendulum_passes_the_lower_pole_and_a_cone_is_regular() -> None:
    swings = Motion(Top(1.0, 0.5, 2.0), State((0.8, 0.6, 0.0, 0.0), (0.0, 0.0, 0.0)))
    found = exact_constants(swings.top, swings.start)
    assert (found.kind, swings.kind) == ("through the pole", "through the pole")
    cone = Motion(Top(1.0, 0.5, 0.5), State((0.5, 0.5, 0.5, 0.5), (0.0, 1.0, 1.0)))
    found = exact_constants(cone.top, cone.start)
    assert found.kind == cone.kind == "regular"  # horizontal: a phi' = Mgl/Ix
    assert all(rate.overlaps(arb(1)) for rate in found.mean_rates)
    assert cone.nutation_period == pytest.approx(float(found.period), rel=1e-15)


def test_a_root_beyond_the_pole_at_which_phi_would_rest_makes_no_cusps() -> None:
    """b/a = alpha/beta = 2: both terms of u'^2 vanish at u = 2, and phi' is positive on the way."""
    motion = Motion(Top(1.0, 1.0, 0.5), State((0.5, 0.5, 0.5, 0.5), (1.0, 1.0, 0.5)))
    assert exact_constants(motion.top, motion.start).kind == motion.kind == "unidirectional"


def _list_weightless(count: int) -> Iterator[Motion]:
    rng = Numbers("constants without weight")
    for _ in range(count):
        yield draw_weightless(rng, rng.randint(-12, 0))


def _are_near(motion: Motion, found: ProvedConstants) -> bool:
    """Whether constants of the kernel are those in balls, each to some EPS of itself."""
    rates = motion.mean_precession_rate, motion.mean_spin_rate
    numbers = *motion.turning_angles, motion.nutation_period, *rates
    size = max(map(abs, rates))
    sizes = *motion.turning_angles, motion.nutation_period, size, size
    exact = *found.turning_angles, found.period, *found.mean_rates
    return all(
        number == float(ball)
        or (math.isnan(number) and ball.is_nan())
        or abs(number - float(ball)) <= 4 * EPS * scale
        for number, ball, scale in zip(numbers, exact, sizes, strict=True)
    )


@pytest.mark.parametrize("count", trials(60, 20_000))
def test_without_weight_they_are_those_of_the_kernel(count: int) -> None:
    kinds = set()
    for motion in _list_weightless(count):
        found = exact_constants(motion.top, motion.start)
        kinds.add(motion.kind)
        if motion.kind == found.kind:
            assert _are_near(motion, found), motion
        else:  # what counts as equal, by a rounding of the start
            assert motion.kind in ROUNDED, motion
    assert kinds == {"regular", "looping", "unidirectional", "through the pole"}


@pytest.mark.parametrize("count", trials(60, 5000))
def test_clamped_they_are_those_of_the_kernel(count: int) -> None:
    for number in range(count):
        family = ("generic", "Mgl < 0", "weightless", "near the top", "near the bottom")[number % 5]
        drawn, _ = draw_motion(family, number)
        motion = Motion(drawn.top, drawn.start, clamped=True)
        found = exact_constants(motion.top, motion.start, clamped=True)
        assert motion.kind == found.kind == "clamped"
        assert _are_near(motion, found), motion


def test_a_body_at_rest_without_weight_has_no_period() -> None:
    for start in (State.from_euler(theta=1.0), State.from_euler(theta=1.0, phi_dot=2.0)):
        held = exact_constants(Top(1.0, 0.5, 0.0), start, clamped=True)
        assert float(held.period) == math.inf
        assert held.turning_angles[0].overlaps(held.turning_angles[1])
    assert exact_constants(Top(1.0, 0.5, 0.0), State.from_euler(theta=1.0)).kind == "regular"


def test_constants_are_printed_with_the_digits_that_are_known() -> None:
    text = str(exact_constants(*CASES["sleeping"])).splitlines()
    assert text == ["kind: sleeping", "period: inf", "turning_angles: 0 0", "mean_rates: nan nan"]
    kind, period, *_ = str(exact_constants(*CASES["tilted"], 40)).splitlines()
    exact = exact_constants(*CASES["tilted"], 60).period
    assert kind == "kind: looping"
    assert period.startswith(f"period: {exact.str(40, radius=False)[:40]}")


def test_what_is_not_one_motion_under_gravity_is_refused() -> None:
    with pytest.raises(ValueError, match="start must be tilted for a clamped motion"):
        exact_constants(*CASES["sleeping"], clamped=True)
    top, start = CASES["tilted"]
    with pytest.raises(ValueError, match="top and start must be those of one motion"):
        exact_constants(Top([1.0, 2.0], 0.5, 2.0), start)
    with pytest.raises(ValueError, match="digits must be 1 or more, got 0"):
        exact_constants(top, start, 0)


def test_a_wrong_sign_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = Fall.parts

    def parts(self: Fall) -> list[tuple[Any, ...]]:
        A, *others = right(self)
        return [(*A[:3], -A[3]), *others]

    each = next(
        each for each in FALLS if each.row["rates"] and each.motion.start.angular_velocity[2]
    )
    assert all(map(_is_near, find_constants(each.inputs).mean_rates, each.row["rates"]))
    monkeypatch.setattr(Fall, "parts", parts)
    assert not any(map(_is_near, find_constants(each.inputs).mean_rates, each.row["rates"]))
