"""Arcs join the axes of Euler's angles, and the body cone rolls on the cone in space."""

import numpy as np
import pytest
from log_files import ARTICLE, Run
from replay.view.rows import FLOAT, arrows, entities_of, record, rows
from rerun.chunk import RrdReader

from symtop_ros.physics import Motion, State, Top
from symtop_ros.replay.view import entities
from symtop_ros.replay.view.surroundings import RADII, draw_arcs, has_cones

# of a point: sums of four rounded products of numbers up to 1.1
ROUNDING = 8 * float(np.finfo(float).eps)


def test_each_arc_begins_at_one_axis_and_ends_at_the_other():
    rng = np.random.default_rng(3)
    phi, psi = rng.uniform(0, 2 * np.pi, (2, 50))
    theta = rng.uniform(0.01, np.pi - 0.01, 50)
    arcs = draw_arcs(phi, theta, psi)
    for k in range(50):
        state = State.from_euler(theta=theta[k], phi=phi[k], psi=psi[k])
        x, z = (state.to_world(axis) for axis in ([1.0, 0, 0], [0, 0, 1.0]))
        nodes = np.array([np.cos(phi[k]), np.sin(phi[k]), 0.0])
        ends = {"phi": ([1.0, 0, 0], nodes), "theta": ([0, 0, 1.0], z), "psi": (nodes, x)}
        for name, (first, last) in ends.items():
            arc = arcs[name][k] / RADII[name]
            assert np.abs(arc[0] - first).max() <= ROUNDING
            assert np.abs(arc[-1] - last).max() <= ROUNDING


def test_the_axes_of_the_body_turn_with_it_and_the_letters_are_greek(tmp_path):
    run = Run(seconds=0.5, hurried=False)
    recording = record(run, tmp_path, angles=True)
    assert f"{entities.ANGLES}/nodes" in entities_of(recording)
    times, strips = rows(recording, f"{entities.ANGLES}/theta", "LineStrips3D:strips")
    ends = np.array([strip[0][-1] for strip in strips])
    axis = Motion(run.top, run.start).at(times * 1e-9).to_world([0, 0, 1.0])
    assert np.abs(ends / RADII["theta"] - axis).max() <= FLOAT
    letters = {}
    for chunk in RrdReader(recording).stream():
        if chunk.is_static and chunk.entity_path.endswith("/letter"):
            labels = chunk.to_record_batch().column("Points3D:labels").to_pylist()
            letters[chunk.entity_path.split("/")[-2]] = labels[0][0]
    assert letters == {"phi": "φ", "theta": "θ", "psi": "ψ"}


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
