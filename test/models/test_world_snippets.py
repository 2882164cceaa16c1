"""The start of a problem in engines that hold bodies in the world."""

import re

import pytest

from symtop_ros.judge.main import main

ENGINES = ("bullet", "rapier", "jolt", "dart")


def copy_problem(name, folder):
    """Copy a problem; return its programs by their engines."""
    assert main(["--testset", name, "-o", str(folder)]) == 0
    text = (folder / "README.md").read_text()
    text = text[text.index("## Start in Bullet") :]
    blocks = re.findall(r"```(?:cpp|js|python)\n(.*?)```", text, re.DOTALL)[:4]
    return dict(zip(ENGINES, blocks, strict=True))


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
