"""The kernel gives the states of Python, bit for bit, and the package works without it."""

import hashlib
import os
import shutil
import subprocess
import sys
import sysconfig
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from physics.taylor_families import STORED, read_stored
from physics.tops import ARTICLE, CUSPS, FAMILIES, random_case, seeds
from python_runs import run_python

from symtop_ros.physics import ExactTimes, Motion, State, Top, accelerated
from symtop_ros.physics.kernel import find_kernel

FOLDER = Path(__file__).parents[1]
ROOT = FOLDER.parents[1]
# Of all states at the stored times; the same for x86 and ARM, and every version of NumPy.
BITS = "902cf70d3c4c"

compiled = pytest.mark.skipif(not accelerated, reason="the kernel is not built")


def compute_both(top, start, times):
    """Return the states from the kernel, and from Python, after a look at the constants."""
    fast, pure = Motion(top, start), Motion(top, start, pure=True)
    assert list_constants(fast) == list_constants(pure)
    return fast.at(times), pure.at(times)


def list_constants(motion):
    """Kind, turning angles and rates, with the bits of each number; NaN has one set of bits."""
    rates = [np.nan if np.isnan(each) else each for each in motion._rates]
    return motion.kind, motion.engine, np.array([*motion.turning_angles, *rates]).tobytes()


def list_times(t):
    """Times of all sizes about t, of both signs, with the start and the first instants."""
    return np.array([0.0, 1e-9 * t, -1e-5 * t, 1e-3 * t, -0.3 * t, t, 7.0 * t])


def assert_same_bits(one, other):
    for mine, its in zip(one.parts, other.parts, strict=True):
        assert mine.tobytes() == its.tobytes()


@compiled
@pytest.mark.parametrize("data", STORED, ids=[data["family"] for data in STORED])
def test_stored_motions_have_the_same_bits(data):
    times = np.concatenate([list_times(data["t"][0]), data["t"]])
    assert_same_bits(*compute_both(*read_stored(data), times))
    assert_same_bits(*compute_both(*read_stored(data), float(times[-1])))


@compiled
@pytest.mark.parametrize("seed", seeds(1, 10))
def test_weightless_and_sleeping_motions_have_the_same_bits(seed):
    for n in range(100):
        case = random_case(1000 * seed + n, "any")
        (Ix, Iz, Mgl), spin = case.top.moments, case.start.angular_velocity[2]
        times, asleep = list_times(case.t), State((1, 0, 0, 0), (0, 0, spin))
        assert_same_bits(*compute_both(Top(Ix, Iz, 0.0), case.start, times))
        assert_same_bits(*compute_both(Top(Ix, Iz, Mgl), asleep, times))
        assert_same_bits(*compute_both(Top(Ix, Iz, 1e-230), case.start, float(times[-1])))


@compiled
@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("seed", seeds(1, 10))
def test_random_motions_have_the_same_bits(family, seed):
    for n in range(334):
        case = random_case(1000 * seed + n, f"{family}")
        times = list_times(case.t)
        assert_same_bits(*compute_both(case.top, case.start, times))


def test_the_bits_are_those_of_every_other_machine():
    digest = hashlib.sha256()
    for data in STORED:
        states = Motion(*read_stored(data)).at(data["t"])
        digest.update(states.orientation.tobytes() + states.angular_velocity.tobytes())
    assert digest.hexdigest()[:12] == BITS


@compiled
@pytest.mark.parametrize("data", STORED[::8], ids=[data["family"] for data in STORED[::8]])
def test_exact_times_have_the_same_bits(data):
    ticks = np.array([0, 1, 1000, -(10**9), 10**12 + 7, 10**17 + 1, 10**10, 1, -(10**16)])
    for stamps, elapsed in ((ticks, Fraction(1, 4)), (10**9 + 1, Fraction(1)), (0, Fraction(0))):
        times = ExactTimes(stamps, factor=1 / 3, elapsed=elapsed)
        assert_same_bits(*compute_both(*read_stored(data), times))


@compiled
@pytest.mark.parametrize("data", STORED[::8], ids=[data["family"] for data in STORED[::8]])
def test_an_instant_has_the_same_bits_alone_and_among_others(data):
    motion = Motion(*read_stored(data))
    times = np.concatenate([data["t"][0] * np.linspace(-1, 3, 23), list_times(data["t"][0])])
    together = motion.at(times)
    for n, t in enumerate(times):
        assert_same_bits(together[n], motion.at(float(t)))


@compiled
def test_times_beyond_the_counts_of_the_kernel_come_from_python():
    for times in (1e17, np.array([1.0, 1e17, -1e20])):
        assert_same_bits(*compute_both(ARTICLE, CUSPS, times))


def test_an_environment_variable_selects_python():
    code = "from symtop_ros.physics import accelerated; print(accelerated)"
    assert run_python(code, SYMTOP_PURE="1").stdout == "False\n"
    assert run_python(code, SYMTOP_PURE="0").stdout == f"{find_kernel(False) is not None}\n"


def test_the_physics_imports_neither_scipy_nor_a_compiler_of_numpy():
    code = "import sys, symtop_ros.physics; print('scipy' in sys.modules, 'numba' in sys.modules)"
    assert run_python(code).stdout == "False False\n"


def test_without_a_compiler_the_build_succeeds_and_has_no_kernel(tmp_path):
    command = [sys.executable, "setup.py", "-q", "build_ext"]
    folders = ["--build-lib", tmp_path / "lib", "--build-temp", tmp_path / "temp"]
    environment = {**os.environ, "CC": "no-compiler", "CXX": "no-compiler"}
    subprocess.run([*command, *folders], cwd=ROOT, env=environment, capture_output=True, check=True)
    assert not list(tmp_path.rglob("*.so"))


@compiled
@pytest.mark.long
def test_no_extreme_number_overflows_in_the_kernel_or_leaves_its_arrays(tmp_path):
    kernel = Path("symtop_ros/physics/kernel")
    shutil.copytree(
        ROOT / "symtop_ros", tmp_path / "symtop_ros", ignore=shutil.ignore_patterns("*.so")
    )
    traps = ["-fsanitize=undefined", "-fsanitize-undefined-trap-on-error"]  # end the process
    options = ["-std=c++17", "-O1", "-ffp-contract=off", "-fno-exceptions", "-fno-rtti", *traps]
    headers = f"-I{sysconfig.get_paths()['include']}"
    library = tmp_path / kernel / "_kernel.abi3.so"
    sources = [str(ROOT / kernel / name) for name in ("module.cpp", "symtop.cpp")]
    subprocess.run(
        ["g++", *options, "-shared", "-fPIC", headers, *sources, "-o", str(library)], check=True
    )
    tests = [str(FOLDER / "test_extremes.py"), str(FOLDER / "driven"), "-p", "no:cacheprovider"]
    subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-m", "not long", *tests],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        check=True,
    )
