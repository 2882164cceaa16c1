"""The decimal context of the caller changes nothing."""

import decimal

import numpy as np
import pytest
from physics.tops import ARTICLE

from symtop_ros.physics import (
    EffectivePotential,
    Friction,
    Motion,
    State,
    Top,
    perrys_rule,
    regular_precession_rates,
)

TRAPS = [decimal.Inexact, decimal.Rounded, decimal.Subnormal, decimal.Clamped]
TRAPS += [decimal.InvalidOperation]
CONTEXTS = {
    "few digits": decimal.Context(prec=6),
    "one digit, rounded up": decimal.Context(prec=1, rounding=decimal.ROUND_UP),
    "every trap": decimal.Context(prec=6, traps=TRAPS),
    "narrow exponents": decimal.Context(prec=28, Emin=-3, Emax=3),
}
NO_FRICTION = Friction()
MOTIONS = {
    "friction": (ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0), Friction(1e-6, 1e-6)),
    "cusps": (ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0)),
    "unstable sleeper": (ARTICLE, State.from_euler(theta=1e-3, psi_dot=100.0)),
    "through the pole": (ARTICLE, State.from_euler(theta=0.0, theta_dot=1.0, psi_dot=60.0)),
    "turned over": (Top(2e-4, 3e-4, -0.05), State.from_euler(theta=2.0, phi_dot=3.0, psi_dot=-4.0)),
    "free": (Top(2e-4, 1e-4, 0.0), State.from_euler(theta=1.0, phi_dot=3.0, psi_dot=40.0)),
    "asymptotic": (Top(1.0, 1.0, 1.0), State((0, 1, 0, 0), (2, 0, 0))),
}


def describe(top, start, friction=NO_FRICTION):
    """Everything that the library says of a motion, in full digits."""
    motion = Motion(top, start, friction)
    times = np.array([-3.0, 0.0, 1e-3, 0.1, 10.0, *([] if friction else [1e6])])
    many, one = motion.at(times), motion.at(7.0)
    return repr(
        (
            *(many.orientation.tolist(), many.angular_velocity.tolist()),
            *(one.orientation.tolist(), one.angular_velocity.tolist()),
            *(motion.kind, motion.turning_angles, motion.nutation_period, motion.spin_reverses),
            *(motion.mean_precession_rate, motion.mean_spin_rate, motion.precession_per_nutation),
            regular_precession_rates(top, theta=0.5, psi_dot=200.0),
            perrys_rule(top, start),
            EffectivePotential.of(top, start),
        )
    )


@pytest.mark.parametrize("context", CONTEXTS)
@pytest.mark.parametrize("name", MOTIONS)
def test_the_context_of_the_caller_changes_no_bit(name, context):
    expected = describe(*MOTIONS[name])
    with decimal.localcontext(CONTEXTS[context]) as hostile:
        assert describe(*MOTIONS[name]) == expected
        assert decimal.getcontext() is hostile


@pytest.mark.parametrize("Iz", [1e-12, 1e-20, 1e-28])
def test_a_rod_of_any_slenderness_moves_as_the_limit_of_slender_rods(Iz):
    # With p_psi = Iz omega_z = 2 held, theta does not depend on Iz: the spin angle alone does.
    start = State.from_euler(theta=0.5, phi_dot=0.3, psi_dot=2 / Iz)
    motion = Motion(Top(1.0, Iz, 1.0), start)
    limit = Motion(Top(1.0, 1e-9, 1.0), State.from_euler(theta=0.5, phi_dot=0.3, psi_dot=2e9))
    # omega_z, and with it p_psi, differ by phi' cos(theta) = 0.26 rad/s and by a rounding
    tolerance = 1e-9
    assert motion.nutation_period == pytest.approx(limit.nutation_period, rel=tolerance)
    assert motion.turning_angles == pytest.approx(limit.turning_angles, rel=tolerance)
    times = np.array([0.1, 1.0, 7.0]) * min(1.0, 1e14 * Iz)  # within 1e15 turns
    assert motion.at(times).euler_angles.theta == pytest.approx(
        limit.at(times).euler_angles.theta, rel=10 * tolerance
    )
