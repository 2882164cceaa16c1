"""Models of the top in other engines: the inertia that they read, and the motion that follows."""

import importlib
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from physics.tops import ARTICLE

from symtop_ros.physics import Body, Motion
from symtop_ros.run.models import FORMATS, FREE_FORMATS, name_file
from symtop_ros.run.models.descriptions import PLAIN, describe
from symtop_ros.run.models.main import main
from symtop_ros.run.models.urdf import MUJOCO_BOUND, robot_description
from symtop_ros.run.simulation.changes.requests import initial_state
from symtop_ros.run.simulation.presets import scene_names
from symtop_ros.run.simulation.settings import Settings

SCENES = ["cusps", "fast_precession", "perry_fails", "disc", "free", "hanging"]
DURATION = 1.0  # s
DESCRIPTIONS = "", "turned", "offset", "nested_half"


def read_scene(name):
    settings = Settings.from_scene(name)
    return settings.top, initial_state(settings.top, settings.initial, {})


def write(form, top, start):
    return FORMATS[form](top, start, Body.from_top(top))


def open_in_mujoco(form, scene):
    """The module, a top, its start, and the model and data that it makes of a description."""
    mujoco = pytest.importorskip("mujoco")
    top, start = read_scene(scene)
    model = mujoco.MjModel.from_xml_string(write(form, top, start))
    return mujoco, top, start, model, mujoco.MjData(model)


def angle(q, p):
    """Angle in rad between two attitudes."""
    return 2 * min(np.linalg.norm(q - p), np.linalg.norm(q + p))


@pytest.mark.parametrize("scene", SCENES)
def test_mujoco_reads_the_inertia_and_follows_the_closed_form(scene):
    mujoco, top, start, model, data = open_in_mujoco("mjcf", scene)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    mujoco.mj_forward(model, data)
    # The inertia about the pivot, as MuJoCo has it. 1e-12 is asked for; 1e-15 is found.
    inertia = np.zeros((3, 3))
    mujoco.mj_fullM(model, data, inertia)
    exact = np.diag([top.Ix, top.Ix, top.Iz])
    assert inertia == pytest.approx(exact, rel=1e-12, abs=1e-12 * top.Ix)
    mass, arm = model.body("top").mass[0], model.body("top").ipos[2]
    assert -model.opt.gravity[2] * mass * arm == pytest.approx(top.Mgl, rel=1e-12, abs=0)
    model.opt.timestep = 2.0**-14
    mujoco.mj_step(model, data, nstep=int(DURATION * 2**14))
    # RK4 at 200 rad/s with steps of 0.012 rad; 1e-6 is asked for, at most 2e-7 is found.
    assert angle(data.qpos, Motion(top, start).at(DURATION).orientation) < 1e-6


# Of these scenes none is so near to the vertical, or so small, that the links count.
@pytest.mark.parametrize("scene", SCENES)
def test_the_urdf_moves_in_mujoco_as_the_top_does(scene):
    mujoco, top, start, model, data = open_in_mujoco("urdf", scene)
    assert model.body("top_tilt").mass == MUJOCO_BOUND
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.timestep = 2.0**-13
    data.qpos, data.qvel = start.euler_angles, start.euler_rates
    mujoco.mj_step(model, data, nstep=int(DURATION * 2**13))
    mujoco.mj_kinematics(model, data)
    # RK4 with an eighth of a millisecond; at most 1.7e-9 is found
    assert angle(data.body("top").xquat, Motion(top, start).at(DURATION).orientation) < 1e-8


def test_sdf_and_urdf_say_how_the_motion_starts():
    top, start = read_scene("cusps")
    found = re.findall("(\\S+ \\S+ \\S+) rad/s", write("sdf", top, start))
    local, world = (list(map(float, each.split())) for each in found)
    assert local == start.angular_velocity.tolist()
    assert world == start.to_world(start.angular_velocity).tolist()
    found = re.search("position (.+) rad, velocity (.+) rad/s", write("urdf", top, start))
    place, rate = found.groups()
    assert list(map(float, place.split())) == list(start.euler_angles)
    assert list(map(float, rate.split())) == list(start.euler_rates)


@pytest.mark.parametrize("form", sorted(FORMATS))
def test_every_scene_can_be_written(form, tmp_path):
    for scene in scene_names():
        path = tmp_path / f"{scene}.{form}"
        assert main(["--format", form, "--scene", scene, "-o", str(path)]) == 0
        if form == "usd":
            assert path.read_text().startswith("#usda 1.0\n(\n")
        else:
            assert ElementTree.parse(path).getroot().tag in ("robot", "sdf", "mujoco")


def test_the_model_goes_to_standard_output_and_what_it_leaves_out_is_told(capsys):
    assert main(["--format", "mjcf", "--scene", "friction"]) == 0
    printed = capsys.readouterr()
    assert printed.out.endswith("</mujoco>\n")
    assert printed.err == "top_model: left out: friction\n"


MOVERS = [(True, True), (True, False), (False, True)]
FRAMES = [("world", "top"), ("map", "a/top"), ('w"&<', "gyro's")]


@pytest.mark.parametrize(("world", "top"), FRAMES)
@pytest.mark.parametrize(("with_tf", "with_state_publisher"), MOVERS)
def test_the_body_hangs_from_the_world(world, top, with_tf, with_state_publisher):
    text = robot_description(ARTICLE, world, top, tf_moves_it=with_tf)
    robot = ElementTree.fromstring(text)
    parents = {top: world} if with_tf else {}
    (body,) = robot.iterfind("link[visual]")
    for joint in robot.iterfind("joint") if with_state_publisher else ():
        if joint.get("type") != "floating":  # robot_state_publisher leaves these out
            parents[joint.find("child").get("link")] = joint.find("parent").get("link")
    frame = body.get("name")
    assert frame == top
    while frame in parents:
        frame = parents[frame]
    assert frame == world


@pytest.mark.long  # 28 MB to fetch
@pytest.mark.parametrize("name", DESCRIPTIONS)
def test_usd_core_validates_every_stage_and_reads_its_numbers(name, tmp_path):
    pxr = pytest.importorskip("pxr")
    importlib.import_module("pxr.UsdPhysics")
    validation = importlib.import_module("pxr.UsdValidation")
    validators = validation.ValidationRegistry().GetOrLoadAllValidators()
    for scene in SCENES:
        top, start = read_scene(scene)
        body = Body.from_top(top)
        described = describe(name, body) if name else PLAIN
        for form in ("usd", "free.usd"):
            write = {**FORMATS, **FREE_FORMATS}[form]
            path = tmp_path / name_file(f"{scene}.{name}", form)
            path.write_text(write(top, start, body, described))
            stage = pxr.Usd.Stage.Open(str(path))
            found = validation.ValidationContext(validators).Validate(stage)
            assert [each.GetMessage() for each in found] == []
            link = stage.GetPrimAtPath("/World/start_top/top")
            (mass,) = [link.GetAttribute("physics:mass").Get()]
            assert mass == np.float32(described.link(body).mass)
            assert link.HasAPI(pxr.UsdPhysics.RigidBodyAPI)
            assert stage.GetPrimAtPath("/World/pivot").IsValid() == (form == "usd")
