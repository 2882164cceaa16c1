"""What one sees of the scene: the top has its colours, and arrows end where the vectors do."""

import json
import math

import numpy as np
import pytest
from page.web.opened import FEW_FRAMES, read_motion

# The camera of a motion below 1.1 rad, its angle of view, and lengths of arrows: of a vector at the
# start, and of the largest torque.
EYE, TARGET = np.array([1.46, -1.7, 0.95]), np.array([0.0, 0.0, 0.33])
ANGLE = math.radians(42)
LENGTHS = {"L": 1.14, "omega": 1.13, "torque": 0.55}
# px of each colour in a scene of some 600 x 500: the rotor fills a part of it, an arrow a line.
LEAST = {"enamel": 1000, "brass": 300, "ball": 300, "L": 100, "omega": 100, "torque": 20}
RADIUS = 5  # px


def project(point, box):
    """The place in px of a point of the world: a pinhole at the eye, with the world's z upwards."""
    forward = (TARGET - EYE) / np.linalg.norm(TARGET - EYE)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    seen = np.asarray(point) - EYE
    depth, size = seen @ forward, box["height"] / (2 * math.tan(ANGLE / 2))
    x, y = (size * (seen @ axis) / depth for axis in (right, up))
    return [box["width"] / 2 + x, box["height"] / 2 - y]


def find_tips(motion, time, start_of_run):
    """The ends of the arrows, and of the axis, in scene units."""
    top, begin, state = motion.top, start_of_run, motion.at(time)
    vectors = {
        "L": top.angular_momentum,
        "omega": lambda each: each.to_world(each.angular_velocity),
        "torque": motion.total_torque,
    }
    sizes = {name: np.linalg.norm(find(begin)) for name, find in vectors.items()}
    sizes["torque"] = abs(top.Mgl)
    tips = {name: LENGTHS[name] * find(state) / sizes[name] for name, find in vectors.items()}
    return tips | {"ball": state.to_world((0.0, 0.0, 1.0))}


@pytest.mark.slow
@pytest.mark.parametrize(
    "fragment",
    ["#theta=0.9&psi_dot=150&phi_dot=12", "#theta=0.6&psi_dot=250&phi_dot=-3&Mgl=0.05&phi=-0.7"],
)
def test_the_top_has_its_colours_and_each_arrow_ends_where_its_vector_does(open_page, fragment):
    # Who wants less motion gets the start at rest, and so always the same picture.
    page = open_page(fragment, script=FEW_FRAMES, reduced_motion="reduce")
    page.show_arrows("torque", "L", "omega")
    page.wait_for_frames(3)
    motion = read_motion(page.read_events()[-1])
    time = float(page.tab.get_attribute("body", "data-time"))
    box = page.tab.locator("#picture").bounding_box()
    tips = find_tips(motion, time, motion.start)
    # The head is there up to its tip; the middle of the ball is that of the axis' end.
    inside = {name: tip * (1.0 if name == "ball" else 0.97) for name, tip in tips.items()}
    places = {name: project(tip, box) for name, tip in inside.items()}
    seen = page.tab.evaluate("looks.nameColors", {"places": places, "radius": RADIUS})
    for name, least in LEAST.items():
        assert seen["counts"][name] >= least, (name, seen["counts"])
    for name, found in seen["near"].items():
        assert name in found, (name, found, places)


def test_all_triangles_of_the_top_and_its_stand_have_areas_and_face_outwards(tab):
    for call in ("createBody({Ix: 1, Iz: 0.5, Mgl: 1})", "createStand()", "createBall([1, 1, 1])"):
        numbers = tab.evaluate(
            """async (call) => {
                const meshes = await import("/scene/meshes.js");
                const mesh = new Function("meshes", `return meshes.${call}`)(meshes);
                return JSON.stringify([...mesh]);
            }""",
            call,
        )
        corners = np.array(json.loads(numbers)).reshape(-1, 3, 9)
        places, normals = corners[..., :3], corners[..., 3:6]
        faces = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
        areas = np.linalg.norm(faces, axis=1)
        has_area = areas > 1e-9  # at a tip one of the two triangles of a facet has none
        assert has_area.mean() > 0.8, call
        outwards = (faces * normals.sum(axis=1)).sum(axis=1)[has_area]
        assert (outwards > 0).all() or (outwards < 0).all(), call
