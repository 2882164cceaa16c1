"""Arrows of the torques in the precessing frame: their sum turns the axis up or down."""

import numpy as np
import pytest
from log_files import ARTICLE, CUSPS, Run
from playback.view.rows import entities_of, record, rows

from symtop_ros.physics import Motion, State, regular_precession_rates
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.fictitious import DEPTHS, LENGTH, LONGEST, find_scale

FLOAT = 4 * float(np.finfo(np.float32).eps)
SLOW = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)[0]


def drawn(target):
    """Origins and vectors of each arrow, (n, 3), and the times in ns."""
    found, times = {}, None
    for name in DEPTHS:
        entity = f"{entities.FICTITIOUS}/{name}"
        times, vectors = rows(target, entity, "Arrows3D:vectors")
        origins = rows(target, entity, "Arrows3D:origins")[1]
        found[name] = np.array(origins)[:, 0], np.array(vectors)[:, 0]
    return times, found


def test_on_cusps_the_fourth_arrow_is_the_angular_acceleration(tmp_path):
    run = Run(start=CUSPS, seconds=0.5, hurried=False)
    times, arrows = drawn(record(run.write(tmp_path), tmp_path, fictitious=True))
    begin, motion, step = times[0], Motion(ARTICLE, CUSPS), 1e-5
    seconds = (times - begin) * 1e-9
    before, after = (motion.at(seconds + h).euler_rates.theta for h in (-step, step))
    expected = ARTICLE.Ix * (after - before) / (2 * step) / find_scale(ARTICLE, CUSPS)
    phi = motion.at(seconds).euler_angles.phi
    nodes = np.stack([np.cos(phi), np.sin(phi), 0 * phi], axis=1)
    # a central difference: (40 rad/s step)^2/6 of a length below 1; measured: 2e-8
    assert np.abs(arrows["sum"][1] - expected[:, None] * nodes).max() < 5e-8
    tips = [arrows[name][0] + arrows[name][1] for name in DEPTHS]
    for tip, name in zip(tips, ("Coriolis", "centrifugal"), strict=False):
        assert np.abs((tip - arrows[name][0])[:, :2]).max() <= FLOAT
    assert np.abs((tips[2] - tips[3])[:, :2]).max() <= FLOAT


def test_in_regular_precession_the_fourth_arrow_has_no_length(tmp_path):
    start = State.from_euler(theta=0.5, phi_dot=SLOW, psi_dot=200.0)
    run = Run(start=start, seconds=0.2, hurried=False)
    _, arrows = drawn(record(run.write(tmp_path), tmp_path, fictitious=True))
    assert np.abs(arrows["sum"][1]).max() <= FLOAT
    assert np.linalg.norm(arrows["gravity"][1], axis=1) == pytest.approx(
        LENGTH * np.sin(0.5), rel=0.05
    )  # a scale has two digits


def test_through_the_vertical_no_arrow_is_too_long_and_the_others_are_drawn(tmp_path):
    start = State.from_euler(theta=0.4, theta_dot=12.0, psi_dot=5.0)
    run = Run(start=start, seconds=0.5, hurried=False)
    _, arrows = drawn(record(run.write(tmp_path), tmp_path, fictitious=True))
    lengths = np.array([np.linalg.norm(vectors, axis=1) for _, vectors in arrows.values()])
    assert np.isfinite(lengths).all()
    assert lengths.max() <= LONGEST
    assert (lengths[0] > 0).mean() > 0.5


def test_arrows_are_drawn_only_if_asked_and_the_panel_has_their_scale(tmp_path):
    log = Run().write(tmp_path)
    assert not any(
        each.startswith(entities.FICTITIOUS) for each in entities_of(record(log, tmp_path))
    )
    target = record(log, tmp_path, fictitious=True)
    _, texts = rows(target, entities.PANEL, "TextDocument:text")
    assert f"1 unit {find_scale(ARTICLE, CUSPS):g} N m" in texts[0][0]
