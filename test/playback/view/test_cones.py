"""The end of omega is on both rims at any time: the body cone rolls on the cone in space."""

import numpy as np
import pytest
from log_files import ARTICLE, Run
from playback.view.rows import FLOAT, arrows, entities_of, record, rows

from symtop_ros.physics import Motion, State, Top
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.surroundings import has_cones

STARTS = {
    "rod": (0.25, {"theta": 0.5, "phi_dot": 30.0, "psi_dot": 60.0}),
    "disc": (1.9, {"theta": 1.2, "theta_dot": 9.0, "psi_dot": 20.0}),
    "backwards": (0.25, {"theta": 0.5, "phi_dot": 30.0, "psi_dot": -60.0}),
    "L downwards": (0.8, {"theta": 0.5, "phi_dot": -3.0, "psi_dot": -1.0}),
}


def turn(q, vectors):
    x, y, z, w = q
    return State((w, x, y, z), (0, 0, 0)).to_world(vectors)


@pytest.mark.parametrize("name", STARTS)
def test_omega_is_on_both_rims(name, tmp_path):
    ratio, start = STARTS[name]
    run = Run(Top(1.0, ratio, 0.0), State.from_euler(**start), seconds=0.5, hurried=False)
    target = record(run, tmp_path)
    ((polhode,),) = rows(target, f"{entities.POLHODE}/rim", "LineStrips3D:strips")[1]
    ((herpolhode,),) = rows(target, f"{entities.HERPOLHODE}/rim", "LineStrips3D:strips")[1]
    ((turned,),) = rows(target, entities.HERPOLHODE, "Transform3D:quaternion")[1]
    omega = arrows(target, entities.VELOCITY)
    quaternions = np.array(rows(target, entities.BODY, "Transform3D:quaternion")[1])[:, 0]
    in_space = turn(turned, herpolhode)
    # an edge of the rim, which has 96, is nearer to its circle than the square of its angle
    edge = (np.pi / 96) ** 2 * np.linalg.norm(omega, axis=1).max()
    for tip, q in list(zip(omega, quaternions, strict=True))[::7]:
        for rim in (in_space, turn(q, polhode)):
            sides = np.linalg.norm(np.diff(rim, axis=0), axis=1).max()
            assert np.linalg.norm(rim - tip, axis=1).min() <= sides / 2 + edge + FLOAT


def test_only_a_motion_without_any_torque_has_cones(tmp_path):
    recording = record(Run(), tmp_path)
    assert not any("polhode" in each for each in entities_of(recording))
    start = State.from_euler(theta=0.5, phi_dot=30.0, psi_dot=60.0)
    free = Top(ARTICLE.Ix, ARTICLE.Iz, 0.0)
    assert has_cones(Motion(free, start))
    assert not has_cones(Motion(ARTICLE, start))
    assert not has_cones(Motion(free, start, torque=(0, 0, 1e-4)))
