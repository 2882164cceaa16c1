"""The files of the test set: made again in part, checked by the package, and whole."""

import hashlib
import json
import lzma
import re
import shutil

import numpy as np
import pytest
from physics.tops import EPS
from programs import run_python
from truth.testset.trajectories import make_table, write

from symtop_ros.physics import Motion, State, Top, point_acceleration
from symtop_ros.physics.reference.series import Inputs
from symtop_ros.truth.testset.score import main, read_problems
from symtop_ros.truth.testset.tables import FORCES, STATES, WORLD
from workshop.digits import ClosedForm
from workshop.testset.exact import DIGITS
from workshop.testset.links import find_link_effect
from workshop.testset.problems import COUNT, SETTINGS
from workshop.testset.write import PACKED, describe, list_all

PROBLEMS = {name: each.facts for name, each in read_problems().items()}
# Of SHA256SUMS: the files have these bytes until the data change, and then the set a new version.
SUMS = "7ec8de65a61f3031dbd7b8d293cfd9401da41e27a3b3d23f0abcdc725766faec"


def test_there_are_seventy_problems_of_six_levels_at_twenty_times():
    assert list(PROBLEMS) == [setting.name for setting in SETTINGS]
    assert len(PROBLEMS) == 70
    assert {each["level"] for each in PROBLEMS.values()} == {*range(6)}
    assert {len(each["times"]) for each in PROBLEMS.values()} == {COUNT}


@pytest.mark.parametrize("setting", SETTINGS[::2], ids=lambda each: each.name)
def test_a_state_of_every_other_problem_is_made_again_to_the_digit(setting):
    facts = PROBLEMS[setting.name]
    k = sum(setting.name.encode()) % COUNT
    keys = "Ix", "Iz", "Mgl", "orientation", "angular_velocity"
    inputs = Inputs.exact(*(facts[key] for key in keys))
    q, omega = ClosedForm(inputs, DIGITS).at(facts["times"][k])
    for name, rows in list_all(setting, [(q, omega)]).items():
        # the lists of what follows from states begin with the start
        assert rows == [facts[name][place] for place in ((k,) if name in STATES else (0, k + 1))]


def test_inputs_rounded_to_single_precision_err_by_no_more_than_their_limits_allow():
    found = {}
    for name, problem in read_problems().items():
        facts = problem.facts
        rounded = np.float32([*(facts[key] for key in ("Ix", "Iz", "Mgl")), *facts["orientation"]])
        Ix, Iz, Mgl, *q = rounded.astype(float)
        q = np.array(q) / np.linalg.norm(q)
        omega = np.float32(facts["angular_velocity"]).astype(float)
        states = Motion(Top(Ix, Iz, Mgl), State(q, omega)).at(facts["times"])
        found[name] = problem.score(*states._parts).in_float32_limits.max()
    # A limit is the root of the sum of squares of ten roundings of half an ulp. Their sum is at
    # most sqrt(10) times that, as long as the effect is in proportion.
    assert max(found.values()) < 10**0.5
    # And the limits are no larger than they must be: the median is 0.1, the largest 0.95.
    assert np.median(list(found.values())) > 0.05


@pytest.mark.parametrize("setting", SETTINGS, ids=lambda each: each.name)
def test_forces_energies_and_accelerations_are_those_of_the_package(setting):
    facts = PROBLEMS[setting.name]
    exact = {name: np.array(facts[name], dtype=float) for name in FORCES}
    motion = Motion(setting.top, setting.start)
    states = motion.at([0.0, *facts["times"]])
    body = setting.body
    top = setting.top
    omega = states.angular_velocity
    arm = abs(body.arm)
    fastest = np.abs(omega).max() + 1
    # the centre of mass, and Euler's equations: rates and torques of a few ulp
    force = body.pivot_force(motion, states)
    rounding = 8 * EPS * (body.gravity + arm * fastest**2)
    assert force == pytest.approx(exact["pivot_forces"], abs=rounding * body.mass)
    acceleration = force / body.mass - [0.0, 0.0, body.gravity]
    assert acceleration == pytest.approx(exact["accelerations"], abs=rounding)
    largest = top.Ix * fastest**2 + abs(top.Mgl)
    assert top.energy(states) == pytest.approx(exact["energies"], abs=4 * EPS * largest)
    # alpha x p is the acceleration of a point without the part of omega x (omega x p)
    p = np.array([0.0, 0.0, 1.0])
    local = np.cross(exact["angular_accelerations"], p) + np.cross(omega, np.cross(omega, p))
    ours = point_acceleration(motion, states, p)
    assert ours == pytest.approx(local, abs=8 * EPS * fastest**2)
    # the world frame: an attitude within 20 eps, and products of it with the arm and the rates
    position, velocity, rate = (np.array(facts[name], dtype=float) for name in WORLD)
    assert position == pytest.approx(states.to_world([0, 0, body.arm]), abs=24 * EPS * arm)
    assert rate == pytest.approx(states.to_world(omega), abs=24 * EPS * fastest)
    found = np.cross(rate, position)
    assert velocity == pytest.approx(found, abs=16 * EPS * fastest * arm)


@pytest.mark.parametrize("name", ["cusps", "spherical_pendulum", "upper_pole"])
def test_the_effect_of_links_in_mujoco_is_made_again(name):
    (setting,) = (each for each in SETTINGS if each.name == name)
    assert find_link_effect(setting) == PROBLEMS[name]["mujoco_urdf_effect"]


@pytest.mark.long
@pytest.mark.parametrize("setting", SETTINGS, ids=lambda each: each.name)
def test_every_problem_is_made_again_to_the_digit(setting):
    packed = json.loads(lzma.decompress(PACKED.read_bytes()))["problems"]
    (stored,) = (each for each in packed if each["name"] == setting.name)
    found = describe(setting)
    effect, expected = (each.pop("mujoco_urdf_effect") for each in (found, stored))
    assert found == stored
    # Two digits are stored; an effect near rounding depends on the processor.
    assert effect == (expected and pytest.approx(expected, rel=0.03, abs=1e-14))


def test_the_written_files_have_the_bytes_of_this_version(folder):
    lines = (folder / "SHA256SUMS").read_text()
    assert hashlib.sha256(lines.encode()).hexdigest() == SUMS
    sums = dict(reversed(line.split("  ")) for line in lines.splitlines())
    for name, digest in sums.items():
        assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest
    data = {*(folder / "models").iterdir(), *folder.glob("*.json"), *folder.glob("*.csv")}
    assert set(sums) == {path.relative_to(folder).as_posix() for path in data}


def test_the_scorer_needs_numpy_only(folder, tmp_path):
    for name in ("score.py", "problems.json"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    (tmp_path / "mine.csv").write_text(write(make_table("plane_pendulum")))
    code = (
        "import sys; sys.argv[0] = 'score'; import score; code = score.main(sys.argv[1:]); "
        "assert not [m for m in sys.modules if m.startswith(('symtop', 'scipy'))]; sys.exit(code)"
    )
    done = run_python(code, "plane_pendulum", "mine.csv", cwd=tmp_path, PATH="", PYTHONPATH="")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("plane_pendulum: attitude ")
    assert "angular velocity" in done.stdout


@pytest.mark.slow
def test_the_example_of_the_readme_is_scored_as_it_says(folder, tmp_path, monkeypatch, capsys):
    pytest.importorskip("mujoco")
    text = (folder / "README.md").read_text()
    code = text.partition("```python\n")[2].partition("```")[0]
    answer = re.search("`(cusps: attitude .+)`", text)[1]
    shutil.copytree(folder, tmp_path / "set")
    monkeypatch.chdir(tmp_path / "set")
    # a quarter of the steps takes a quarter of the time, and leaves 256 times the error of RK4
    exec(code.replace("2**14", "2**12"), {})
    assert main(["cusps", "trajectory.csv"]) == 0
    found, told = (
        float(re.search(r"attitude (\S+) rad", each)[1])
        for each in (capsys.readouterr().out, answer)
    )
    assert found == pytest.approx(256 * told, rel=0.3)
