"""The start of a problem as Python for engines: attitude, angular velocity and acceleration."""

import re

import numpy as np
import pytest

from symtop_ros.judge.main import main
from symtop_ros.physics import State
from symtop_ros.testset.score import read_problems

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


def find_blocks(folder):
    return re.findall("```python\n(.*?)```", (folder / "README.md").read_text(), re.DOTALL)


@pytest.mark.parametrize("name", PROBLEMS)
@pytest.mark.parametrize("engine", MEASURE)
def test_the_snippet_starts_the_engine_as_the_problem_starts(engine, name, tmp_path, monkeypatch):
    pytest.importorskip(engine)
    assert main(["--testset", name, "-o", str(tmp_path)]) == 0
    code = next(each for each in find_blocks(tmp_path) if engine in each)
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(code, names)
    matrix, rate, acceleration = MEASURE[engine](names)
    facts = read_problems()[name].facts
    start = State(facts["orientation"], facts["angular_velocity"])
    # doubles: 2e-15 are found
    assert matrix == pytest.approx(start.matrix, abs=1e-14)
    assert rate == pytest.approx(
        start.to_world(start.angular_velocity), abs=1e-13 * np.abs(start.angular_velocity).max()
    )
    exact = start.to_world([float(x) for x in facts["angular_accelerations"][0]])
    # sums of moments times rates squared, some hundred times the result
    assert acceleration == pytest.approx(exact, abs=1e-12 * np.abs(exact).max())


def test_the_trajectory_of_mujoco_is_scored(tmp_path, monkeypatch, capsys):
    pytest.importorskip("mujoco")
    assert main(["--testset", "plane_pendulum", "-o", str(tmp_path)]) == 0
    monkeypatch.chdir(tmp_path)
    # a sixteenth of the steps: RK4 with 1 ms and a slow pendulum
    exec("".join(find_blocks(tmp_path)[:2]).replace("16384", "1024"), {})
    assert main(["--testset", "plane_pendulum", "trajectory.csv", "--max-error", "1e-9"]) == 0
    # every file that the README names is there
    text = (tmp_path / "README.md").read_text()
    assert "problems.json" not in text
    assert "](.." not in text
