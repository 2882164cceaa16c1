"""The start of a problem as Python for engines: attitude, angular velocity and acceleration."""

import re

import numpy as np
import pytest
from documents import blocks

from symtop_ros.physics import State
from symtop_ros.truth.testset.main import main
from symtop_ros.truth.testset.score import read_problems

PROBLEMS = ("nodding", "low", "heavy_top", "small")


def measure_mujoco(names):
    data, model = names["data"], names["model"]
    matrix = data.body("top").xmat.reshape(3, 3)
    velocity = np.zeros(6)
    kind = names["mujoco"].mjtObj.mjOBJ_BODY
    names["mujoco"].mj_objectVelocity(model, data, kind, model.body("top").id, velocity, 0)
    return matrix, velocity[:3], matrix @ data.qacc


def measure_pinocchio(names):
    pinocchio, model, q, v = (names[each] for each in ("pinocchio", "model", "q", "v"))
    data = model.createData()
    acceleration = pinocchio.aba(model, data, q, v, np.zeros(3))
    pinocchio.forwardKinematics(model, data, q, v)
    matrix = data.oMi[1].rotation
    return matrix, matrix @ data.v[1].angular, matrix @ acceleration


MEASURE = {"mujoco": measure_mujoco, "pinocchio": measure_pinocchio}


@pytest.mark.long  # 0.3 GB to fetch
@pytest.mark.parametrize("name", PROBLEMS)
def test_newton_starts_as_the_problem_does_in_single_precision(name, tmp_path, monkeypatch):
    pytest.importorskip("newton")
    assert main([name, "-o", str(tmp_path)]) == 0
    code = next(code for code, _ in blocks(tmp_path / "README.md", "python") if "add_mjcf" in code)
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(code, names)
    facts = read_problems()[name].facts
    start = State(facts["orientation"], facts["angular_velocity"])
    *_, x, y, z, w = names["state"].body_q.numpy()[0]
    rates = names["state"].body_qd.numpy()[0][3:]
    assert abs(start.orientation @ [w, x, y, z]) > 1 - 1e-6
    omega = start.to_world(start.angular_velocity)
    assert rates == pytest.approx(omega, abs=1e-6 * np.abs(omega).max())


@pytest.mark.parametrize("name", PROBLEMS)
@pytest.mark.parametrize("engine", ["mujoco", pytest.param("pinocchio", marks=pytest.mark.long)])
def test_the_snippet_starts_the_engine_as_the_problem_starts(engine, name, tmp_path, monkeypatch):
    pytest.importorskip(engine)
    assert main([name, "-o", str(tmp_path)]) == 0
    code = next(code for code, _ in blocks(tmp_path / "README.md", "python") if engine in code)
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(code, names)
    matrix, rate, acceleration = MEASURE[engine](names)
    facts = read_problems()[name].facts
    start = State(facts["orientation"], facts["angular_velocity"])
    # doubles: 2e-15 are found
    assert matrix == pytest.approx(start.matrix, abs=1e-14)
    omega = start.to_world(start.angular_velocity)
    assert rate == pytest.approx(omega, abs=1e-13 * np.abs(start.angular_velocity).max())
    exact = start.to_world([float(x) for x in facts["angular_accelerations"][0]])
    # sums of moments times rates squared, some hundred times the result
    assert acceleration == pytest.approx(exact, abs=1e-12 * np.abs(exact).max())


ENGINES = ("bullet", "rapier", "jolt", "physx", "havok", "dart")


def copy_problem(name, folder):
    """Copy a problem; return its programs by their engines."""
    assert main([name, "-o", str(folder)]) == 0
    _, _, text = (folder / "README.md").read_text().partition("## Start in Bullet")
    found = re.findall(r"```(?:cpp|js|python)\n(.*?)```", text, re.DOTALL)[: len(ENGINES)]
    return dict(zip(ENGINES, found, strict=True))


@pytest.mark.parametrize("name", ["cusps", "nodding", "heavy_top", "small", "gentle_free"])
def test_the_programs_have_the_numbers_of_the_table(name, tmp_path):
    programs = copy_problem(name, tmp_path)
    head, row, *_ = (tmp_path / "world.csv").read_text().splitlines()
    exact = dict(zip(head.split(","), row.split(","), strict=True))

    def wanted(*columns):
        # sums and products of doubles: 2e-15 of the largest component
        numbers = [float(exact[each]) for each in columns]
        return pytest.approx(numbers, abs=4e-15 * max(map(abs, numbers)))

    for engine, pattern, columns in (
        ("bullet", r"attitude\((.*)\);", "x y z w"),
        ("bullet", r"btTransform\(attitude, btVector3\((.*)\)\)\);", "px py pz"),
        ("bullet", r"setLinearVelocity\(btVector3\((.*)\)\)", "vx vy vz"),
        ("bullet", r"setAngularVelocity\(btVector3\((.*)\)\)", "omega_x omega_y omega_z"),
        ("rapier", r"setLinvel\((.*)\) //", "vx vy vz"),
        ("rapier", r"setAngvel\(vector\((.*)\)\)", "omega_x omega_y omega_z"),
        ("jolt", r"Quat\((.*)\)\.Norm", "x y z w"),
        ("jolt", r"mLinearVelocity = new Jolt.Vec3\((.*)\)", "vx vy vz"),
        ("jolt", r"mAngularVelocity = new Jolt.Vec3\((.*)\)", "omega_x omega_y omega_z"),
        ("physx", r"Math.hypot\((.*)\)", "x y z w"),
        ("physx", r"setLinearVelocity\(vector\((.*)\)\);", "vx vy vz"),
        ("physx", r"setAngularVelocity\(vector\((.*)\)\)", "omega_x omega_y omega_z"),
        ("havok", r"\[\[0, 0, 0\], \[(.*)\]\]", "x y z w"),
        ("havok", r"SetLinearVelocity\(top, \[(.*)\]\)", "vx vy vz"),
        ("havok", r"SetAngularVelocity\(top, \[(.*)\]\)", "omega_x omega_y omega_z"),
        ("dart", r"Quaternion\(([^b)]*)\)\n", "w x y z"),
    ):
        found = re.search(pattern, programs[engine])[1]
        assert list(map(float, found.split(", "))) == wanted(*columns.split()), (engine, pattern)


def test_a_body_without_weight_is_held_by_nothing(tmp_path):
    for name, is_held in (("gentle_cusps", True), ("gentle_free", False)):
        programs = copy_problem(name, tmp_path / name)
        for engine in ENGINES[:-1]:
            assert ("pivot" in programs[engine]) == is_held
        assert (tmp_path / name / f"{name}.free.mjcf").exists() != is_held
        text = (tmp_path / name / "README.md").read_text()
        assert (f"{name}.free.mjcf" in text) != is_held
