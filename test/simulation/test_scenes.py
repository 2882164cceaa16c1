"""Each scene shows what its file says one should look at."""

import math

import numpy as np
import pytest
from physics.tops import EPS

from symtop_ros.physics import Body
from symtop_ros.physics.dynamics import STANDARD_GRAVITY
from symtop_ros.simulation.changes.requests import start_motion
from symtop_ros.simulation.presets import scene_names
from symtop_ros.simulation.settings import Settings

KINDS = {  # scenes by the kind of their motion
    "regular": "regular_precession fast_precession hurry_slow hurry_fast perry_fails "
    "conical_pendulum toy_gyroscope bicycle_wheel",
    "cusps": "cusps sleeping_unstable closed_cusps gray_fall",
    "looping": "looping backward_start",
    "unidirectional": "unidirectional hanging disc free spin_reversal spherical_pendulum",
    "sleeping": "sleeping",
    "through the pole": "through_the_pole",
    "asymptotic": "separatrix",
    "driven": "friction sleeping_wakes vertical_torque",
}


def motion_of(scene):
    return start_motion(Settings.from_scene(scene))


def test_every_scene_starts_the_motion_that_its_name_promises():
    motions = {name: motion_of(name) for name in scene_names()}
    found = {name: "driven" if each.is_driven else each.kind for name, each in motions.items()}
    assert found == {name: kind for kind, names in KINDS.items() for name in names.split()}


def test_what_a_class_has_at_hand_is_computed_from_its_mass_and_size():
    gyroscope, wheel = (motion_of(name) for name in ("toy_gyroscope", "bicycle_wheel"))
    disc = Body.disc(mass=0.06, radius=0.026, distance=0.035).top
    rim = 1.5 * 0.3**2  # its moment about the axle; a diameter has half of it
    ring = Body(mass=1.5, arm=0.15, Ix=rim / 2, Iz=rim, gravity=STANDARD_GRAVITY).top
    assert gyroscope.top.moments == pytest.approx(disc.moments, rel=8 * EPS)
    assert wheel.top.moments == pytest.approx(ring.moments, rel=8 * EPS)
    # seconds for a turn, and the radius of the disc that moves as the wheel does
    turns = [2 * math.pi / each.mean_precession_rate for each in (gyroscope, wheel)]
    assert turns == pytest.approx([1.8, 9.6], abs=0.05)
    assert 0.3 * math.sqrt(2) == pytest.approx(0.42, abs=0.005)


def test_a_sleeping_top_wakes_at_the_critical_spin():
    motion = motion_of("sleeping_wakes")
    states = motion.at(np.linspace(0.0, 12.0, 6001))
    tilts, spins = states.euler_angles.theta, states.angular_velocity[:, 2]
    critical = motion.top.critical_spin
    begin = int(np.argmax(spins < critical))
    # Towards the critical spin the restoring torque vanishes, and a nutation of constant action
    # grows with its fourth root: from 1.4e-3 to 2.7e-3 here.
    assert tilts[:begin].max() < 3e-3
    woken = spins[np.argmax(tilts > 0.01)]
    assert woken / critical == pytest.approx(0.97, abs=0.01)  # the growth itself takes 0.5 s
    assert tilts.max() > 0.5


def test_the_spin_rate_changes_its_sign_while_the_axial_momentum_is_constant():
    motion = motion_of("spin_reversal")
    states = motion.at(np.linspace(0.0, motion.nutation_period, 400))
    spins = states.euler_rates.psi
    assert spins.min() < -80.0 < 50.0 < spins.max()
    assert np.ptp(motion.top.axial_momentum(states)) == 0.0


def test_the_precession_starts_backwards_and_advances_on_average():
    motion = motion_of("backward_start")
    assert motion.start.euler_rates.phi == pytest.approx(-3.0, rel=8 * EPS)
    assert motion.mean_precession_rate > 6.0


def test_the_trace_with_six_cusps_closes():
    motion = motion_of("closed_cusps")
    turn = motion.mean_precession_rate * motion.nutation_period
    assert turn == pytest.approx(2 * math.pi / 6, rel=8 * EPS)
    axis = motion.at(6 * motion.nutation_period).to_world([0.0, 0.0, 1.0])
    begin = motion.start.to_world([0.0, 0.0, 1.0])
    # the spin rate is a double: its rounding moves the end by some eps of a turn
    assert np.abs(axis - begin).max() <= 64 * EPS


def test_the_conical_pendulum_keeps_its_angle_and_does_not_spin():
    motion = motion_of("conical_pendulum")
    low, high = motion.turning_angles
    assert high - low <= 1e-7  # the square root of the rounding of the start
    assert motion.kind == "regular"
    assert motion.start.euler_rates.phi**2 == pytest.approx(9.81 / math.cos(0.5), rel=16 * EPS)
    assert abs(motion.start.angular_velocity[2]) <= 2 * EPS


def test_the_ellipse_of_the_spherical_pendulum_turns():
    motion = motion_of("spherical_pendulum")
    assert 0.1 < motion.turning_angles[0] < motion.turning_angles[1] == pytest.approx(0.5)
    turned = motion.mean_precession_rate * motion.nutation_period / math.pi - 1.0
    assert 0.0 < turned < 0.1  # of half a turn in each half ellipse


def test_the_start_of_the_separatrix_is_exact():
    motion = motion_of("separatrix")
    assert (motion.kind, motion.nutation_period) == ("asymptotic", math.inf)
    assert motion.top.energy(motion.start) == motion.top.Mgl
    assert motion.start.vertical.tolist() == [0.0, 1.0, 0.0]
    # the textbook's tan(theta/4) = tan(pi/8) exp(-t sqrt(Mgl/Ix))
    exact = 4 * math.atan(math.tan(math.pi / 8) * math.exp(-20.0 * math.sqrt(0.5)))
    assert motion.at(20.0).euler_angles.theta == pytest.approx(exact, rel=16 * EPS)


def test_the_spin_rate_falls_and_rises_in_one_fall():
    motion = motion_of("gray_fall")
    states = motion.at(np.linspace(0.0, motion.nutation_period / 2, 1001))
    tilts, spins = states.euler_angles.theta, states.euler_rates.psi
    assert (np.diff(tilts) > 0).all()
    begin = spins[0]
    lowest = int(spins.argmin())
    horizontal = int(np.argmax(tilts > math.pi / 2))
    assert 0 < lowest < horizontal
    assert spins[lowest] < 0.95 * begin
    assert spins[horizontal] == pytest.approx(begin, rel=2e-3)  # a sample of 1000
    assert spins[-1] > 1.4 * begin
