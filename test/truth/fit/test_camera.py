"""The camera of a fit, held against a pinhole that is written otherwise."""

import numpy as np
import pytest
from drawn import Numbers
from scipy.spatial.transform import Rotation

from symtop_ros.truth.fit.camera import project, rectify
from workshop.records.cameras import Camera

EPS = 2.0**-52
WIDTH, HEIGHT = 1280, 720
# Some dozen operations on numbers of a picture; a camera divides by distances of at least 0.8.
ROUNDING = 256 * EPS * WIDTH


def draw_axes(draw, count=50):
    axes = draw.normals(count, 3)
    return axes / np.linalg.norm(axes, axis=1, keepdims=True)


def draw_camera(draw):
    """Return a camera that looks beside the pivot, and the numbers of the fit for it."""
    distance, elevation = draw.uniform(1.8, 40), draw.uniform(-1.25, 1.25)
    place = 0.0, float(-distance * np.cos(elevation)), float(distance * np.sin(elevation))
    aim = tuple(draw.uniforms(-0.5, 0.5, 3).tolist())
    return Camera(place, aim, 250.0 * distance, (WIDTH, HEIGHT), roll=draw.uniform(-1, 1))


def describe(camera):
    """Return the numbers by which the fit knows a camera: by what it shows of the axes."""
    (pivot,) = camera.see(np.zeros((1, 3)))
    numbers = {"u": pivot[0], "v": pivot[1], "nearness": 1 / camera.distance}
    numbers |= {"elevation": camera.elevation, "log_scale": np.log(camera.focal / camera.distance)}
    numbers |= {"centre_u": WIDTH / 2, "centre_v": HEIGHT / 2}
    return numbers | {"roll": find_roll(camera)}


def find_roll(camera):
    """Return the roll of the same camera, turned to the pivot by the shortest way."""
    place, aim = np.array(camera.place), np.array(camera.aim)
    ahead, pivot = (each / np.linalg.norm(each) for each in (aim - place, -place))
    axis = np.cross(ahead, pivot)
    angle = np.arctan2(np.linalg.norm(axis), ahead @ pivot)
    turn = Rotation.from_rotvec(axis / np.linalg.norm(axis) * angle)
    right, up = level(ahead)
    right = turn.apply(np.cos(camera.roll) * right + np.sin(camera.roll) * up)
    plain, high = level(pivot)
    return float(np.arctan2(-right @ high, right @ plain))


def level(ahead):
    """Return right and up of a camera without a roll."""
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    return right, np.cross(right, ahead)


def see(axes, numbers):
    return project(axes[None], {name: np.array([each]) for name, each in numbers.items()})[0]


@pytest.mark.parametrize("seed", range(20))
def test_a_camera_that_looks_beside_the_pivot_sees_what_a_pinhole_sees(seed):
    draw = Numbers(f"camera {seed}")
    camera, axes = draw_camera(draw), draw_axes(draw)
    found = see(axes, describe(camera))
    assert np.abs(found - camera.see(axes)).max() < ROUNDING


@pytest.mark.parametrize("seed", range(20))
def test_points_are_turned_to_those_of_a_camera_that_looks_at_the_pivot(seed):
    draw = Numbers(f"turned {seed}")
    numbers, axes = describe(draw_camera(draw)), draw_axes(draw)
    plain = {name: each for name, each in numbers.items() if "centre" not in name}
    found = rectify(see(axes, numbers), numbers)
    # turning back magnifies a rounding by at most the square of the largest ratio of distances
    assert np.abs(found - see(axes, plain)).max() < 16 * ROUNDING
    assert np.array_equal(rectify(found, plain), found)


def test_far_away_it_does_not_matter_where_a_camera_looks():
    draw = Numbers("far")
    numbers = describe(draw_camera(draw)) | {"nearness": 0.0}
    axes = draw_axes(draw)
    plain = {name: each for name, each in numbers.items() if "centre" not in name}
    assert np.array_equal(see(axes, numbers), see(axes, plain))


def test_a_camera_that_looks_at_the_pivot_is_one_without_a_centre():
    draw = Numbers("centre")
    numbers = describe(draw_camera(draw))
    axes = draw_axes(draw)
    plain = {name: each for name, each in numbers.items() if "centre" not in name}
    pivot = {"centre_u": numbers["u"], "centre_v": numbers["v"]}
    assert np.array_equal(see(axes, numbers | pivot), see(axes, plain))
