"""Accelerations of a body and of its points, the force of the pivot, and the body of a top."""

import math

import numpy as np
import pytest
from drawn import Numbers, normalize
from mpmath import mp, mpf
from physics.tops import ARTICLE, CUSPS, DISC, EPS, Case, follow_exactly, random_states, turn
from trials import seeds

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import BODIES, Body, Friction, Motion, Part, State, Top
from symtop_ros.physics.dynamics import DEFAULT_GRAVITY, point_acceleration
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.precession import theta_acceleration, theta_torque
from workshop.digits import ClosedForm
from workshop.testset.exact import DIGITS

# Weights of the second derivative by central differences, order 8 (Fornberg 1988, table 1).
WEIGHTS = ((-205, 72), (8, 5), (-1, 5), (8, 315), (-1, 560))
STEP = 1e-4  # rad of the fastest rate: the error of the differences is below 1e-30 of the rates


def differentiate(orientation_at, position, h):
    """Second derivative of the world position of a point; h is a power of two, so k h is exact."""
    with mp.workdps(50):
        total = [mpf(0)] * 3
        for k, (above, below) in enumerate(WEIGHTS):
            weight = mpf(above) / below
            for sign in (1, -1) if k else (1,):
                place = turn(orientation_at(sign * k * h), [mpf(p) for p in position])
                total = [a + weight * b for a, b in zip(total, place, strict=True)]
        return [float(each / mpf(h) ** 2) for each in total]


def find_error(motion, position):
    """Error of the acceleration in eps of the size of its terms."""
    state = motion.start
    rate = float(np.abs(state.angular_velocity).max()) + math.sqrt(
        (abs(motion.top.Mgl) + sum(map(abs, motion.applied_torque))) / motion.top.Iz
    )
    h = 2.0 ** round(math.log2(STEP / rate))
    followed = follow_exactly(motion)
    exact = differentiate(lambda t: followed.at(t)[0], position, h)
    ours = state.to_world(point_acceleration(motion, state, position))
    return float(np.abs(ours - exact).max() / (rate**2 * np.linalg.norm(position)) / EPS)


def random_cases():
    random = Numbers(16)
    for _ in range(6):
        Ix = random.power(-4, 1)
        top = Top(Ix, Ix * random.uniform(0.05, 2), Ix * random.gauss() * random.power(0, 3))
        state = State(normalize(random.normals(4)), random.normals(3) * random.power(-1, 2))
        yield top, state, random.normals(3), random


# In eps of the squared rates: about ten products and sums are rounded on the way, by half an eps
# each, of which the signs differ.
ACCELERATION = 3


@pytest.mark.parametrize("driven", [False, True])
def test_the_acceleration_of_a_point_is_the_second_derivative_of_its_place(driven):
    for top, state, position, random in list(random_cases())[: 4 if driven else 6]:
        friction = Friction(*(random.uniforms(0, 3, 2) * top.Iz))
        drive = (friction, random.normals(3) * top.Ix * 10) if driven else ()
        assert find_error(Motion(top, state, *drive), position) < ACCELERATION


def test_the_force_of_the_pivot_is_newtons_second_law():
    # Along the way of the article's top, with the momentum of the centre of mass from its place.
    body = Body.from_top(ARTICLE)
    motion = Motion(ARTICLE, CUSPS)
    followed = ClosedForm(Case(ARTICLE, CUSPS, 0.0).inputs, DIGITS)
    for t in (0.0, 0.03, 0.08, 7.0):
        exact = differentiate(lambda h, t=t: followed.at(mpf(t) + h)[0], (0, 0, body.arm), 2.0**-21)
        force = body.pivot_force(motion, motion.at(t))
        expected = body.mass * (np.array(exact) + np.array((0, 0, body.gravity)))
        # The state is rounded, and so is the acceleration: three roundings of half an eps.
        assert np.abs(force - expected).max() < 2 * EPS * np.linalg.norm(expected)


@pytest.mark.parametrize("Mgl", [1e-100, -1e100, 0.0])
def test_the_body_of_a_top_is_its_body_at_all_sizes(Mgl):
    top = Top(1.0, 0.25, Mgl)
    assert Body.from_top(top).top.Ix == pytest.approx(1.0, rel=4 * EPS)  # half of it from a product
    motion = Motion(top, State.from_euler(theta=0.5, psi_dot=1.0))
    assert np.isfinite(Body.from_top(top).pivot_force(motion, motion.start)).all()


@pytest.mark.parametrize("sign", [1, -1])
def test_a_body_has_the_tops_constants_and_could_be_built(sign):
    random = Numbers(3)
    for _ in range(100):
        Ix = random.power(-6, 3)
        top = Top(Ix, Ix * random.uniform(1e-6, 1.999), sign * random.power(-6, 6))
        body = Body.from_top(top, gravity=random.uniform(1, 25))
        assert body.mass * body.gravity * body.arm == pytest.approx(top.Mgl, rel=4 * EPS)
        assert body.Ix + body.mass * body.arm**2 == pytest.approx(top.Ix, rel=4 * EPS)
        assert body.top.moments == pytest.approx(top.moments, rel=4 * EPS)
        assert 0 < body.Iz <= 2 * body.Ix
        assert math.copysign(1, body.arm) == sign


@pytest.mark.parametrize("make", [Top, lambda Ix, Iz, _: Body(1.0, 1.0, Ix, Iz, 9.81)])
def test_the_largest_axial_moment_that_a_refusal_states_is_accepted(make):
    rng = Numbers("largest moments")
    for _ in range(100):
        Ix = rng.power(-6, 3)
        with pytest.raises(ValueError, match=r"^Iz must be ") as refused:
            make(Ix, math.nextafter(2 * Ix, math.inf), 1.0)
        stated = float(str(refused.value).split("2 Ix = ")[1].split()[0])
        assert make(Ix, stated, 1.0).Iz == 2 * Ix


def test_a_weight_of_next_to_nothing_has_no_arm_of_kilometres():
    top = Top(Ix=1.0, Iz=0.5, Mgl=-1e-9)
    body = Body.from_top(top)
    assert body.arm == -10.0
    assert body.top.moments == pytest.approx(top.moments, rel=4 * EPS)


def test_a_top_without_weight_has_its_centre_in_the_pivot():
    body = Body.from_top(Top(Ix=1.0, Iz=2.0, Mgl=0.0))
    assert (body.mass, body.arm, body.Ix, body.Iz) == (1.0, 0.0, 1.0, 2.0)


def test_a_body_and_its_top_lead_to_each_other():
    body = Body(mass=15.0, arm=1.0, Ix=0.234375, Iz=0.46875, gravity=9.81)
    assert Body.from_pivot_moments(15.0, 1.0, body.top.Ix, body.top.Iz) == body


def test_a_disc_leads_back_to_itself():
    numbers = Numbers(56)
    for _ in range(200):
        mass, radius, distance = (numbers.uniform(2.0**-6, 4.0) for _ in range(3))
        top = Body.from_disc(mass, radius, distance).top
        # Ix - Iz/2 loses the digits of Iz/2: those of (radius/(2 distance))^2
        lost = 8 * EPS * (1 + (radius / distance) ** 2)
        back = find_disc(top.moments)
        assert back.tolist() == pytest.approx([mass, radius, distance], rel=lost)


def find_disc(moments):
    """Mass, radius and distance of the disc that moves as a top does, as the page asks for them."""
    found = np.empty(3)
    top = bindings.read_from(np.array(moments))
    bindings.demand(
        bindings.bind_functions().find_disc(top, DEFAULT_GRAVITY, bindings.write_to(found, 3))
    )
    return found


def test_no_disc_moves_as_a_top_without_weight_does_or_as_a_disc_in_its_pivot():
    for moments in ((1.0, 0.5, 0.0), (1.0, 2.0, 0.5), (0.25, 0.5, 0.0)):
        assert np.isnan(find_disc(moments)).all()


@pytest.mark.parametrize("top", [ARTICLE, DISC, Top(2.0, 2.0, 7.0)])
def test_theta_acceleration_is_the_articles(top):
    Ix, Iz, Mgl = top.moments
    states = random_states(500)
    theta = states.euler_angles.theta
    rates = states.euler_rates
    expected = (
        (Ix - Iz) * rates.phi_dot**2 * np.cos(theta) - Iz * rates.phi_dot * rates.psi_dot + Mgl
    )
    found = theta_acceleration(top, theta, rates.phi_dot, rates.psi_dot)
    terms = (abs(rates.phi_dot) + abs(rates.psi_dot)) ** 2 + abs(Mgl) / Ix
    off = found - np.sin(theta) / Ix * expected
    assert (np.abs(off) <= 16 * EPS * terms).all()  # sums of three products
    # without sin(theta)/Ix, which the product takes back to a few roundings
    torque = theta_torque(top, theta, rates.phi_dot, rates.psi_dot)
    assert found == pytest.approx(np.sin(theta) / Ix * torque, rel=4 * EPS)


SHARES = {"point": (0, 0), "rod": (12, 0), "hoop": (2, 1), "disc": (4, 2), "ball": (2.5, 2.5)}


def draw_parts(rng):
    """Return some parts; some of them are on the other side of the pivot."""
    parts = []
    for _ in range(rng.randint(1, 5)):
        kind = rng.choice([*SHARES])
        size = 0.0 if kind == "point" else rng.power(-3, 0)
        place = rng.uniform(-1, 1)
        parts.append(Part(kind, rng.power(-3, 1), place, size, spins=kind != "point"))
    return [*parts, Part("disc", rng.power(-3, 1), rng.uniform(-1, 1), rng.power(-3, 0))]


@pytest.mark.parametrize("seed", seeds(200, 5000))
def test_a_body_has_the_moments_of_its_parts_by_steiners_theorem(seed):
    parts = draw_parts(Numbers(f"parts {seed}"))
    body = Body.from_parts(parts, gravity=9.80)
    with mp.workdps(40):
        mass = sum(mpf(each.mass) for each in parts)
        levers = [mpf(each.mass) * mpf(each.distance) for each in parts]
        Ix = Iz = mpf(0)
        for each in parts:
            square = mpf(each.mass) * mpf(each.size) ** 2
            across, along = SHARES[each.kind]
            Ix += (square / across if across else 0) + mpf(each.mass) * mpf(each.distance) ** 2
            Iz += square / along if along else 0
    rounding = 2 * (len(parts) + 4) * EPS  # of sums of so many terms, each of some products
    # The moment about the pivot is a sum of squares, of which none is subtracted.
    assert body.top.Ix == pytest.approx(float(Ix), rel=rounding)
    assert body.top.Iz == pytest.approx(float(Iz), rel=rounding)
    assert body.mass == pytest.approx(float(mass), rel=rounding)
    reach = float(sum(map(abs, levers))) * 9.80
    assert abs(body.top.Mgl - float(sum(levers)) * 9.80) <= rounding * reach


def test_bodies_of_the_classroom_are_tops():
    for parts in BODIES.values():
        assert Body.from_parts(parts).top.Ix > 0
    disc, weight = BODIES["balanced_gyroscope"]
    assert (disc.spins, weight.spins) == (True, False)


@pytest.mark.parametrize("kind", ["hoop", "disc", "ball"])
def test_a_part_that_is_held_must_have_no_moment_about_the_axle(kind):
    with pytest.raises(RefusedError, match=f"spins must be true for a {kind}, which has a moment"):
        Part(kind, 1.0, -0.5, 0.1, spins=False)
    assert not Part("rod", 1.0, -0.5, 0.1, spins=False).spins


def test_a_body_of_known_mass_has_the_arm_and_the_force_of_that_mass():
    random = Numbers(98)
    for _ in range(200):
        gravity, arm = random.uniform(9.75, 9.85), random.uniform(-0.5, 0.5)
        mass, Ix = random.power(-3, 2), random.power(-6, 0)
        given = Body(mass, arm, Ix, Ix * random.uniform(0.01, 2), gravity)
        found = Body.from_top(given.top, gravity, mass)
        # Three roundings make Mgl, and two undo them.
        assert found.arm == pytest.approx(arm, rel=4 * EPS)
        # M r^2 is taken away from what it was added to: by some EPS of the sum.
        assert found.Ix == pytest.approx(Ix, rel=0, abs=8 * EPS * given.top.Ix)
        motion = Motion(given.top, State.from_euler(theta=0.5, psi_dot=20.0))
        mine, its = (each.pivot_force(motion, motion.start) for each in (found, given))
        assert np.abs(mine - its).max() <= 16 * EPS * np.abs(its).max()


def test_a_flat_disc_has_the_least_mass_of_its_top_and_a_lighter_body_is_refused():
    random = Numbers(99)
    for _ in range(500):
        mass, radius = random.power(-3, 2), random.power(-2, 0)
        disc = Body.from_disc(
            mass, radius, radius * random.power(-3, 2), random.uniform(9.75, 9.85)
        )
        top = disc.top
        assert Body.from_top(top, disc.gravity, mass).Ix == pytest.approx(
            disc.Ix, abs=32 * EPS * top.Ix
        )
        # Lighter by so much that M r^2 exceeds Ix - Iz/2 by more than the rounding of Ix.
        lighter = mass / (1 + 64 * EPS * top.Ix / (top.Ix - top.Iz / 2))
        with pytest.raises(RefusedError, match=r"mass must be at least .* kg for this top, Mgl\^2"):
            Body.from_top(top, disc.gravity, lighter)


def test_a_body_without_weight_about_its_pivot_may_have_any_mass():
    for mass in (2.0**-40, 1.0, 2.0**40):
        body = Body.from_top(Top(Ix=1.0, Iz=2.0, Mgl=0.0), mass=mass)
        assert (body.mass, body.arm, body.Ix) == (mass, 0.0, 1.0)
