"""Arrows of the inertial torque: their sums are the torque, in either frame."""

import numpy as np
from log_files import ARTICLE, CUSPS, Run
from playback.view.rows import FLOAT, arrows, record, rows

from symtop_ros.physics import Motion
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.torques import ARROWS, LENGTH, Torques


def test_on_cusps_dL_in_the_body_is_the_derivative_of_its_components(tmp_path):
    (batch,) = Run(start=CUSPS, seconds=0.5, hurried=False).open(tmp_path).batches()
    stamps, torques = Torques.of(batch.columns)
    times, step, motion = (stamps - stamps[0]) * 1e-9, 1e-5, Motion(ARTICLE, CUSPS)
    L = [ARTICLE.body_angular_momentum(motion.at(times + h)) for h in (-step, step)]
    found = motion.at(times).to_world((L[1] - L[0]) / (2 * step))
    # a central difference: its error is (200 rad/s step)^2 / 6, about 1e-6
    assert np.abs(found - torques.body).max() <= 2e-6 * np.abs(torques.body).max()
    assert np.abs(torques.precession - torques.total).max() > 0.5 * np.abs(torques.total).max()


def test_the_second_arrow_begins_below_the_tip_of_the_first_and_ends_below_the_torque(tmp_path):
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
