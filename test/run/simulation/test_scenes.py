"""Each scene shows what its file says, and what is no file of a scene is refused quickly."""

import math
import os
import sys
from pathlib import Path

import numpy as np
import pytest
from odd_values import assert_one_sentence
from physics.rule.test_cause import demand
from physics.tops import EPS
from work import counting

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import (
    Body,
    Motion,
    State,
    apply_impulse,
    hurry,
    kick_verdict,
    perrys_rule,
    regular_precession_rates,
)
from symtop_ros.physics.dynamics import DEFAULT_GRAVITY
from symtop_ros.run.simulation import presets
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.presets import CONFIG, load_scene, scene_names
from symtop_ros.run.simulation.settings import Settings

KINDS = {  # scenes by the kind of their motion
    "regular": "regular_precession fast_precession hurry_slow hurry_fast perry_fails "
    "conical_pendulum toy_gyroscope bicycle_wheel",
    "cusps": "cusps second_cusp sleeping_unstable closed_cusps gray_fall",
    "looping": "looping backward_start",
    "unidirectional": "unidirectional hanging disc free spin_reversal spherical_pendulum "
    "below_slow_root below_fast_root above_fast_root",
    "sleeping": "sleeping",
    "through the pole": "through_the_pole",
    "asymptotic": "separatrix",
    "clamped": "perry_clamped",
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
    disc = Body.from_disc(mass=0.06, radius=0.026, distance=0.035).top
    rim = 1.5 * 0.3**2  # its moment about the axle; a diameter has half of it
    ring = Body(mass=1.5, arm=0.15, Ix=rim / 2, Iz=rim, gravity=DEFAULT_GRAVITY).top
    assert gyroscope.top.moments == pytest.approx(disc.moments, rel=8 * EPS)
    assert wheel.top.moments == pytest.approx(ring.moments, rel=8 * EPS)
    # seconds for a turn, and the radius of the disc that moves as the wheel does
    turns = [2 * math.pi / each.mean_precession_rate for each in (gyroscope, wheel)]
    assert turns == pytest.approx([1.8, 9.6], abs=0.05)
    assert 0.3 * math.sqrt(2) == pytest.approx(0.42, abs=0.005)


def test_a_sleeping_top_wakes_at_the_critical_spin():
    motion = motion_of("sleeping_wakes")
    states = motion.at(np.linspace(0.0, 12.0, 6001))
    tilts = states.euler_angles.theta
    spins = states.angular_velocity[:, 2]
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
    spins = states.euler_rates.psi_dot
    assert spins.min() < -80.0 < 50.0 < spins.max()
    assert np.ptp(motion.top.axial_momentum(states)) == 0.0


def test_the_precession_starts_backwards_and_advances_on_average():
    motion = motion_of("backward_start")
    assert motion.start.euler_rates.phi_dot == pytest.approx(-3.0, rel=8 * EPS)
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
    assert motion.start.euler_rates.phi_dot**2 == pytest.approx(9.81 / math.cos(0.5), rel=16 * EPS)
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
    tilts, spins = states.euler_angles.theta, states.euler_rates.psi_dot
    assert (np.diff(tilts) > 0).all()
    begin = spins[0]
    lowest = int(spins.argmin())
    horizontal = int(np.argmax(tilts > math.pi / 2))
    assert 0 < lowest < horizontal
    assert spins[lowest] < 0.95 * begin
    assert spins[horizontal] == pytest.approx(begin, rel=2e-3)  # a sample of 1000
    assert spins[-1] > 1.4 * begin


def swings_of(motion, times):
    """Turning angles (n, 2) that the motion would have from each time on under gravity alone."""
    return np.array([Motion(motion.top, motion.at(float(t))).turning_angles for t in times])


def test_friction_sinks_the_top_and_its_nutation_grows_before_it_shrinks():
    angles = swings_of(motion_of("friction"), np.arange(0.0, 24.0, 0.05))
    # means of three seconds, many nutations: at an instant they depend on the phase
    tilts = angles.mean(axis=1)
    swings = np.diff(angles)[:, 0]
    tilts, swings = (each.reshape(8, 60).mean(axis=1) for each in (tilts, swings))
    assert np.all(np.diff(tilts) > 0)
    largest = int(swings.argmax())
    assert 1.01 < swings[largest] / swings[0] < 1.1  # "a little"
    assert tilts[largest] == pytest.approx(0.8, abs=0.05)
    assert np.all(np.diff(swings[largest:]) < 0)


def test_a_torque_about_the_vertical_raises_the_top_and_does_not_hurry_it():
    motion = motion_of("vertical_torque")
    times = np.arange(0.0, 20.0, 1.0)
    angles = swings_of(motion, times).mean(axis=1)
    rates = [Motion(motion.top, motion.at(float(t))).mean_precession_rate for t in times]
    assert motion.applied_torque[:2] == (0.0, 0.0)
    assert motion.applied_torque[2] > 0
    assert (np.diff(angles) < 0).all()
    assert (np.diff(rates) < 0).all()


def test_a_sleeping_top_survives_an_impulse_and_a_slower_one_falls_and_comes_back():
    sleeping, slow = motion_of("sleeping"), motion_of("sleeping_unstable")
    assert sleeping.top.critical_spin == pytest.approx(137.7, abs=0.05)
    kicked = apply_impulse(sleeping.top, sleeping.start, (1e-5, 0.0, 0.0))
    assert Motion(sleeping.top, kicked).turning_angles[1] < 0.003
    assert slow.start.euler_angles.theta == pytest.approx(0.001, rel=1e-12)
    assert abs(slow.start.angular_velocity[2]) < slow.top.critical_spin
    assert slow.at(slow.nutation_period / 2).euler_angles.theta > 0.5
    assert slow.at(slow.nutation_period).euler_angles.theta == pytest.approx(0.001, rel=1e-6)


def test_the_hurried_scenes_rise_on_the_slow_root_and_fall_on_the_fast_one():
    for scene, direction in (("hurry_slow", "rises"), ("hurry_fast", "falls")):
        motion = motion_of(scene)
        kicked = hurry(motion.start, Settings.from_scene(scene).hurry_factor)
        verdict = kick_verdict(Motion(motion.top, kicked), motion.start, "spin_rate")
        low, high = Motion(motion.top, kicked).turning_angles
        tilt = motion.start.euler_angles.theta
        assert (low < tilt - 1e-4) is (direction == "rises")
        assert (high > tilt + 1e-4) is (direction == "falls")
        assert verdict.reason.rule == ("holds" if direction == "rises" else "fails")
    motion = motion_of("perry_fails")
    low, high = Motion(motion.top, hurry(motion.start, 1.4)).turning_angles
    assert motion.top.Mgl < 0 < motion.top.Iz - motion.top.Ix
    assert motion.start.euler_rates.psi_dot < 0
    assert high > motion.start.euler_angles.theta + 1e-4  # of the axis; the weight is below


def sample(scene, count=401):
    motion = motion_of(scene)
    return motion, motion.at(np.linspace(0.0, motion.nutation_period, count))


def test_cusps_loops_and_a_wave_are_told_by_the_sign_of_the_precession_rate():
    _, states = sample("cusps")
    rates = states.euler_rates.phi_dot
    assert rates[0] == pytest.approx(0.0, abs=1e-12) == rates[-1]
    assert states.euler_rates.theta_dot[0] == 0.0
    assert rates[1:-1].min() > 0
    assert (
        sample("looping")[1].euler_rates.phi_dot.min()
        < 0
        < sample("looping")[1].euler_rates.phi_dot.max()
    )
    motion, states = sample("unidirectional")
    slow, _ = regular_precession_rates(motion.top, 0.5, 200.0)
    assert motion.start.euler_rates.phi_dot > slow
    assert states.euler_rates.phi_dot.min() > 0


def test_what_stays_and_what_goes_round_is_as_the_scenes_say():
    for scene, rate in (("regular_precession", 6.50), ("fast_precession", 69.8)):
        _, states = sample(scene)
        assert states.euler_rates.phi_dot == pytest.approx(rate, abs=0.05)
        assert np.ptp(states.euler_angles.theta) < 1e-7
    motion, states = sample("free")
    L = motion.top.angular_momentum(states)
    axle = states.to_world([0.0, 0.0, 1.0])
    assert np.abs(L - L[0]).max() <= 1e-12 * np.abs(L[0]).max()
    assert np.ptp(axle @ L[0]) <= 1e-12 * np.linalg.norm(L[0])
    assert np.ptp(axle[:, 0]) > 0.1
    motion, states = sample("conical_pendulum")
    L, torque = motion.top.angular_momentum(states), motion.top.gravity_torque(states)
    assert np.abs(np.sum(L * torque, axis=1)).max() < 1e-6
    axle = states.to_world([0.0, 0.0, 1.0])
    across = L[:, 0] * axle[:, 1] - L[:, 1] * axle[:, 0]
    assert np.abs(across).max() < 1e-6  # the horizontal part of L is in the plane of the wire


def test_a_flat_top_a_hanging_one_and_a_plane_pendulum_are_what_they_are_called():
    disc = motion_of("disc")
    slow, fast = regular_precession_rates(disc.top, 0.6, 120.0)
    assert disc.top.Iz > disc.top.Ix
    assert slow * fast < 0 < disc.top.Mgl  # a s f = Mgl: a < 0, the quadratic opens downwards
    hanging = motion_of("hanging")
    assert hanging.start.euler_angles.theta > math.pi / 2
    assert motion_of("bicycle_wheel").start.euler_rates.psi_dot / (2 * math.pi) == pytest.approx(
        4, 0.01
    )
    spins = motion_of("toy_gyroscope").start.euler_rates.psi_dot
    assert spins * 60 / (2 * math.pi) == pytest.approx(2900, rel=0.02)
    plane = motion_of("through_the_pole")
    times = np.linspace(0.0, plane.nutation_period, 2001)
    axles = plane.at(times).to_world([0.0, 0.0, 1.0])
    assert plane.turning_angles[0] == 0.0
    assert axles[:, 2].max() > 1 - 1e-4
    assert np.abs(axles @ np.cross(axles[0], axles[500])).max() < 1e-9


def test_held_by_hand_it_falls_as_a_top_that_does_not_spin_and_let_go_it_loops():
    held = motion_of("perry_clamped")
    still = Motion(held.top, State.from_euler(theta=0.5))
    times = np.linspace(0.0, held.nutation_period / 2, 50)
    tilts = held.at(times).euler_angles.theta
    assert tilts == pytest.approx(still.at(times).euler_angles.theta, abs=1e-7)
    assert np.all(np.diff(tilts) > 0)
    for t in times[1:-1]:
        assert held.restart(held.at(t)).kind == "looping"


@pytest.mark.parametrize(
    ("scene", "root", "falls", "end"),
    [
        ("below_slow_root", 0, True, "0.587"),
        ("unidirectional", 0, False, "0.439"),
        ("below_fast_root", 1, False, "0.474"),
        ("above_fast_root", 1, True, "0.528"),
    ],
)
def test_next_to_a_regular_rate_the_top_rises_between_the_roots_and_falls_outside(
    scene, root, falls, end
):
    motion = motion_of(scene)
    rates = regular_precession_rates(motion.top, 0.5, 200.0)
    phi_dot = float(motion.start.euler_rates.phi_dot)
    assert abs(phi_dot - rates[root]) < 4
    assert falls == (not rates[0] < phi_dot < rates[1])
    low, high = motion.turning_angles
    assert (low == 0.5) == falls
    assert f"{high if falls else low:.3f}" == end


def test_the_second_cusp_is_a_cusp_at_its_highest_point():
    motion = motion_of("second_cusp")
    p_psi = float(motion.top.axial_momentum(motion.start))
    assert motion.start.euler_rates.phi_dot == pytest.approx(
        2 * motion.top.Mgl / p_psi, rel=8 * EPS
    )
    top = motion.at(motion.nutation_period / 2)
    assert f"{top.euler_angles.theta:.3f}" == "0.384"
    assert np.abs(top.angular_velocity[:2]).max() < 1e-6  # at rest, to the root of rounding


CAUSES = {  # scenes under gravity alone, by what explains their motion
    "circles": "backward_start looping",
    "with_momentum": "below_slow_root closed_cusps cusps disc hanging second_cusp unidirectional",
    "about_momentum": "below_fast_root above_fast_root",
    "steady": "bicycle_wheel conical_pendulum fast_precession hurry_fast hurry_slow perry_fails "
    "regular_precession toy_gyroscope",
    "free": "free",
    "swings": "gray_fall spin_reversal",
    "plane": "separatrix through_the_pole",
    "upright": "sleeping",
    "no_spin": "spherical_pendulum",
    None: "sleeping_unstable",
}


def test_what_explains_the_motion_of_each_scene_is_true_of_it():
    motions = {name: motion_of(name) for name in scene_names()}
    found = {}
    for name, motion in motions.items():
        if not motion.is_driven and not motion.clamped:
            cause = perrys_rule(motion.top, motion.start).cause
            found[name] = cause.explanation
            demand(motion.top, motion.start, cause)
    assert found == {name: cause for cause, names in CAUSES.items() for name in names.split()}


HEAD = "/**:\n  ros__parameters:\n"
LAUGHS = "".join(f"    a{k}: &a{k} [{f'*a{k - 1}, ' * 9 if k else 1}]\n" for k in range(12))
MAPS = "".join(
    f"    a{k}: &a{k} {{x: {f'*a{k - 1}' if k else 1}, y: {f'*a{k - 1}' if k else 1}}}\n"
    for k in range(40)
)
MOST_WORK = 100_000  # calls: one and a half for each byte of the largest file
NO_ALIASES = "got aliases or more than 8 levels"
REFUSED = {
    "lists of lists of aliases": (HEAD + LAUGHS, NO_ALIASES),
    "maps of maps of aliases": (HEAD + MAPS, NO_ALIASES),
    "an alias of itself": ("&a /**: *a", NO_ALIASES),
    "deep lists": (HEAD + "    x: " + "[" * 30_000 + "]" * 30_000, NO_ALIASES),
    "deep maps": (HEAD + "    x: " + "{a: " * 9_000 + "1" + "}" * 9_000, NO_ALIASES),
    "a tag of Python": (
        HEAD + '    x: !!python/object/apply:os.system ["exit 1"]',
        "could not determine a constructor for the tag",
    ),
    "nothing": ("", "must be a ROS parameter file for /**, got no parameters"),
    "a list": ("[1, 2]", "must be a ROS parameter file for /**, got no parameters"),
    "no parameters": ("/**: {}", "must be a ROS parameter file for /**, got no parameters"),
    "control characters": ("\0\1\2", "special characters are not allowed"),
    "a number for a name": (HEAD + "    1: 2", "got a name that is not text"),
    "a date": (
        HEAD + "    publish_rate: 2020-01-01",
        "'publish_rate' must be a number, a text, true, false, or a list of them, got datetime",
    ),
    "a set": (HEAD + "    publish_rate: !!set {a}", "a list of them, got {'a'}"),
    "an integer of 70 bits": (HEAD + f"    publish_rate: {2**70}", "a list of them, got 1180591"),
    "an integer of 6000 digits": (HEAD + "    publish_rate: " + "9" * 6000, "Exceeds the limit"),
    "nine levels": (f"{HEAD}    x: {'[' * 6}1{']' * 6}\n", NO_ALIASES),
    "eight levels, three of maps": (f"{HEAD}    x: {'[' * 5}1{']' * 5}\n", "a list of them"),
    "more than 64 KiB": (HEAD.ljust(65_536, "#") + "\n", "65537 bytes (limit 65536)"),
    "bytes that are no text": (b"\xff\xfe\xfa", "'utf-8' codec can't decode"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    scenes = tmp_path / CONFIG
    scenes.mkdir(parents=True)
    return scenes


@pytest.mark.parametrize(("content", "sentence"), REFUSED.values(), ids=REFUSED)
def test_an_invalid_scene_is_refused_quickly_and_in_one_sentence(folder, content, sentence):
    data = content if isinstance(content, bytes) else content.encode()
    (folder / "odd.yaml").write_bytes(data)
    with counting() as work, pytest.raises(RefusedError) as refusal:
        load_scene("odd")
    assert work.calls < MOST_WORK
    assert sentence in str(refusal.value)
    assert_one_sentence(str(refusal.value))


def test_a_scene_may_have_64_kib(folder):
    text = HEAD + "    top: {Mgl: 0.05}\n"
    (folder / "odd.yaml").write_text(text.ljust(65_535, "#") + "\n")
    assert load_scene("odd") == {"top.Mgl": 0.05}


@pytest.mark.parametrize("make", [os.mkdir, os.mkfifo])
def test_a_scene_that_is_not_a_file_is_refused(folder, make):
    make(folder / "odd.yaml")
    reason = r"odd\.yaml must be a ROS parameter file for /\*\*, got no file"
    with pytest.raises(RefusedError, match=reason):
        load_scene("odd")


@pytest.mark.parametrize("name", ["none", "../odd", "", 5, None, ["odd"], "x" * 100_000, "\x1b\n"])
def test_an_unknown_scene_is_refused(folder, name):
    (folder / "odd.yaml").write_text(HEAD + "    top: {Ix: 1.0}\n")
    with pytest.raises(RefusedError) as refusal:
        load_scene(name)
    assert_one_sentence(str(refusal.value))


def test_a_folder_of_another_package_has_no_scenes(tmp_path, monkeypatch):
    (tmp_path / "config").mkdir()
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    monkeypatch.setattr(presets, "__file__", str(tmp_path / "symtop_ros/run/simulation/presets.py"))
    assert presets.config_folder() == Path(sys.prefix, CONFIG)
