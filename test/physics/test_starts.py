"""Starts from what is seen: each has it by an independent criterion, and no start is missing.

Regular precession is judged by its quadratic, and a dip by the constants, with 40 digits; nutation
periods and turning angles by the motions of the starts.
"""

import itertools
import math
import re

import numpy as np
import pytest
from drawn import PI, Numbers
from mpmath import mp, mpf
from physics.tops import ARTICLE, EPS
from trials import seeds

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import Motion, Motions, State, Top, solve_start
from symtop_ros.physics.starts import ROWS

pytestmark = pytest.mark.numbers

FEW = 200  # of each question, in a run of all tests
MANY = 5000
LONGEST_AT = 2.179660431678698  # r of the longest nutation period: derivation.md, section 12
HORIZONTAL = 2.0**-52  # |cos(theta)| that counts as zero, as docs/library.md says


class Drawn:
    """A top of any family, a tilt, and rates that are usual for it."""

    def __init__(self, seed):
        self.rng = rng = Numbers(f"starts {seed}")
        Ix = rng.power(-5, 1)
        ratio = rng.choice([rng.uniform(0.02, 2.0), rng.power(-3, 0.3), 1.0])
        pull = rng.choice([1, 1, -1, 0]) * rng.power(-1, 4)
        self.top = Top(Ix, Ix * min(ratio, 2.0), Ix * pull)
        near = rng.power(-15, 0)
        self.theta = rng.choice([rng.uniform(0.001, 3.14), near, PI - near, PI / 2])
        self.swing = math.sqrt(abs(pull) + 1e-6)

    def rate(self):
        return self.rng.choice([-1, 1]) * self.swing * self.rng.power(-2, 2)

    def spin(self):
        return self.rate() * self.top.Ix / self.top.Iz

    def period(self):
        return 2 * PI / abs(self.rate())


def find(top, **known):
    """All solutions; none if it is refused."""
    try:
        return solve_start(top, **known)
    except RefusedError:
        return ()


def cosine(theta):
    exact = mp.cos(mpf(theta))
    return exact if abs(exact) > HORIZONTAL else mpf(0)


def check_regular(top, start):
    """The quadratic vanishes up to rounding of the start: one EPS of each number in each term."""
    Ix, Iz, Mgl = map(mpf, top.moments)
    p, spin, tilt = mpf(start.phi_dot), mpf(start.psi_dot), mpf(start.theta)
    around = (Ix - Iz) * p * p
    terms = around * cosine(start.theta), -Iz * spin * p, Mgl
    moved = abs(around * mp.sin(tilt) * tilt)
    assert abs(sum(terms)) <= 3 * EPS * (sum(map(abs, terms)) + moved)
    assert start.theta_dot == 0


def count_regular(top, psi_dot, period):
    """For how many of both directions a tilt has the cosine that the quadratic asks for."""
    Ix, Iz, Mgl = map(mpf, top.moments)
    rates = [sign * 2 * mp.pi / mpf(period) for sign in (1, -1)]
    return sum(abs(Iz * psi_dot * p - Mgl) < abs((Ix - Iz) * p * p) for p in rates)


def count_rates(top, theta, psi_dot):
    """Return the number of roots of the quadratic."""
    Ix, Iz, Mgl = map(mpf, top.moments)
    a, b = (Ix - Iz) * cosine(theta), Iz * mpf(psi_dot)
    if a == 0:
        return 1 if b else 0
    return 2 if b * b - 4 * a * Mgl >= 0 else 0


@pytest.mark.parametrize("seed", seeds(1, MANY // FEW))
def test_regular_precession_has_what_was_seen_and_no_start_is_missing(seed):
    with mp.workdps(40):
        for k in range(FEW):
            one = Drawn(seed * FEW + k)
            top, theta, period, spin = one.top, one.theta, one.period(), one.spin()
            by_turn = find(top, theta=theta, precession_period=period)
            by_spin = find(top, theta=theta, psi_dot=spin)
            by_both = find(top, psi_dot=spin, precession_period=period)
            assert len(by_turn) == 2
            assert len(by_spin) == count_rates(top, theta, spin)
            assert len(by_both) == count_regular(top, spin, period)
            for start in (*by_turn, *by_spin, *by_both):
                check_regular(top, start)
            for start in (*by_turn, *by_both):
                assert abs(start.phi_dot) * period == pytest.approx(2 * PI, rel=2 * EPS)
            assert all(start.theta == theta for start in (*by_turn, *by_spin))
            assert all(start.psi_dot == spin for start in (*by_spin, *by_both))


def test_a_double_root_is_one_start():
    # (Ix - Iz) cos(theta) Mgl = 0 = Iz psi': only the rate 0 is left.
    (start,) = solve_start(Top(1.0, 0.5, 0.0), theta=1.0, psi_dot=0.0)
    assert (start.phi_dot, start.psi_dot) == (0.0, 0.0)


def draw_dip(one):
    """A dip, and the most that there can be."""
    most = PI - one.theta if one.top.Mgl > 0 else one.theta
    return most * one.rng.choice([one.rng.random(), one.rng.power(-8, 0)]), most


def find_share(top, theta, dip, psi_dot):
    """p_psi^2 (cos(theta) - cos(end)) over 2 Ix Mgl sin(end)^2: 1 if theta' vanishes at the end."""
    Ix, Iz, Mgl = map(mpf, top.moments)
    theta, dip = mpf(theta), mp.sign(Mgl) * mpf(dip)
    difference = 2 * mp.sin(theta + dip / 2) * mp.sin(dip / 2)
    return (Iz * psi_dot) ** 2 * difference / (2 * Ix * Mgl * mp.sin(theta + dip) ** 2)


@pytest.mark.parametrize("seed", seeds(1, MANY // FEW))
def test_an_axis_that_is_let_go_dips_as_far_as_was_seen(seed):
    with mp.workdps(40):
        for k in range(FEW):
            one = Drawn(seed * FEW + k)
            dip, most = draw_dip(one)
            starts = find(one.top, theta=one.theta, dip=dip)
            if one.top.Mgl == 0:
                assert not starts
                continue
            assert [each.psi_dot for each in starts] == [starts[0].psi_dot, -starts[0].psi_dot]
            # A spin is made of three roots and their products: six roundings, squared.
            share = find_share(one.top, one.theta, dip, mpf(starts[0].psi_dot))
            assert abs(share - 1) <= 12 * EPS
            assert not find(one.top, theta=one.theta, dip=most + 4 * EPS * PI)


def find_period(top, theta, psi_dot):
    return Motion(top, State.from_euler(theta=theta, psi_dot=psi_dot)).nutation_period


def find_x(top, theta, period):
    """Of the starts with a nutation period p_psi^2/(2 |Mgl| Ix), the fast one first (section 12).

    Both sides of the longest period are searched by halves, with all digits.
    """
    Ix, _, Mgl = map(mpf, top.moments)
    tilt = mpf(theta) if Mgl > 0 else mp.pi - mpf(theta)
    sine, R = mp.sin(tilt), mp.cot(tilt / 2)
    asked = mpf(period) * mp.sqrt(2 * abs(Mgl) * sine / Ix) / (2 * mp.pi)

    def find_relative(r):
        return mp.sqrt(r) / mp.agm(1, mp.sqrt(1 + r * r))

    def search(low, high, grows):
        for _ in range(220):
            middle = (low + high) / 2
            low, high = (
                (middle, high) if (find_relative(middle) < asked) == grows else (low, middle)
            )
        return sine * (R - low) * (1 + 1 / (low * R))

    fold = mpf(LONGEST_AT)
    found = [search(mpf(0), min(R, fold), grows=True)]
    if fold < R and asked >= find_relative(R):
        found.append(search(fold, R, grows=False))
    return found


@pytest.mark.parametrize("seed", seeds(1, 20))
def test_a_spin_next_to_the_pendulums_has_all_its_digits(seed):
    rng = Numbers(f"next to a pendulum {seed}")
    with mp.workdps(50):
        for _ in range(20):
            Mgl = rng.choice([-1, 1]) * rng.power(-3, 2)
            top = Top(1.0, rng.uniform(0.05, 2.0), Mgl)
            is_folded = rng.choice([False, True])  # periods beyond the pendulum's have two spins
            tilt = rng.uniform(0.1, 0.8) if is_folded else rng.uniform(0.9, 3.0)
            theta = tilt if Mgl > 0 else PI - tilt
            sign = rng.choice([-1, 1]) if is_folded else 1
            period = find_period(top, theta, 0.0) * (1 - sign * rng.power(-15, -4))
            momenta = [mp.sqrt(2 * x * abs(mpf(Mgl))) for x in find_x(top, theta, period)]
            spins = [each.psi_dot for each in find(top, theta=theta, nutation_period=period)]
            exact = [spin for each in momenta for spin in (each / top.Iz, -each / top.Iz)]
            assert spins[: len(exact)] == pytest.approx(exact, rel=6 * EPS)


def find_slope(top, theta, psi_dot):
    """The sum of the logarithmic derivatives of the nutation period, in size."""
    step = 2.0**-20
    period = find_period(top, theta, psi_dot)
    changes = [
        find_period(top, theta, psi_dot * (1 + step)) - period,
        find_period(top, theta * (1 - step), psi_dot) - period,
    ]
    return sum(abs(each) for each in changes) / (step * period)


def count_spins(top, theta, period):
    """Return how often the period passes through the one seen as the spin grows from 0."""
    critical = 2 * math.sqrt(abs(top.Mgl) * top.Ix) / top.Iz
    shares = np.ldexp(1 + np.arange(64) / 64, np.arange(-30, 30)[:, None]).reshape(-1)
    spins = np.concatenate([[0.0], critical * shares])
    start = State.from_euler(theta=theta, psi_dot=spins)
    above = Motions(top, start).nutation_period > period
    return int(np.count_nonzero(above[1:] != above[:-1]))


@pytest.mark.parametrize("seed", seeds(1, MANY // FEW))
def test_an_axis_that_is_let_go_nutates_in_the_time_that_was_seen(seed):
    for k in range(FEW):
        one = Drawn(seed * FEW + k)
        spin = one.spin()
        period = find_period(one.top, one.theta, spin)
        if one.top.Mgl == 0 or not math.isfinite(period):
            continue
        starts = find(one.top, theta=one.theta, nutation_period=period)
        assert len(starts) in (2, 4)
        for start in starts:
            slope = find_slope(one.top, one.theta, start.psi_dot)
            again = find_period(one.top, one.theta, start.psi_dot)
            # The spin and the tilt have some EPS, and so has the period.
            assert again == pytest.approx(period, rel=32 * EPS * (1 + slope))


@pytest.mark.parametrize("seed", seeds(30, 600))
def test_no_spin_that_nutates_in_a_time_is_missing(seed):
    one = Drawn(seed)
    if one.top.Mgl == 0:
        return
    still = find_period(one.top, one.theta, 0.0)
    period = still * one.rng.uniform(0.05, 1.2)
    if abs(period / still - 1) < 2.0**-10:
        return  # two spins may be nearer to each other than those of the count
    starts = find(one.top, theta=one.theta, nutation_period=period)
    assert len({abs(each.psi_dot) for each in starts}) == count_spins(one.top, one.theta, period)


def find_constants(top, state):
    return {
        "energy": float(top.energy(state)),
        "p_phi": float(top.vertical_momentum(state)),
        "p_psi": float(top.axial_momentum(state)),
    }


def check_constants(top, start, known, is_only):
    """A start has the constants up to rounding of it and of them."""
    state = start.state
    found = find_constants(top, state)
    across = top.Ix * (abs(start.phi_dot * math.sin(start.theta)) + abs(start.theta_dot))
    momenta = abs(known["p_phi"]) + abs(known["p_psi"]) + across
    # What precesses regularly is a start at the bottom, up to 64 EPS of the terms away.
    digits = 72 if is_only and start.theta_dot == 0 else 8
    along = top.Iz * (abs(start.phi_dot) + abs(start.psi_dot))
    swing = top.Ix * (start.phi_dot**2 + start.theta_dot**2) + top.Iz * start.psi_dot**2
    energies = swing + abs(top.Mgl) + abs(known["energy"])
    assert abs(found["energy"] - known["energy"]) <= digits * EPS * energies
    assert abs(found["p_phi"] - known["p_phi"]) <= 8 * EPS * (momenta + along)
    assert abs(found["p_psi"] - known["p_psi"]) <= 8 * EPS * (momenta + along)


@pytest.mark.parametrize("seed", seeds(1, MANY // FEW))
def test_the_constants_of_a_regular_precession_give_one_start(seed):
    for k in range(FEW):
        one = Drawn(seed * FEW + k)
        for seen in find(one.top, theta=one.theta, precession_period=one.period()):
            (start,) = solve_start(one.top, **find_constants(one.top, seen.state))
            assert start.theta_dot == 0.0 or start.theta in (0.0, PI)


def draw_state(one):
    rates = [one.rng.choice([0.0, one.rate()]) for _ in range(2)]
    return State.from_euler(
        theta=one.theta, theta_dot=rates[0], phi_dot=rates[1], psi_dot=one.spin()
    )


@pytest.mark.parametrize("seed", seeds(1, MANY // FEW))
def test_constants_lead_to_the_turning_angles_of_their_motion(seed):
    for k in range(FEW):
        one = Drawn(seed * FEW + k)
        state = draw_state(one)
        known = find_constants(one.top, state)
        starts = solve_start(one.top, **known)
        for start in starts:
            check_constants(one.top, start, known, len(starts) == 1)
        low, high = Motion(one.top, state).turning_angles
        # The place of a bottom is known to the root of the rounding of its energy. Numbers next to
        # the vertical are those of p_phi - p_psi, which is no more than rounding.
        near = 2e-7 / max(min(math.sin(low), math.sin(high)), 1e-2)
        assert starts[0].theta == pytest.approx(low, abs=near)
        assert starts[-1].theta == pytest.approx(high, abs=near)


@pytest.mark.parametrize("seed", seeds(1, MANY // FEW))
def test_goldsteins_constants_lead_to_the_same_starts(seed):
    for k in range(FEW):
        one = Drawn(seed * FEW + k)
        Ix, Iz = (mpf(each) for each in one.top.moments[:2])
        alpha, a, b = one.rate() ** 2, one.rate(), one.rate()
        energy = float((Ix * mpf(alpha) + (Ix * mpf(a)) ** 2 / Iz) / 2)
        known = {"energy": energy, "p_phi": float(Ix * b), "p_psi": float(Ix * a)}
        starts = find(one.top, alpha=alpha, a=a, b=b)
        for start in starts:
            check_constants(one.top, start, known, len(starts) == 1)


@pytest.mark.parametrize("seed", seeds(1, MANY // FEW))
def test_less_than_the_least_energy_is_refused_and_the_least_is_not(seed):
    for k in range(FEW):
        one = Drawn(seed * FEW + k)
        known = find_constants(one.top, draw_state(one)) | {"energy": -1e30}
        with pytest.raises(RefusedError, match="energy must be at least") as refused:
            solve_start(one.top, **known)
        least = float(str(refused.value).split("at least ")[1].split(" J")[0])
        starts = solve_start(one.top, **known | {"energy": least})
        for start in starts:
            check_constants(one.top, start, known | {"energy": least}, len(starts) == 1)
        below = least - 1e-9 * (abs(least) + abs(one.top.Mgl))
        assert not find(one.top, **known | {"energy": below})


def test_each_question_is_refused_in_words_that_say_what_would_do():
    refusals = {
        "theta must be > 0 and < 3.141592653589793 rad, got 0": {"theta": 0.0, "psi_dot": 9.0},
        "dip must be > 0 rad, got 0": {"theta": 1.0, "dip": 0.0},
        "dip must be > 0 and at most 2.141592653589793 rad with theta = 1 rad, got 3": {
            "theta": 1.0,
            "dip": 3.0,
        },
        "psi_dot must be at least 111.6288238370232 rad/s in size with theta = 0.5 rad, got 9": {
            "theta": 0.5,
            "psi_dot": 9.0,
        },
        "psi_dot must be > 57.07923014321494 and < 132.12594695903826 rad/s in size with "
        "precession_period = 0.5 s, got 200": {"psi_dot": 200.0, "precession_period": 0.5},
        "psi_dot must be at most 1e+100 rad/s in size, got 1e+200": {
            "theta": 1.0,
            "psi_dot": 1e200,
        },
    }
    for sentence, known in refusals.items():
        with pytest.raises(RefusedError) as refused:
            solve_start(ARTICLE, **known)
        assert str(refused.value) == sentence


def read_limit(one, known, name):
    """The limit that a refusal states, "at least" or "at most", and its sentence."""
    with pytest.raises(RefusedError, match=f"^{name} must be ") as refused:
        solve_start(one.top, **known)
    sentence = str(refused.value)
    return float(sentence.replace("at most", "at least").split("at least ")[1].split()[0])


@pytest.mark.parametrize("seed", seeds(2, MANY // FEW))
def test_a_limit_that_a_refusal_states_is_not_refused_and_what_lies_beyond_it_is(seed):
    rng = Numbers(f"limits {seed}")
    for k in range(FEW):
        one = Drawn(seed * FEW + k)
        theta = rng.uniform(0.01, 3.13)
        asked = {"dip": 3.1415, "nutation_period": 1e30}
        difference = (one.top.Ix - one.top.Iz) * math.cos(theta) * one.top.Mgl
        if difference > 0:
            asked["psi_dot"] = 0.0
        for name, value in asked.items():
            if name != "psi_dot" and one.top.Mgl == 0:
                continue
            limit = read_limit(one, {"theta": theta, name: value}, name)
            assert find(one.top, theta=theta, **{name: limit}), (name, limit)
            beyond = limit * (1 + (-1e-13 if name == "psi_dot" else 1e-13))
            assert not find(one.top, theta=theta, **{name: beyond}), (name, beyond)


@pytest.mark.parametrize("seed", seeds(1, MANY // FEW))
def test_a_spin_has_a_turn_of_that_time_exactly_between_the_limits_of_the_refusal(seed):
    for k in range(FEW):
        one = Drawn(seed * FEW + k)
        if one.top.Ix == one.top.Iz:
            continue
        period = one.period()
        with pytest.raises(
            RefusedError, match=r"^psi_dot must be .* rad/s in size with"
        ) as refused:
            solve_start(one.top, psi_dot=1e99, precession_period=period)
        limits = [float(each) for each in re.findall(r"[<>] (\S+)", str(refused.value))]
        least, most = limits if len(limits) == 2 else (0.0, limits[0])
        # A limit is the nearest double: the next one is on its side.
        inside = np.nextafter(least, math.inf), (least + most) / 2, np.nextafter(most, 0.0)
        if np.nextafter(inside[0], math.inf) < inside[2]:
            for spin in (*inside, -inside[0], -inside[2]):
                assert find(one.top, psi_dot=float(spin), precession_period=period)
        beyond = np.nextafter(most, math.inf), np.nextafter(least, 0.0) or -2 * most
        for spin in (*beyond, -beyond[0], -beyond[1]):
            assert not find(one.top, psi_dot=float(spin), precession_period=period)


def test_where_every_rate_is_regular_the_spin_is_refused_and_not_the_precession():
    for top, theta in ((Top(1.0, 1.0, 0.0), 0.5), (Top(1.0, 0.5, 0.0), PI / 2)):
        with pytest.raises(RefusedError, match="psi_dot must be other than 0 rad/s: without "):
            solve_start(top, theta=theta, psi_dot=0.0)
        (start,) = solve_start(top, theta=theta, psi_dot=3.0)
        assert start.phi_dot == 0.0
    with pytest.raises(RefusedError, match="such that the top can precess regularly"):
        solve_start(Top(1.0, 1.0, 1.0), theta=0.5, psi_dot=0.0)


def test_tops_without_weight_and_spheres_are_refused_where_they_decide():
    with pytest.raises(RefusedError, match="Mgl must be other than 0 J"):
        solve_start(Top(1.0, 1.0, 0.0), theta=1.0, dip=0.5)
    with pytest.raises(RefusedError, match="Ix must be other than Iz"):
        solve_start(Top(1.0, 1.0, 1.0), psi_dot=1.0, precession_period=0.5)


def test_names_of_no_question_are_refused_with_all_questions():
    for known in ({}, {"theta": 1.0}, {"dip": 1.0, "psi_dot": 1.0}, {"tilt": 1.0}):
        with pytest.raises(RefusedError, match="known must be one of theta, precession_period / "):
            solve_start(ARTICLE, **known)
    assert len(ROWS) == 7


def draw_question(one):
    """Return what is known of a start, of any question, and by how much each may be off."""
    names = one.rng.choice([*ROWS.values()])
    values = {
        "theta": one.theta,
        "precession_period": one.period(),
        "psi_dot": one.spin(),
        "dip": draw_dip(one)[0],
        "nutation_period": one.period(),
        "alpha": one.rate() ** 2,
        "a": one.rate(),
        "b": one.rate(),
    } | find_constants(one.top, draw_state(one))
    known = {name: values[name] for name in names}
    share = one.rng.power(-5, -1.5)
    return known, {
        name: abs(value) * share for name, value in known.items() if one.rng.random() < 0.8
    }


def find_all_over(top, known, half_widths, points):
    """Solutions on a grid of what is known."""
    shares = np.arange(points) * 2 / (points - 1) - 1
    axes = [
        [value + share * half_widths[name] for share in shares] if name in half_widths else [value]
        for name, value in known.items()
    ]
    for numbers in itertools.product(*axes):
        yield find(top, **dict(zip(known, numbers, strict=True)))


@pytest.mark.parametrize("seed", seeds(1, 40))
def test_a_spread_is_that_of_all_starts_of_what_may_be_known(seed):
    for k in range(25):
        one = Drawn(10_000 + seed * 25 + k)
        known, half_widths = draw_question(one)
        starts = find(one.top, **known)
        if not starts:
            continue
        starts = solve_start(one.top, half_widths=half_widths, **known)
        if starts[0].least is None:
            continue
        points = 17 if len(known) == 2 else 9
        others = [*find_all_over(one.top, known, half_widths, points)]
        # Of an extreme between two of its points a grid misses the square of half a step, of a
        # spread that is at least the square of 1.
        miss = 1 / (points - 1) ** 2
        assert {len(each) for each in others} == {len(starts)}
        for start, same in zip(starts, zip(*others, strict=True), strict=True):
            for name in ("theta", "theta_dot", "phi_dot", "psi_dot"):
                numbers = [getattr(each, name) for each in same]
                least, most = getattr(start.least, name), getattr(start.most, name)
                assert least <= getattr(start, name) <= most
                rounding = 64 * EPS * max(abs(least), abs(most))
                slack = (most - least) * miss + rounding
                assert abs(min(numbers) - least) <= slack, (one.top, known, half_widths, name)
                assert abs(max(numbers) - most) <= slack, (one.top, known, half_widths, name)


def test_a_spread_knows_the_extreme_between_its_ends():
    # psi' = (Ix - Iz) cos(theta) p/Iz + Mgl/(Iz p) is least at p^2 = Mgl/((Ix - Iz) cos(theta)).
    top = Top(2.0, 1.0, 1.0)
    theta, period = PI / 3, 2 * PI / math.sqrt(2.0)
    first, _ = solve_start(
        top,
        theta=theta,
        precession_period=period * 1.02,
        half_widths={"precession_period": period / 10},
    )
    assert first.least.psi_dot == pytest.approx(math.sqrt(2.0), rel=1e-12)
    assert first.most.psi_dot > first.psi_dot


def test_a_spread_is_unknown_where_a_start_ends_or_goes_through_infinity():
    for known, half_widths in (
        ({"theta": 0.5, "psi_dot": 112.0}, {"psi_dot": 1.0}),  # none below 111.6 rad/s
        ({"theta": PI / 2, "psi_dot": 200.0}, {"theta": 0.01}),  # the fast one, at the horizontal
    ):
        for start in solve_start(ARTICLE, half_widths=half_widths, **known):
            assert start.least is None
            assert start.most is None


def draw_turn(seed):
    """Return a top, what is known of a turn, half-widths, and cos(theta) as a parabola of 1/p."""
    rng = Numbers(f"turns {seed}")
    top = Top(1.0, rng.choice([0.5, 1.5]), rng.choice([-1.0, 1.0]))
    known = {"psi_dot": rng.uniform(2.0, 4.0), "precession_period": rng.uniform(3.0, 9.0)}
    width = {"precession_period": known["precession_period"] * rng.uniform(0.01, 0.3)}
    return top, known, width


def find_cosines(top, spin, period, sign):
    """cos(theta) of a turn: the ends of an interval of periods, and the vertex between them."""
    low, high = period

    def cosine_of(x):  # of x = 1/p
        return (top.Iz * spin * x - top.Mgl * x * x) / (top.Ix - top.Iz)

    ends = [mpf(sign) * each / (2 * mp.pi) for each in (low, high)]
    vertex = top.Iz * mpf(spin) / (2 * mpf(top.Mgl))
    between = [vertex] if min(ends) < vertex < max(ends) else []
    return [cosine_of(x) for x in (*ends, *between)]


@pytest.mark.parametrize("seed", seeds(1, 20))
def test_a_spread_is_silent_if_starts_end_between_the_points_of_its_grid(seed):
    told = silent = 0
    for number in range(300):
        top, known, width = draw_turn(300 * seed + number)
        starts = find(top, **known)
        if not starts:
            continue
        (off,) = width.values()
        period = known["precession_period"] - off, known["precession_period"] + off
        with mp.workdps(40):
            sides = [find_cosines(top, known["psi_dot"], period, sign) for sign in (1, -1)]
            # each direction has a start at all periods of the interval, or at none
            exists = [[abs(each) < 1 for each in side] for side in sides]
            signs = [{mp.sign(each) for each in side} for side in sides]
        is_steady = all(
            all(side) or (not any(side) and len(sign) == 1)
            for side, sign in zip(exists, signs, strict=True)
        )
        for start in solve_start(top, half_widths=width, **known):
            assert (start.least is not None) == is_steady, (top, known, width)
            told += is_steady
            silent += not is_steady
    assert min(told, silent) > 4


def test_a_parabola_that_leaves_the_tilts_between_two_points_is_seen():
    # cos(theta) is 1.0012 at its vertex: 16 % of the periods have no motion.
    known = {"psi_dot": 2.83, "precession_period": 4.6}
    for start in solve_start(Top(1.0, 0.5, 1.0), half_widths={"precession_period": 0.9}, **known):
        assert start.least is None


@pytest.mark.parametrize(
    ("top", "theta", "spin"),
    [
        (Top(1.0, 0.5, 1.0), 5e-324, math.sqrt(4.0 * (math.pi**2 + 1.0)) * 2.0),
        (Top(1.0, 0.5, 1e-100), 0.5, 4.0 * math.pi),
        (Top(1.0, 0.5, 1e-300), 3.14, 4.0 * math.pi),
    ],
)
def test_a_nutation_period_has_its_spin_at_any_tilt_and_weight(top, theta, spin):
    # Upright the nutation is sqrt(p_psi^2 - 4 Ix Mgl)/Ix; without weight p_psi/Ix.
    for start, sign in zip(
        solve_start(top, theta=theta, nutation_period=1.0), (1, -1), strict=True
    ):
        assert start.psi_dot == pytest.approx(sign * spin, rel=8 * EPS)


def test_half_widths_are_refused_by_name():
    for half_widths, refusal in (
        ({"dip": -1.0}, r"half_widths\[dip\] must be >= 0 rad, got -1"),
        ({"dip": math.inf}, r"half_widths\[dip\] must be "),
        ({"tilt": 1.0}, "half_widths must be one of theta, dip, got 'tilt'"),
    ):
        with pytest.raises(ValueError, match=refusal):
            solve_start(ARTICLE, theta=0.5, dip=0.1, half_widths=half_widths)


def test_a_pendulum_is_let_go_without_spin():
    (start,) = solve_start(ARTICLE, theta=0.5, dip=PI - 0.5)
    assert (start.theta, start.psi_dot) == (0.5, 0.0)
    longest = find_period(ARTICLE, PI / 2, 0.0)
    for start in solve_start(ARTICLE, theta=PI / 2, nutation_period=longest):
        assert abs(start.psi_dot) < 1e-5


@pytest.mark.parametrize(
    "known", [{"theta": 2.0, "dip": 1e-9}, {"theta": 1.0, "precession_period": 1.0}]
)
def test_starts_with_rates_that_no_motion_may_have_are_refused_for_their_rates(known):
    thin = Top(0.5, 1e-100, -20.0)  # the spin is a momentum of ordinary size, divided by Iz
    with pytest.raises(ValueError, match=r"no rate exceeds 1e\+100 rad/s with theta"):
        solve_start(thin, **known)
