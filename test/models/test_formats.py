"""Models of the top in other engines: the inertia that they read, and the motion that follows."""

import math
import re

import numpy as np
import pytest

from symtop_ros.models.formats import FORMATS, format_mjcf, format_sdf, format_urdf
from symtop_ros.physics import Motion, State, Top
from symtop_ros.simulation.initial import initial_state
from symtop_ros.simulation.settings import Settings

SCENES = ["cusps", "fast_precession", "perry_fails", "disc", "free", "hanging"]
DURATION = 1.0  # s


def read_scene(name):
    settings = Settings.from_scene(name)
    return settings.top, initial_state(settings.top, settings.initial, {})


def angle(q, p):
    """Angle in rad between two attitudes."""
    return 2 * min(np.linalg.norm(q - p), np.linalg.norm(q + p))


@pytest.mark.parametrize("scene", SCENES)
def test_mujoco_reads_the_inertia_and_follows_the_closed_form(scene):
    mujoco = pytest.importorskip("mujoco")
    top, start = read_scene(scene)
    model = mujoco.MjModel.from_xml_string(format_mjcf(top, start))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    mujoco.mj_forward(model, data)
    # The inertia about the pivot, as MuJoCo has it. 1e-12 is asked for; 1e-15 is found.
    inertia = np.zeros((3, 3))
    mujoco.mj_fullM(model, data, inertia)
    assert inertia == pytest.approx(
        np.diag([top.Ix, top.Ix, top.Iz]), rel=1e-12, abs=1e-12 * top.Ix
    )
    mass, arm = model.body("top").mass[0], model.body("top").ipos[2]
    assert -model.opt.gravity[2] * mass * arm == pytest.approx(top.Mgl, rel=1e-12, abs=0)
    model.opt.timestep = 2.0**-14
    mujoco.mj_step(model, data, nstep=int(DURATION * 2**14))
    # RK4 at 200 rad/s with steps of 0.012 rad; 1e-6 is asked for, at most 2e-7 is found.
    assert angle(data.qpos, Motion(top, start).at(DURATION).orientation) < 1e-6


@pytest.mark.parametrize("scene", SCENES)
def test_pinocchio_reads_the_inertia_and_follows_the_closed_form(scene):
    pinocchio = pytest.importorskip("pinocchio")
    top, start = read_scene(scene)
    model = pinocchio.buildModelFromXML(format_urdf(top, start))
    data = model.createData()
    about_pivot = model.inertias[model.njoints - 1].matrix()[3:, 3:]
    assert about_pivot == pytest.approx(
        np.diag([top.Ix, top.Ix, top.Iz]), rel=1e-12, abs=1e-12 * top.Ix
    )
    q = pinocchio.neutral(model)
    for k, value in enumerate(start.euler_angles):
        q[2 * k : 2 * k + 2] = math.cos(value), math.sin(value)  # continuous joints
    v, step = np.array(start.euler_rates), 2.0**-11

    def slope(q, v):
        return pinocchio.aba(model, data, q, v, np.zeros(3))

    for _ in range(int(DURATION / step)):
        a1 = slope(q, v)
        v2, q2 = v + a1 * step / 2, pinocchio.integrate(model, q, v * step / 2)
        a2 = slope(q2, v2)
        v3, q3 = v + a2 * step / 2, pinocchio.integrate(model, q, v2 * step / 2)
        a3 = slope(q3, v3)
        v4, q4 = v + a3 * step, pinocchio.integrate(model, q, v3 * step)
        a4 = slope(q4, v4)
        q = pinocchio.integrate(model, q, (v + 2 * v2 + 2 * v3 + v4) * step / 6)
        v = v + (a1 + 2 * a2 + 2 * a3 + a4) * step / 6
    pinocchio.framesForwardKinematics(model, data, q)
    rotation = data.oMf[model.getFrameId("top")].rotation
    x, y, z, w = pinocchio.Quaternion(rotation).coeffs()
    # RK4 in Euler angles, which are slow although the top is fast; at most 3e-9 is found.
    assert angle(np.array((w, x, y, z)), Motion(top, start).at(DURATION).orientation) < 1e-6


@pytest.mark.parametrize("scene", SCENES)
def test_drake_reads_the_inertia_and_the_start(scene, tmp_path):
    parsing = pytest.importorskip("pydrake.multibody.parsing")
    plants = pytest.importorskip("pydrake.multibody.plant")
    top, start = read_scene(scene)
    plant = plants.MultibodyPlant(time_step=0.0)
    parsing.Parser(plant).AddModelsFromString(format_sdf(top, start), "sdf")
    plant.Finalize()
    context = plant.CreateDefaultContext()
    body = plant.GetBodyByName("top")
    inertia = body.CalcSpatialInertiaInBodyFrame(context).CalcRotationalInertia()
    assert inertia.get_moments() == pytest.approx([top.Ix, top.Ix, top.Iz], rel=1e-12)
    rotation = body.EvalPoseInWorld(context).rotation().matrix()
    assert rotation @ [0, 0, 1] == pytest.approx(start.to_world([0, 0, 1]), abs=1e-12)
    assert plant.gravity_field().gravity_vector()[2] == -9.81


@pytest.mark.parametrize("form", sorted(FORMATS))
def test_a_top_without_a_body_is_refused(form):
    with pytest.raises(ValueError, match="Iz must be < 2 Ix = 2 kg m\\^2 for a body"):
        FORMATS[form](Top(1.0, 2.0, 1.0), State.from_euler(theta=0.5), 9.81)


@pytest.mark.parametrize("form", sorted(FORMATS))
def test_the_file_says_which_body_was_chosen(form):
    text = FORMATS[form](*read_scene("cusps"), 9.81)
    assert "half of the longest arm that a rigid body can have" in text
    assert "0.481931 kg, 0.0143832 m" in text


def test_sdf_and_urdf_say_how_the_motion_starts():
    top, start = read_scene("cusps")
    (line,) = re.findall("angular velocity (.+) rad/s \\(world frame\\)", format_sdf(top, start))
    assert list(map(float, line.split())) == start.to_world(start.angular_velocity).tolist()
    (place, rate) = re.findall("position (.+) rad, velocity (.+) rad/s", format_urdf(top, start))[0]
    assert list(map(float, place.split())) == list(start.euler_angles)
    assert list(map(float, rate.split())) == list(start.euler_rates)
