"""Equivalent descriptions of a body: the same motion in each, and scores in its frame."""

import numpy as np
import pytest
from mpmath import mp, mpf
from testset.model_files import DIGITS, read_model
from testset.rigid_body import integrate

from symtop_ros.models import UNSAID
from symtop_ros.models.descriptions import TURN as OF_MODELS
from symtop_ros.models.descriptions import describe
from symtop_ros.physics import STANDARD_GRAVITY
from symtop_ros.testset.score import DESCRIPTIONS, find_problem, main, read_problems
from symtop_ros.testset.tables import TURN
from workshop.testset.exact import distance
from workshop.testset.problems import SETTINGS

PROBLEMS = read_problems()
TRIED = (
    *("gentle_cusps", "gentle_looping", "gentle_fall", "gentle_pendulum", "gentle_hanging"),
    *("gentle_pole", "gentle_free", "spherical_pendulum", "sphere", "free_disc", "below"),
    *("free_rod_fast", *(pytest.param(name, marks=pytest.mark.long) for name in ("cusps", "low"))),
)
EPS = 2.0**-52


def find_models(folder, name):
    """Yield the paths of the models of a problem, each with its description."""
    for description in ("", *DESCRIPTIONS):
        named = ".".join(filter(None, (name, description)))
        for form in ("mjcf", "sdf", "urdf", "free.mjcf", "free.sdf", "free.urdf"):
            path = folder / "models" / f"{named}.{form}"
            if path.exists():
                yield path, named


@pytest.mark.parametrize("name", TRIED)
def test_each_mjcf_has_the_exact_motion_of_its_problem_in_its_frame(name, folder):
    tried = [each for each in find_models(folder, name) if each[0].suffix == ".mjcf"]
    assert len(tried) == (5 if PROBLEMS[name].facts["Mgl"] else 10)
    for path, named in tried:
        facts, t = find_problem(PROBLEMS, named).facts, PROBLEMS[name].times[0]
        gravity = 0.0 if ".free." in path.name else STANDARD_GRAVITY
        q, omega = integrate(read_model(path), gravity, float(t))
        with mp.workdps(DIGITS):
            apart = distance(q, [mpf(each) for each in facts["orientations"][0]])
            rates = zip(omega, facts["angular_velocities"][0], strict=True)
            faster = mp.norm([a - mpf(b) for a, b in rates])
        # A limit is what half an ulp of each of ten inputs does, added in squares; here some twenty
        # numbers are rounded, of sizes up to twice those of the inputs.
        assert 2 * apart < 10**0.5 * facts["orientation_limits"][0], path.name
        assert faster < 10**0.5 * facts["angular_velocity_limits"][0], path.name


@pytest.mark.parametrize("name", [*PROBLEMS][::2])
def test_all_formats_say_the_same_of_a_body_and_its_start(name, folder):
    found = {}
    for path, named in find_models(folder, name):
        kind = (named, ".free." in path.name)
        found.setdefault(kind, []).append((path, read_model(path)))
    for each in found.values():
        (_, first), *others = each
        size = mp.mnorm(first.moments)
        for path, other in others:
            # sums of a few products of rounded numbers
            assert other.mass == first.mass
            assert mp.mnorm(other.moments - first.moments) < 4 * EPS * size, path.name
            largest = mp.sqrt(size * first.mass)  # mass times an arm
            assert mp.norm(other.weighted - first.weighted) < 4 * EPS * largest, path.name
            assert distance(other.orientation, first.orientation) < 4 * EPS, path.name
            rates = zip(other.angular_velocity, first.angular_velocity, strict=True)
            fastest = mp.norm(first.angular_velocity)
            assert mp.norm([a - b for a, b in rates]) <= 4 * EPS * fastest, path.name


def test_a_format_is_left_out_only_where_it_cannot_say_a_description(folder):
    names = {path.name for path in (folder / "models").iterdir()}
    for description, form in UNSAID:
        assert not [name for name in names if name.endswith(f".{description}.{form}")]
    forms = (("mjcf", 5), ("sdf", 4), ("urdf", 4))
    for form, count in forms:
        own = [name for name in names if name.startswith("cusps.") and name.endswith(f".{form}")]
        assert len(own) == count


def test_the_set_and_its_models_turn_a_frame_alike():
    assert tuple(map(float, TURN)) == tuple(map(float, OF_MODELS))


@pytest.mark.long  # 0.4 GB to fetch; MuJoCo reads the same bodies
@pytest.mark.parametrize("name", ["cusps", "free_rod_fast", "flat_disc"])
def test_pinocchio_has_the_same_body_from_each_urdf(name, folder):
    pinocchio = pytest.importorskip("pinocchio")
    angles, found = np.array([0.25, 0.75, 1.5]), []
    for path, _ in find_models(folder, name):
        if path.suffix == ".urdf" and ".free." not in path.name:
            model = pinocchio.buildModelFromXML(path.read_text())
            q = pinocchio.integrate(model, pinocchio.neutral(model), angles)
            found.append(pinocchio.crba(model, model.createData(), q))
    assert len(found) == 4
    # a dozen products, in other orders
    assert found[1:] == [pytest.approx(found[0], rel=1e-13, abs=1e-15 * found[0].max())] * 3


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
            assert score.mistakes == ()
            errors.append(score.angles.max())
    # RK4 with steps of 0.016 rad; its errors are the same but for the rounding of 1280 steps
    assert max(errors) < 1e-6
    assert max(errors) - min(errors) < 1e-12


def test_a_frame_is_moved_with_the_size_of_the_body():
    body = PROBLEMS["cusps"].facts
    assert body["arm"] < 0.02
    (setting,) = (each for each in SETTINGS if each.name == "cusps")
    assert 0.005 < max(map(abs, describe("offset", setting.body).pivot)) < 0.05


def test_a_description_that_is_none_is_refused(capsys):
    for name, reason in (
        ("cusps.bent", "description must be one of turned, offset, nested, nested_half, got bent"),
        ("cusps.", "description must be one of turned, offset, nested, nested_half, got \n"),
        ("tops.turned", "problem must be one of gentle_cusps, "),
    ):
        assert main([name]) == 1
        assert capsys.readouterr().err.startswith(reason.replace("\\n", "\n"))
