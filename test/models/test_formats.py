"""Models of the top in other engines: the inertia that they read, and the motion that follows."""

import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from symtop_ros.models.formats import FORMATS
from symtop_ros.models.urdf import MUJOCO_BOUND
from symtop_ros.physics import Body, Motion, State, Top
from symtop_ros.simulation.changes.initial import initial_state
from symtop_ros.simulation.settings import Settings

SCENES = ["cusps", "fast_precession", "perry_fails", "disc", "free", "hanging"]
DURATION = 1.0  # s


def read_scene(name):
    settings = Settings.from_scene(name)
    return settings.top, initial_state(settings.top, settings.initial, {})


def write(form, top, start):
    return FORMATS[form](top, start, Body.of(top))


def angle(q, p):
    """Angle in rad between two attitudes."""
    return 2 * min(np.linalg.norm(q - p), np.linalg.norm(q + p))


@pytest.mark.parametrize("scene", SCENES)
def test_mujoco_reads_the_inertia_and_follows_the_closed_form(scene):
    mujoco = pytest.importorskip("mujoco")
    top, start = read_scene(scene)
    model = mujoco.MjModel.from_xml_string(write("mjcf", top, start))
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
    model = pinocchio.buildModelFromXML(write("urdf", top, start))
    data = model.createData()
    about_pivot = model.inertias[model.njoints - 1].matrix()[3:, 3:]
    assert about_pivot == pytest.approx(
        np.diag([top.Ix, top.Ix, top.Iz]), rel=1e-12, abs=1e-12 * top.Ix
    )

    def turned(angles):
        """The configuration of continuous joints: cosines and sines."""
        return np.ravel(np.transpose((np.cos(angles), np.sin(angles))))

    def slope(_, y):
        acceleration = pinocchio.aba(model, data, turned(y[:3]), y[3:], np.zeros(3))
        return np.concatenate((y[3:], acceleration))

    begin = (*start.euler_angles, *start.euler_rates)
    found = solve_ivp(slope, (0.0, DURATION), begin, "DOP853", rtol=1e-11, atol=1e-11)
    pinocchio.framesForwardKinematics(model, data, turned(found.y[:3, -1]))
    rotation = data.oMf[model.getFrameId("top")].rotation
    x, y, z, w = pinocchio.Quaternion(rotation).coeffs()
    # 1e-6 is asked for, at most 2e-11 is found
    assert angle(np.array((w, x, y, z)), Motion(top, start).at(DURATION).orientation) < 1e-6


# Of these scenes none is so near to the vertical, or so small, that the links count.
@pytest.mark.parametrize("scene", SCENES)
def test_the_urdf_moves_in_mujoco_as_the_top_does(scene):
    mujoco = pytest.importorskip("mujoco")
    top, start = read_scene(scene)
    model = mujoco.MjModel.from_xml_string(write("urdf", top, start))
    assert model.body("top_tilt").mass == MUJOCO_BOUND
    model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, 2.0**-13
    data = mujoco.MjData(model)
    data.qpos, data.qvel = start.euler_angles, start.euler_rates
    mujoco.mj_step(model, data, nstep=int(DURATION * 2**13))
    mujoco.mj_kinematics(model, data)
    # RK4 with an eighth of a millisecond; at most 1.7e-9 is found
    assert angle(data.body("top").xquat, Motion(top, start).at(DURATION).orientation) < 1e-8


@pytest.mark.parametrize("form", sorted(FORMATS))
def test_the_file_says_which_body_it_holds(form):
    assert "0.481931 kg, 0.0143832 m" in write(form, *read_scene("cusps"))
    top, start = Top(15.234375, 0.46875, 147.15), State.from_euler(theta=1.0)
    text = FORMATS[form](top, start, Body(15.0, 1.0, 0.234375, 0.46875, 9.81))
    assert "15 kg, 1 m" in text


def test_sdf_and_urdf_say_how_the_motion_starts():
    top, start = read_scene("cusps")
    found = re.findall("(\\S+ \\S+ \\S+) rad/s", write("sdf", top, start))
    local, world = (list(map(float, each.split())) for each in found)
    assert local == start.angular_velocity.tolist()
    assert world == start.to_world(start.angular_velocity).tolist()
    (place, rate) = re.findall("position (.+) rad, velocity (.+) rad/s", write("urdf", top, start))[
        0
    ]
    assert list(map(float, place.split())) == list(start.euler_angles)
    assert list(map(float, rate.split())) == list(start.euler_rates)
