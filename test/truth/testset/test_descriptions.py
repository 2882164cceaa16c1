"""Equivalent descriptions of a body: the same motion in each, and scores in its frame."""

import numpy as np
import pytest
from mpmath import mp, mpf
from physics.tops import EPS
from trials import choose
from truth.testset.model_files import DIGITS, read_model, rotation

from symtop_ros.run.models import FORMATS, FREE_FORMATS, name_file
from symtop_ros.run.models.descriptions import describe
from symtop_ros.truth.testset.score import (
    FORMED,
    FORMS,
    find_problem,
    list_descriptions,
    read_problems,
)
from workshop.testset.problems import SETTINGS

PROBLEMS = read_problems()


def find_models(folder, name):
    """Yield the paths of the models of a problem, each with its description."""
    for description in ("", *list_descriptions(name)):
        named = ".".join(filter(None, (name, description)))
        for form in (*FORMATS, *FREE_FORMATS):
            path = folder / "models" / name_file(named, form)
            if path.exists():
                yield path, named


@pytest.mark.parametrize("name", choose([*PROBLEMS][::2], [FORMED, *[*PROBLEMS][::8]]))
def test_each_model_has_the_body_and_the_start_of_its_problem(name, folder):
    facts = PROBLEMS[name].facts
    # sums of a few products of rounded numbers
    size = max(facts["Ix"], facts["Iz"])
    rounding = 8 * EPS
    arm = mp.sqrt(size * facts["mass"])  # a length, times the mass
    with mp.workdps(DIGITS):
        start = rotation([mpf(each) for each in facts["orientation"]])
        moments = start * mp.diag([facts["Ix"], facts["Ix"], facts["Iz"]]) * start.T
        centre = start * mp.matrix([0, 0, facts["mass"] * mpf(facts["arm"])])
        rates = start * mp.matrix(facts["angular_velocity"])
        first = rotation([mpf(each) for each in facts["orientations"][0]])
        for path, named in find_models(folder, name):
            if path.suffix == ".mjcf" and named.removeprefix(f"{name}.") in FORMS:
                continue  # MuJoCo reads them: test_importers.py
            body = read_model(path)
            scored = find_problem(PROBLEMS, named).facts
            frame = body.frame
            assert body.mass == pytest.approx(facts["mass"], rel=rounding)
            off = frame * body.moments * frame.T - moments
            assert mp.mnorm(off) < rounding * size, path.name
            assert mp.norm(frame * body.weighted - centre) < rounding * arm, path.name
            turning = frame * body.angular_velocity - rates
            assert mp.norm(turning) <= rounding * mp.norm(rates), path.name
            # the frame of the model is that in which its states are scored
            own = rotation([mpf(each) for each in scored["orientations"][0]])
            assert mp.mnorm(start.T * frame - first.T * own) < rounding, path.name


@pytest.mark.long  # 0.4 GB to fetch; MuJoCo reads the same bodies
@pytest.mark.parametrize("name", ["cusps", "free_rod_fast", "flat_disc"])
def test_pinocchio_has_the_same_body_from_each_urdf(name, folder):
    pinocchio = pytest.importorskip("pinocchio")
    angles = np.array([0.25, 0.75, 1.5])
    found = []
    for path, _ in find_models(folder, name):
        if path.suffix == ".urdf" and ".free." not in path.name:
            model = pinocchio.buildModelFromXML(path.read_text())
            q = pinocchio.integrate(model, pinocchio.neutral(model), angles)
            found.append(pinocchio.crba(model, model.createData(), q))
    assert len(found) == (7 if name == FORMED else 5)  # two forms are URDF
    # a dozen products, in other orders
    same = pytest.approx(found[0], rel=1e-13, abs=1e-15 * found[0].max())
    assert found[1:] == [same] * (len(found) - 1)


@pytest.mark.parametrize("name", ["gentle_cusps", "gentle_free"])
def test_mujoco_is_scored_alike_in_every_description(name, folder):
    mujoco = pytest.importorskip("mujoco")
    errors = []
    for path, named in find_models(folder, name):
        if path.suffix == ".mjcf":
            problem = find_problem(PROBLEMS, named)
            model = mujoco.MjModel.from_xml_path(str(path))
            data = mujoco.MjData(model)
            mujoco.mj_resetDataKeyframe(model, data, 0)
            model.opt.timestep = problem.times[0] / 64
            states = []
            for _ in problem.times:
                mujoco.mj_step(model, data, nstep=64)
                states.append([*data.qpos[-4:], *data.qvel[-3:]])
            score = problem.score(*np.split(np.array(states), [4], axis=1))
            errors.append(score.angles.max())
    # RK4 with steps of 0.016 rad; its errors are the same but for the rounding of 1280 steps
    assert max(errors) < 1e-6
    assert max(errors) - min(errors) < 1e-12


def test_a_frame_is_moved_with_the_size_of_the_body():
    body = PROBLEMS["cusps"].facts
    assert body["arm"] < 0.02
    (setting,) = (each for each in SETTINGS if each.name == "cusps")
    assert 0.005 < max(map(abs, describe("offset", setting.body).pivot)) < 0.05
