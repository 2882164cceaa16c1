"""Arcs of Euler's angles: they join the axes between which the angles are measured."""

import numpy as np
from log_files import Run
from playback.view.rows import FLOAT, entities_of, record, rows
from rerun.chunk import RrdReader

from symtop_ros.physics import Motion, State
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.surroundings import RADII, draw_arcs

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
