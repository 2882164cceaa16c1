"""`make wheels` builds wheels that run on other machines, with the bits of the kernel here."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from physics.exact_motions import PATH
from physics.kernel.test_kernel import BITS
from programs import execute

pytestmark = pytest.mark.untraced
ROOT = Path(__file__).parents[1]
ZIG, ARM = ROOT / ".venv/zig", ROOT / ".venv/aarch64"
needs_zig = pytest.mark.skipif(not (ZIG / "done").exists(), reason="make .venv/zig/done fetches it")
# Prints the digest of the states of the first motions of the table that it is given.
PROGRAM = """
import hashlib, json, lzma, sys
from symtop_ros.physics import Friction, Motion, State, Top
digest = hashlib.sha256()
for row in json.loads(lzma.open(sys.argv[1]).read())[:200]:
    top, q, omega, friction, torque, times = (
        [float.fromhex(each) for each in row[name]]
        for name in ("top", "q", "omega", "friction", "torque", "t"))
    for part in Motion(Top(*top), State(q, omega), Friction(*friction), torque).at(times).parts:
        digest.update(part.tobytes())
print(digest.hexdigest()[:12])
"""


def compute(command, **variables):
    """Return the digest that the program prints."""
    environment = os.environ | {name: str(value) for name, value in variables.items()}
    words = [*command, "-c", PROGRAM, PATH]
    return execute(words, check=True, env=environment, cwd="/", timeout=600).stdout.strip()


@pytest.fixture(scope="module")
def wheels(tmp_path_factory):
    """The wheels, unpacked: a folder for each processor."""
    folder = tmp_path_factory.mktemp("wheels")
    subprocess.run([ZIG / "bin/python", ROOT / "workshop/wheels.py", folder], check=True)
    found = {}
    for path in folder.glob("*.whl"):
        processor = re.search(r"manylinux_2_28_(\w+)\.whl", path.name)[1]
        found[processor] = folder / processor
        shutil.unpack_archive(path, found[processor], "zip")
    return found


@pytest.mark.long
@needs_zig
def test_there_is_a_wheel_for_each_processor_that_asks_for_no_newer_c_library(wheels):
    assert sorted(wheels) == ["aarch64", "x86_64"]
    for folder in wheels.values():
        (kernel,) = folder.rglob("libsymtop.so")
        versions = re.findall(rb"GLIBC_(\d+)\.(\d+)", kernel.read_bytes())
        assert max((int(major), int(minor)) for major, minor in versions) <= (2, 28)
        assert b"libstdc++" not in kernel.read_bytes()
        (tags,) = folder.glob("*.dist-info/WHEEL")
        assert f"Tag: py3-none-manylinux_2_28_{folder.name}\n" in tags.read_text()


@pytest.mark.long
@needs_zig
def test_the_wheel_for_this_processor_has_the_same_bits(wheels):
    assert compute([sys.executable], PYTHONPATH=wheels["x86_64"]) == BITS


@pytest.mark.long
@needs_zig
@pytest.mark.skipif(
    not list(ARM.glob("python/usr/bin/python3.*")), reason="make .venv/aarch64 fetches a Python"
)
def test_the_wheel_for_arm_has_the_same_bits_in_the_emulator(wheels, tmp_path):
    (python,) = ARM.glob("python/usr/bin/python3.*")
    version = python.name.removeprefix("python")
    subprocess.run(
        [
            *(sys.executable, "-m", "pip", "install", "--quiet", "--target", tmp_path, "numpy"),
            *("--no-deps", "--only-binary=:all:", "--python-version", version),
            *(f"--platform=manylinux_2_{minor}_aarch64" for minor in (17, 27, 28)),
            "--platform=manylinux2014_aarch64",
        ],
        check=True,
    )
    emulator = [ARM / "usr/bin/qemu-aarch64-static", "-L", ARM / "python"]
    path = os.pathsep.join(map(str, (wheels["aarch64"], tmp_path)))
    options = ["-E", f"PYTHONHOME={ARM / 'python/usr'}", "-E", f"PYTHONPATH={path}"]
    assert compute([*emulator, *options, python]) == BITS
