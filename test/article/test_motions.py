import numpy as np

from symtop_ros.physics import State, theta_torque
from workshop.article import motions


def test_a_slope_is_as_good_as_it_says():
    times = np.linspace(0.0, 1.0, 50)
    found = motions.slope(lambda t: np.sin(100 * t), times)
    assert np.abs(found.values - 100 * np.cos(100 * times)).max() <= 2 * found.error < 1e-8


def test_the_seven_motions_are_of_the_kinds_that_the_article_describes():
    kinds = [motion.kind for motion in motions.seven_motions()]
    of_rates = ["regular" if r.direction == "stays" else "unidirectional" for r in motions.RATES]
    assert kinds == [*of_rates, "cusps"]


def test_the_torque_across_the_axis_vanishes_at_both_roots():
    # of terms of 0.07 to 0.9 N m, the rounding of a few operations
    assert abs(theta_torque(motions.TOP, motions.THETA, motions.SLOW, 200.0)) < 1e-16
    assert abs(theta_torque(motions.TOP, motions.THETA, motions.FAST, 200.0)) < 1e-15


def test_a_turn_of_the_precession_comes_back_to_the_same_phi():
    (*_, motion) = motions.seven_motions()
    turn = motion.nutation_period * motion.mean_precession_rate
    after = motion.at(motion.nutation_period).euler_angles.phi - motion.start.euler_angles.phi
    assert abs(after - turn) < 1e-13  # half a radian to rounding
    assert motions.precession_period(motion) * motion.mean_precession_rate == 2 * np.pi


def test_a_sleeping_top_shows_the_pole_of_the_articles_equations():
    state = State.from_euler(theta=0.0, theta_dot=1.0, psi_dot=200.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        assert not np.isfinite(motions.accelerations(motions.TOP, state)).all()
