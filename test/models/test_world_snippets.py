"""The start of a problem in engines that hold bodies in the world: numbers, and whole programs."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from symtop_ros.judge.main import main
from symtop_ros.testset.score import read_problems, read_trajectory

PROBLEMS = ("gentle_cusps", "gentle_free")
# npm install @dimforge/rapier3d-compat jolt-physics, in the checkout
NODE_MODULES = Path(__file__).parents[2] / "node_modules"
# With 2560 steps a second: engines of first order, Rapier and Jolt in single precision.
LARGEST = {"bullet": 0.02, "rapier": 0.05, "jolt": 0.01, "dart": 5e-3}


def copy_problem(name, folder):
    """Copy a problem; return its programs by their engines."""
    assert main(["--testset", name, "-o", str(folder)]) == 0
    text = (folder / "README.md").read_text()
    text = text[text.index("## Start in Bullet") :]
    blocks = re.findall(r"```(?:cpp|js|python)\n(.*?)```", text, re.DOTALL)[:4]
    return dict(zip(LARGEST, blocks, strict=True))


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
        ("dart", r"Quaternion\(([^b)]*)\)\n", "w x y z"),
    ):
        found = re.search(pattern, programs[engine])[1]
        assert list(map(float, found.split(", "))) == wanted(*columns.split()), (engine, pattern)


def test_a_body_without_weight_is_held_by_nothing(tmp_path):
    for name, is_held in (("gentle_cusps", True), ("gentle_free", False)):
        programs = copy_problem(name, tmp_path / name)
        for engine in ("bullet", "rapier", "jolt"):
            assert ("pivot" in programs[engine]) == is_held
        assert (tmp_path / name / f"{name}.free.mjcf").exists() != is_held
        text = (tmp_path / name / "README.md").read_text()
        assert (f"{name}.free.mjcf" in text) != is_held


def compile_bullet(code, folder):
    status, flags = subprocess.getstatusoutput("pkg-config --cflags --libs bullet-float64")
    if status or not shutil.which("g++"):
        pytest.skip("no Bullet: apt install libbullet-dev pkg-config g++")
    (folder / "start.cpp").write_text(code)
    command = ["g++", "-O2", "-Wall", "-Wextra", "start.cpp", "-o", "start", *flags.split()]
    subprocess.run(command, cwd=folder, check=True)
    return ["./start"]


def prepare(engine, code, folder):
    """Write the program of an engine; return the command that runs it."""
    if engine == "bullet":
        return compile_bullet(code, folder)
    if engine == "dart":
        pytest.importorskip("dartpy")
        (folder / "start.py").write_text(code)
        return [sys.executable, "start.py"]
    package = {"rapier": "@dimforge/rapier3d-compat", "jolt": "jolt-physics"}[engine]
    if not shutil.which("node") or not (NODE_MODULES / package).exists():
        pytest.skip(f"no {engine}: npm install {package}, in the checkout")
    (folder / "node_modules").symlink_to(NODE_MODULES)
    (folder / "start.mjs").write_text(code)
    return ["node", "start.mjs"]


@pytest.mark.parametrize("name", PROBLEMS)
@pytest.mark.parametrize("engine", LARGEST)
def test_a_program_follows_the_exact_motion(engine, name, tmp_path):
    command = prepare(engine, copy_problem(name, tmp_path)[engine], tmp_path)
    subprocess.run(command, cwd=tmp_path, check=True, timeout=60)
    problem = read_problems()[name]
    score = problem.score(*read_trajectory(tmp_path / "trajectory.csv", problem))
    assert score.mistakes == ()
    assert score.angles.max() < LARGEST[engine]
    assert score.rates.max() < 10 * LARGEST[engine]
