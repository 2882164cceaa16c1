"""The geometry of the scene: matrices, the camera, the grip and lines are those of NumPy."""

import math

import numpy as np
import pytest
from drawn import Numbers

from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.physics.values import EPS

ANGLE = math.radians(42)  # of the view, from the lower to the upper edge
WIDTH, HEIGHT = 600, 400  # px


def draw_vectors(name, count):
    return Numbers(name).uniforms(-3.0, 3.0, count, 3)


def call(tab, module, calls):
    """Return what functions of a module of the page give."""
    return tab.evaluate("callAll", [module, calls])


def turn(quaternion, vector):
    """Turn a vector by its angle about an axis, by Rodrigues."""
    w, *axis = quaternion
    size = np.linalg.norm(axis)
    angle = 2 * math.atan2(size, w)
    axis = np.array(axis) / (size or 1.0)
    along = axis * (axis @ vector) * (1 - math.cos(angle))
    return vector * math.cos(angle) + np.cross(axis, vector) * math.sin(angle) + along


def to_matrix(numbers):
    """Return a matrix from its columns."""
    return np.array(numbers).reshape(4, 4).T


def test_vectors_are_added_and_multiplied(tab):
    pairs = [*zip(draw_vectors("a", 20), draw_vectors("b", 20), strict=True)]
    given = [(a.tolist(), b.tolist()) for a, b in pairs]
    ways = {"add": np.add, "subtract": np.subtract, "cross": np.cross, "dot": np.dot}
    for name, way in ways.items():
        found = call(tab, "scene/matrices", [[name, a, b] for a, b in given])
        # sums of products of numbers below 3
        np.testing.assert_allclose(found, [way(a, b) for a, b in pairs], rtol=0, atol=60 * EPS)
    vectors = [a.tolist() for a, _ in pairs] + [[0.0, 0.0, 0.0]]
    sizes = np.linalg.norm(vectors, axis=1)
    found = call(tab, "scene/matrices", [["findSize", each] for each in vectors])
    np.testing.assert_allclose(found, sizes, rtol=4 * EPS)
    found = call(tab, "scene/matrices", [["scale", each, -2.5] for each in vectors])
    assert found == (-2.5 * np.array(vectors)).tolist()
    found = call(tab, "scene/matrices", [["normalize", each] for each in vectors])
    right = np.array(vectors) / np.where(sizes, sizes, 1.0)[:, np.newaxis]
    np.testing.assert_allclose(found, right, rtol=0, atol=8 * EPS)


def test_matrices_are_multiplied_by_columns(tab):
    draw = Numbers("matrices of the scene")
    pairs = [draw.uniforms(-2.0, 2.0, 2, 16) for _ in range(10)]
    calls = [["multiplyMatrices", a.tolist(), b.tolist()] for a, b in pairs]
    found = call(tab, "scene/matrices", calls)
    for numbers, (a, b) in zip(found, pairs, strict=True):
        right = to_matrix(a) @ to_matrix(b)
        np.testing.assert_allclose(to_matrix(numbers), right, rtol=0, atol=64 * EPS)


def test_a_pose_sizes_turns_and_moves(tab):
    draw = Numbers("poses")
    cases = [
        (q, draw.uniforms(0.1, 3.0, 3), draw.uniforms(-2.0, 2.0, 3)) for q in draw.quaternions(10)
    ]
    calls = [["createPose", *(each.tolist() for each in case)] for case in cases]
    points = np.array([[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0], [0.3, -0.4, 0.5]])
    for numbers, (q, size, place) in zip(call(tab, "scene/matrices", calls), cases, strict=True):
        for point in points:
            found = to_matrix(numbers) @ [*point, 1.0]
            assert found[3] == 1.0
            right = place + turn(q, size * point)
            np.testing.assert_allclose(found[:3], right, rtol=0, atol=64 * EPS)
    (plain,) = call(tab, "scene/matrices", [["createPose", [1.0, 0.0, 0.0, 0.0]]])
    assert to_matrix(plain).tolist() == np.eye(4).tolist()


def test_the_shortest_turn_from_z_leads_to_a_direction(tab):
    directions = draw_vectors("directions", 20)
    directions /= np.linalg.norm(directions, axis=1)[:, np.newaxis]
    directions = [*directions, np.array([0, 0, -1.0]), np.array([0, 0, 1.0]), np.array([1.0, 0, 0])]
    directions.append(np.array([0, -1.0, 0]))
    found = call(tab, "scene/matrices", [["turnTo", each.tolist()] for each in directions])
    for quaternion, direction in zip(found, directions, strict=True):
        # the arc cosine of a number near 1 has half of its digits
        reached = turn(quaternion, np.array([0.0, 0.0, 1.0]))
        np.testing.assert_allclose(reached, direction, rtol=0, atol=4 * math.sqrt(EPS))
        angle = 2 * math.acos(min(quaternion[0], 1.0))
        assert angle == pytest.approx(math.acos(direction[2]), abs=4 * math.sqrt(EPS))
        assert quaternion[3] == 0.0


# A camera on an element of some size, where it was placed, after acts; what it shows of points.
LOOK = """async ([width, height, eye, target, acts, points]) => {
  const { Camera } = await import("/scene/camera.js");
  const element = document.createElement("div");
  Object.assign(element.style, { width: `${width}px`, height: `${height}px` });
  document.body.append(element);
  const camera = new Camera(element);
  camera.place(eye, target);
  for (const [act, ...given] of acts) camera[act](...given);
  const seen = points.map((each) => camera.project(each));
  const back = points.map((each, k) =>
    seen[k] ? camera.unproject(seen[k].x, seen[k].y, each) : null);
  const moved = points.map((each, k) =>
    seen[k] ? camera.unproject(seen[k].x + 30, seen[k].y - 20, each) : null);
  element.remove();
  return { eye: camera.eye, seen, back, moved, matrix: [...camera.matrix] };
}"""
EYE, TARGET = [1.46, -1.7, 0.95], [0.0, 0.1, 0.33]


def look(tab, points=(), acts=(), width=WIDTH, height=HEIGHT, eye=EYE):
    given = [width, height, eye, TARGET, [*acts], [list(map(float, each)) for each in points]]
    return tab.evaluate(LOOK, given)


def find_axes(eye):
    """Return the directions to the right, up and forward of an eye, with the world's z upwards."""
    forward = np.array(TARGET) - eye
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    return right, np.cross(right, forward), forward


def show(point, eye, width=WIDTH, height=HEIGHT):
    """Return the place in px that a pinhole shows, and the depth: a narrow page sees as wide."""
    right, up, forward = find_axes(eye)
    seen = np.asarray(point) - eye
    unit = min(width, height) / (2 * math.tan(ANGLE / 2)) / (seen @ forward)
    x, y = width / 2 + unit * (seen @ right), height / 2 - unit * (seen @ up)
    return [x, y, seen @ forward]


@pytest.mark.parametrize(("width", "height"), [(WIDTH, HEIGHT), (300, 500)])
def test_the_camera_shows_points_as_a_pinhole(tab, width, height):
    points = draw_vectors("points", 12) / 4
    found = look(tab, points, width=width, height=height)
    for seen, back, moved, point in zip(
        found["seen"], found["back"], found["moved"], points, strict=True
    ):
        right = show(point, EYE, width, height)
        # pixels from sums of products in units of some hundred
        np.testing.assert_allclose([seen["x"], seen["y"], seen["depth"]], right, atol=1e-10)
        np.testing.assert_allclose(back, point, rtol=0, atol=1e-12)
        away = show(moved, EYE, width, height)
        np.testing.assert_allclose(away, [right[0] + 30, right[1] - 20, right[2]], atol=1e-9)


def test_what_is_behind_the_eye_is_not_shown(tab):
    behind = 2 * np.array(EYE) - TARGET
    assert look(tab, [behind])["seen"] == [None]


def test_depths_between_the_nearest_and_the_farthest_are_within_the_picture(tab):
    matrix = to_matrix(look(tab)["matrix"])
    _, _, forward = find_axes(EYE)
    for distance, edge in ((0.05, -1.0), (60.0, 1.0)):
        *_, depth, size = matrix @ [*(np.array(EYE) + distance * forward), 1.0]
        assert depth / size == pytest.approx(edge, abs=1e-11)


def turn_eye(around, above, nearer=1.0):
    """Return the eye after turns about the vertical and upwards, at another distance."""
    x, y, z = np.array(EYE) - TARGET
    size = math.sqrt(x * x + y * y + z * z)
    azimuth, height = math.atan2(y, x) + around, math.asin(z / size) + above
    height = min(max(height, -1.5), 1.5)
    size = min(max(nearer * size, 1.2), 12.0)
    level = [math.cos(azimuth), math.sin(azimuth)]
    return TARGET + size * np.array([*(math.cos(height) * np.array(level)), math.sin(height)])


@pytest.mark.parametrize(
    ("acts", "turned"),
    [
        ([], (0.0, 0.0)),
        ([("turn", 100, 0)], (-0.8, 0.0)),
        ([("turn", -25, 50)], (0.2, 0.4)),
        ([("turn", 0, 1000)], (0.0, 9.0)),
        ([("turn", 0, -1000)], (0.0, -9.0)),
        ([("approach", 1.5)], (0.0, 0.0, 1.5)),
        ([("approach", 0.1)], (0.0, 0.0, 0.1)),
        ([("approach", 100)], (0.0, 0.0, 100.0)),
    ],
)
def test_a_drag_turns_the_camera_and_a_wheel_moves_it_within_limits(tab, acts, turned):
    assert look(tab, acts=acts)["eye"] == pytest.approx(turn_eye(*turned), abs=1e-14)


def test_a_pull_and_a_line_have_the_angles_of_the_axis(tab):
    draw = Numbers("angles of the axis")
    angles = [(draw.uniform(0.01, 3.1), draw.uniform(-3.1, 3.1)) for _ in range(20)]
    axes = [State.from_euler(theta=a, phi=b).to_world((0.0, 0.0, 1.0)) for a, b in angles]
    pulled = call(tab, "scene/grip", [["findAngles", (2.5 * each).tolist()] for each in axes])
    found = [(each["theta"], each["phi"]) for each in pulled]
    np.testing.assert_allclose(found, angles, rtol=0, atol=1e-13)  # next to a pole phi has less
    points = call(tab, "scene/curves", [["findPoint", a, b, 2.5] for a, b in angles])
    np.testing.assert_allclose(points, 2.5 * np.array(axes), rtol=0, atol=16 * EPS)


def test_lines_of_the_sphere_go_from_point_to_point(tab):
    pieces, circle, half, whole = call(
        tab,
        "scene/curves",
        [
            ["listPieces", [[1, 2, 3], [4, 5, 6], [7, 8, 9]]],
            ["listParallel", 0.75],
            ["listSphere", False],
            ["listSphere", True],
        ],
    )
    assert pieces == [1, 2, 3, 4, 5, 6, 4, 5, 6, 7, 8, 9]
    circle = np.reshape(circle, (-1, 2, 3))
    assert len(circle) == 96
    np.testing.assert_allclose(circle[:, :, 2], math.cos(0.75), rtol=4 * EPS)
    np.testing.assert_allclose(circle[-1, 1], circle[0, 0], atol=8 * EPS)
    steps = np.linalg.norm(circle[:, 1] - circle[:, 0], axis=1)
    side = 2 * math.sin(0.75) * math.sin(math.pi / 96)  # of a polygon of 96 sides
    np.testing.assert_allclose(steps, side, rtol=1e-12)
    for lines, parallels, lowest in ((half, 3, 0.0), (whole, 5, -1.0)):
        points = np.reshape(lines, (-1, 2, 3))
        assert len(points) == 96 * parallels + 6 * 64
        np.testing.assert_allclose(np.linalg.norm(points, axis=2), 1.0, rtol=8 * EPS)
        assert points[..., 2].min() == pytest.approx(lowest, abs=1e-15)


VECTORS = """async (cases) => {
  const { Course } = await import("/physics/course.js");
  const { State } = await import("/physics/state.js");
  const { findTorques, findVectors } = await import("/scene/vectors.js");
  return cases.map(([top, orientation, omega, friction, torque]) => {
    const state = new State(kernel, orientation, omega);
    const course = new Course(kernel, top, state, friction, torque);
    return [findVectors(course, state), findTorques(top, state)];
  });
}"""
BODY = {"Ix": 0.5, "Iz": 0.25, "Mgl": 3.0}
COEFFICIENTS = {"axial": 0.02, "transverse": 0.03}


def test_arrows_are_the_vectors_of_the_motion(tab):
    draw = Numbers("arrows")
    top, torque = Top(**BODY), [0.25, -0.5, 0.125]
    friction = Friction(**COEFFICIENTS)
    names = ("theta", "phi", "psi"), ("theta_dot", "phi_dot", "psi_dot")
    drawn = [(*draw.uniforms(0.2, 2.8, 3), *draw.uniforms(-9.0, 9.0, 3)) for _ in range(10)]
    states = [State.from_euler(**dict(zip(sum(names, ()), each, strict=True))) for each in drawn]
    by_kind = [getattr(friction, each) for each in friction.__dataclass_fields__]
    cases = [
        [BODY, each.orientation.tolist(), each.angular_velocity.tolist(), by_kind, torque]
        for each in states
    ]
    for (drawn, line), state in zip(tab.evaluate(VECTORS, cases), states, strict=True):
        motion = Motion(top, state, friction, torque)
        right = {
            "L": top.angular_momentum(state),
            "omega": state.to_world(state.angular_velocity),
            "torque": motion.total_torque(state),
        }
        for name, vector in right.items():
            # sums of some products, of rates below 30 rad/s
            np.testing.assert_allclose(drawn[name], vector, rtol=0, atol=64 * EPS * 30)
        assert line["sum"] == pytest.approx(
            line["gravity"] + line["Coriolis"] + line["centrifugal"], abs=64 * EPS * 100
        )
        # about the line of nodes gravity turns the axle down
        assert line["gravity"] == pytest.approx(3.0 * math.sin(state.euler_angles.theta))


def test_a_colour_is_red_green_and_blue(tab):
    found = call(tab, "scene/colors", [["readColor", "#0033ff"], ["readColor", "#cc9966"]])
    assert found == [[0.0, 0.2, 1.0], [0.8, 0.6, 0.4]]


# A label at a point next to a ball, by a camera that looks along y: px are units of the world.
PLACE = """async ([places, radius]) => {
  const { Labels } = await import("/scene/labels.js");
  document.body.innerHTML = "<ul id=legend></ul><div id=labels></div>";
  const camera = {
    size: { width: 600, height: 400 },
    project: ([x, , z]) => ({ x, y: 200 - z, depth: 1 }),
  };
  const labels = new Labels(document.getElementById("labels"), camera);
  return places.map(([x, z]) => {
    labels.begin();
    labels.keepFree([300, 0, 0], radius);
    labels.put("name", "#000000", [x, 0, z], null, "a label of some words", 4);
    labels.end();
    const { label } = labels.names.name;
    const [left, up] = label.style.transform.match(/-?[\\d.]+(?=px)/g).map(Number);
    return [left, up, label.offsetWidth, label.offsetHeight];
  });
}"""


def test_a_label_leaves_the_ball_free(tab):
    radius = 20
    places = [(x, z) for x in range(180, 321, 20) for z in range(-40, 41, 8)]
    for x, y, width, height in tab.evaluate(PLACE, [places, radius]):
        assert width > 10
        across, high = abs(x - 300) - (width / 2 + radius), abs(y - 200) - (height / 2 + radius)
        assert max(across, high) >= -0.1, (x, y)
