"""The body that is drawn: what is said of its shape, by the corners and triangles of its mesh."""

import numpy as np
import pytest
from log_files import ARTICLE

from symtop_ros.physics import Top
from symtop_ros.replay.view import entities

TOPS = (ARTICLE, Top(1.0, 1.5, -2.0), Top(1.0, 0.01, 3.0), Top(1.0, 2.0, 0.0))


@pytest.mark.parametrize("top", TOPS, ids=str)
def test_the_rotor_is_widest_at_the_centre_of_mass_and_wider_for_a_larger_ratio(top):
    x, y, z = entities.create_body(top).positions.T.astype(float)
    radii = np.hypot(x, y)
    widest = radii > radii.max() * (1 - 1e-6)  # rounding of single numbers
    centre = 0.56 * np.sign(top.Mgl)
    assert z[widest] == pytest.approx(centre, abs=1e-6)
    assert radii.max() == pytest.approx(0.2 + 0.26 * np.sqrt(top.Iz / top.Ix), rel=1e-6)


@pytest.mark.parametrize("top", TOPS, ids=str)
def test_triangles_face_the_way_of_their_normals(top):
    mesh = entities.create_body(top)
    corners = mesh.positions.astype(float)[mesh.triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(faces, axis=1)
    assert (areas > 1e-12).mean() > 0.9  # at a tip one of the two triangles of a facet has none
    along = (faces * mesh.normals.astype(float)[mesh.triangles].sum(axis=1)).sum(axis=1)
    assert (along[areas > 1e-12] > 0).all()
