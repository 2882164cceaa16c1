"""The seven kinds of motion, for either sign of Mgl."""

import math

import pytest

from symtop_ros.physics import State, Top, motion, perry, regular_precession_rates

ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
KINDS = {
    "cusps": {"theta": 0.5, "psi_dot": 200.0},
    "looping": {"theta": 0.5, "psi_dot": 200.0, "phi_dot": -8.0},
    "unidirectional": {"theta": 0.5, "psi_dot": 200.0, "phi_dot": 9.0},
    "sleeping": {"theta": 0.0, "psi_dot": 200.0},
    "through the pole": {"theta": 1.0, "theta_dot": -20.0},
    "regular": {
        "theta": 0.5,
        "psi_dot": 200.0,
        "phi_dot": regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)[0],
    },
}


@pytest.mark.parametrize(("kind", "start"), KINDS.items())
def test_a_kind_is_named(kind, start):
    assert motion(ARTICLE, State.from_euler(**start)).kind == kind


@pytest.mark.parametrize(("kind", "start"), KINDS.items())
def test_a_kind_is_the_same_upside_down(kind, start):
    Ix, Iz, Mgl = ARTICLE.moments
    w, x, y, z = State.from_euler(**start).orientation
    over = State((-x, w, -z, y), State.from_euler(**start).angular_velocity)
    path = motion(Top(Ix, Iz, -Mgl), over)
    assert path.kind == kind
    low, high = motion(ARTICLE, State.from_euler(**start)).turning_angles
    assert path.turning_angles == pytest.approx((math.pi - high, math.pi - low), abs=1e-15)


def test_a_motion_to_the_vertical_is_spiralling_with_and_without_spin():
    # p_phi = p_psi and as much energy as at rest upright: W = 0 cannot be, so with theta' inwards
    Ix, Iz, Mgl = 1.0, 0.5, 1.0
    spin = 2.0  # p_psi = 1 < 2 sqrt(Ix Mgl) = 2: upright is unstable
    theta = 1.2
    p_psi = Iz * spin
    phi_dot = p_psi / (Ix * (1 + math.cos(theta)))
    square = 2 * Mgl / Ix * (1 - math.cos(theta)) - (phi_dot * math.sin(theta)) ** 2
    psi_dot = spin - phi_dot * math.cos(theta)
    start = State.from_euler(
        theta=theta, phi_dot=phi_dot, psi_dot=psi_dot, theta_dot=-math.sqrt(square)
    )
    path = motion(Top(Ix, Iz, Mgl), start)
    assert path.kind == "spiralling"
    assert path.at(12.0).euler_angles.theta < 1e-3


def test_an_exactly_vertical_axis_at_rest_stays_whatever_its_spin():
    for spin in (0.0, 50.0, 500.0):
        path = motion(ARTICLE, State.from_euler(theta=0.0, psi_dot=spin))
        assert path.kind == "sleeping"
        assert path.engine == "elementary"
        assert path.at(1e6).euler_angles.theta == 0.0


def test_sleeping_is_stable_from_the_critical_spin_on():
    spin = ARTICLE.critical_spin
    assert spin == pytest.approx(137.675, abs=1e-3)
    for factor, far in ((1.05, False), (0.95, True)):
        start = State((1.0, 0.0, 0.0, 0.0), (1e-3, 0.0, spin * factor))
        assert (motion(ARTICLE, start).turning_angles[1] > 0.1) is far


@pytest.mark.parametrize(
    ("Mgl", "upright", "factor", "stable"),
    [
        (0.068, True, 1.0 + 1e-12, True),
        (0.068, True, 1.0 - 1e-12, False),
        (0.068, False, 0.0, True),
        (-0.068, False, 0.9, False),
        (-0.068, False, 1.1, True),
        (0.0, True, 0.0, True),
    ],
)
def test_stability_of_sleeping_is_told_for_either_pole(Mgl, upright, factor, stable):
    top = Top(0.000228, 0.0000572, Mgl)
    q = (1.0, 0.0, 0.0, 0.0) if upright else (0.0, 1.0, 0.0, 0.0)
    state = State(q, (0.0, 0.0, factor * ARTICLE.critical_spin))
    assert top.sleeping_is_stable(state) is stable
    expected = f"where it is {'stable' if stable else 'unstable'}"
    assert expected in perry(top, state).reason


def test_without_gravity_the_axis_goes_round_the_angular_momentum():
    top = Top(0.000228, 0.0000572, 0.0)
    start = State.from_euler(theta=0.5, phi_dot=30.0, psi_dot=60.0)
    path = motion(top, start)
    assert path.engine == "elementary"
    low, high = path.turning_angles
    theta = [path.at(path.nutation_period * k / 200).euler_angles.theta for k in range(201)]
    assert min(theta) == pytest.approx(low, abs=1e-4 * (high - low) + 1e-9)
    assert max(theta) == pytest.approx(high, abs=1e-3 * (high - low))
    assert path.at(path.nutation_period * 1e6).euler_angles.theta == pytest.approx(0.5, abs=1e-8)
