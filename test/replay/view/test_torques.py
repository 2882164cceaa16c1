"""Arrows: torques in the precessing frame turn the axis, inertial ones add up to the torque."""

import numpy as np
import pytest
from log_files import ARTICLE, CUSPS, Run
from replay.view.rows import FLOAT, arrows, record, rows

from symtop_ros.physics import Motion, State, Top
from symtop_ros.replay.view import entities
from symtop_ros.replay.view.torques import ARROWS, DEPTHS, LENGTH, LONGEST, Torques, find_scale

UNIT = 0.068  # N m, of the article's top that is let go at rest: Mgl is the largest torque


SCALES = [
    (ARTICLE, CUSPS, UNIT),
    # Iz psi' phi' sin(theta) = 123.45 N m, to two digits
    (Top(1.0, 1.0, 3.0), State.from_euler(theta=np.pi / 6, phi_dot=1.0, psi_dot=246.9), 120.0),
    (Top(1.0, 1.0, 3.0), State.from_euler(theta=np.pi / 6, phi_dot=-1.0, psi_dot=246.9), 120.0),
    (Top(1.0, 1.0, 0.0), State.from_euler(theta=0.5, psi_dot=9.0), 1.0),  # no torque at all
]


@pytest.mark.parametrize(("top", "start", "unit"), SCALES)
def test_a_unit_of_the_scene_is_the_largest_torque_at_the_start(top, start, unit):
    assert find_scale(top, start) == unit


def drawn(start, folder):
    """Origins and vectors of each arrow of half a second, (n, 3), and the times in ns."""
    run = Run(start=start, seconds=0.5, hurried=False)
    target = record(run, folder, fictitious=True)
    found = {}
    times = None
    for name in DEPTHS:
        entity = f"{entities.FICTITIOUS}/{name}"
        times, _ = rows(target, entity, "Arrows3D:vectors")
        found[name] = arrows(target, entity, "origins"), arrows(target, entity)
    return times, found


def test_on_cusps_the_fourth_arrow_is_the_angular_acceleration(tmp_path):
    times, found = drawn(CUSPS, tmp_path)
    begin = times[0]
    motion = Motion(ARTICLE, CUSPS)
    step = 1e-5
    seconds = (times - begin) * 1e-9
    before, after = (motion.at(seconds + h).euler_rates.theta_dot for h in (-step, step))
    expected = ARTICLE.Ix * (after - before) / (2 * step) / UNIT
    phi = motion.at(seconds).euler_angles.phi
    nodes = np.stack([np.cos(phi), np.sin(phi), 0 * phi], axis=1)
    # a central difference: (40 rad/s step)^2/6 of a length below 1 are 3e-8
    assert np.abs(found["sum"][1] - expected[:, None] * nodes).max() < 5e-8
    tips = [sum(found[name]) for name in DEPTHS]
    for tip, name in zip(tips, ("Coriolis", "centrifugal"), strict=False):
        assert np.abs((tip - found[name][0])[:, :2]).max() <= FLOAT
    assert np.abs((tips[2] - tips[3])[:, :2]).max() <= FLOAT


def test_through_the_vertical_no_arrow_is_too_long_and_the_others_are_drawn(tmp_path):
    _, found = drawn(State.from_euler(theta=0.4, theta_dot=12.0, psi_dot=5.0), tmp_path)
    lengths = np.array([np.linalg.norm(vectors, axis=1) for _, vectors in found.values()])
    assert np.isfinite(lengths).all()
    assert lengths.max() <= LONGEST
    assert (lengths[0] > 0).mean() > 0.5


def test_on_cusps_dL_in_the_body_is_the_derivative_of_its_components(tmp_path):
    (batch,) = Run(start=CUSPS, seconds=0.5, hurried=False).open(tmp_path).batches()
    stamps, torques = Torques.of(batch.columns)
    times = (stamps - stamps[0]) * 1e-9
    step = 1e-5
    motion = Motion(ARTICLE, CUSPS)
    L = [ARTICLE.body_angular_momentum(motion.at(times + h)) for h in (-step, step)]
    found = motion.at(times).to_world((L[1] - L[0]) / (2 * step))
    # a central difference: its error is (200 rad/s step)^2 / 6, about 1e-6
    assert np.abs(found - torques.body).max() <= 2e-6 * np.abs(torques.body).max()
    assert np.abs(torques.precession - torques.total).max() > 0.5 * np.abs(torques.total).max()


def test_the_two_arrows_stand_one_below_the_other(tmp_path):
    target = record(Run(), tmp_path, torques=True)
    (origins, first), (tails, second) = (
        [arrows(target, f"{entities.INERTIAL}/{name}", column) for column in ("origins", "vectors")]
        for name in ("body", "turning")
    )
    shown, _ = rows(target, f"{entities.INERTIAL}/body", "Arrows3D:vectors")
    times, _ = rows(target, entities.TORQUE, "Arrows3D:vectors")
    at_shown = arrows(target, entities.TORQUE)[np.isin(times, shown)]
    assert np.abs((tails - origins - first)[:, :2]).max() <= FLOAT
    assert np.abs((tails + second - at_shown)[:, :2]).max() <= FLOAT
    lengths = np.linalg.norm(np.concatenate([first, second]), axis=1)
    assert 0.9 * LENGTH < lengths[: len(lengths) // 4].max() < 1.1 * LENGTH
    _, texts = rows(target, entities.PANEL, "TextDocument:text")
    assert "torque = dL/dt + φ' z' x L" in texts[0][0]
    assert len(ARROWS) == 3
