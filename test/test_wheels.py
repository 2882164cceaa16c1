"""`make wheels` builds wheels that run on other machines, with the bits of the kernel here.

Those for macOS are built and looked at, and not run: there is no emulator of it.
"""

import os
import re
import shutil
import struct
import sys

import numpy as np
import pytest
from documents import ROOT
from physics.exact_motions import PATH
from physics.kernel.motions import list_many, normalize
from physics.kernel.test_kernel import BITS
from programs import execute

ZIG, ARM, WINE = (ROOT / ".venv" / name for name in ("zig", "aarch64", "wine"))
LINUX = ("manylinux_2_28_x86_64", "manylinux_2_28_aarch64")
MACOS = ("macosx_11_0_arm64", "macosx_11_0_x86_64")
LIBRARIES = dict.fromkeys(LINUX, "libsymtop.so") | dict.fromkeys(MACOS, "libsymtop.dylib")
LIBRARIES["win_amd64"] = "libsymtop.dll"
skip = pytest.mark.skipif(not (ZIG / "done").exists(), reason="make .venv/zig/done fetches it")
pytestmark = [pytest.mark.long, skip, pytest.mark.untraced]
CODE_SIGNATURE = 0x1D  # a load command
# Prints the digest of the states of the first motions of the table that it is given.
PROGRAM = """
import hashlib, json, lzma, sys
from symtop_ros.physics import Friction, Motion, State, Top
digest = hashlib.sha256()
for row in json.loads(lzma.open(sys.argv[1]).read())[:200]:
    top, q, omega, friction, torque, times = (
        [float.fromhex(each) for each in row[name]]
        for name in ("top", "q", "omega", "friction", "torque", "t"))
    for part in Motion(Top(*top), State(q, omega), Friction(*friction), torque).at(times)._parts:
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
    """The wheels, unpacked: a folder for each platform."""
    folder = tmp_path_factory.mktemp("wheels")
    execute([ZIG / "bin/python", ROOT / "workshop/wheels.py", folder], check=True, timeout=900)
    found = {}
    for path in folder.glob("*.whl"):
        platform = re.search(r"-py3-none-(\w+)\.whl", path.name)[1]
        found[platform] = folder / platform
        shutil.unpack_archive(path, found[platform], "zip")
    return found


def test_there_is_a_wheel_for_each_platform_with_its_library(wheels):
    assert wheels.keys() == LIBRARIES.keys()
    for platform, folder in wheels.items():
        (library,) = folder.rglob("*symtop.[!hc]*")
        assert library.name == LIBRARIES[platform]
        # no path of the machine that built it
        assert not re.search(rb"/tmp/|/home/|/Users/|" + str(ROOT).encode(), library.read_bytes())
        (tags,) = folder.glob("*.dist-info/WHEEL")
        assert f"Tag: py3-none-{platform}\n" in tags.read_text()


@pytest.mark.parametrize("processor", ["x86_64", "aarch64"])
def test_a_wheel_for_linux_asks_for_no_newer_c_library(wheels, processor):
    (kernel,) = wheels[f"manylinux_2_28_{processor}"].rglob("libsymtop.so")
    versions = re.findall(rb"GLIBC_(\d+)\.(\d+)", kernel.read_bytes())
    assert max((int(major), int(minor)) for major, minor in versions) <= (2, 28)
    assert b"libstdc++" not in kernel.read_bytes()


@pytest.mark.parametrize(("processor", "number"), [("arm64", 0x100000C), ("x86_64", 0x1000007)])
def test_a_wheel_for_macos_has_a_library_that_its_processor_may_load(wheels, processor, number):
    (kernel,) = wheels[f"macosx_11_0_{processor}"].rglob("libsymtop.dylib")
    content = kernel.read_bytes()
    commands = []
    place = 32
    magic, found, *_, count = struct.unpack("<5I", content[:20])
    for _ in range(count):
        command, size = struct.unpack("<2I", content[place : place + 8])
        commands.append(command)
        place += size
    assert (magic, found) == (0xFEEDFACF, number)
    if processor == "arm64":  # loads nothing that is not signed
        assert CODE_SIGNATURE in commands


def test_the_wheel_for_this_processor_has_the_same_bits(wheels):
    assert compute([sys.executable], PYTHONPATH=wheels["manylinux_2_28_x86_64"]) == BITS


@pytest.mark.skipif(not (WINE / "done").exists(), reason="make .venv/wine fetches it")
def test_the_library_for_windows_has_the_same_bits_in_wine(wheels, tmp_path):
    (library,) = wheels["win_amd64"].rglob("libsymtop.dll")
    shutil.copy(library, tmp_path)
    options = ["-target", "x86_64-windows-gnu", "-O1", "-ffp-contract=off", "-I", library.parent]
    program, source = tmp_path / "print_motions.exe", ROOT / "test/physics/kernel/print_motions.c"
    compiler = [ZIG / "bin/python", "-m", "ziglang", "cc", *options]
    execute([*compiler, source, tmp_path / library.name, "-o", program], check=True, timeout=600)
    environment = {
        "WINEPREFIX": tmp_path / "prefix",
        "LD_LIBRARY_PATH": WINE / "usr/lib/x86_64-linux-gnu",
        "WINEDLLOVERRIDES": "mscoree=;mshtml=",  # neither .NET nor a browser
        "WINEDEBUG": "-all",
        "HOME": tmp_path,
        "PATH": os.environ["PATH"],
    }
    samples, expected = list_many()
    words = [WINE / "usr/lib/wine/wine64", program]
    pipes = {"input": samples, "text": False}
    wine = execute(words, check=True, timeout=600, env=environment, cwd=tmp_path, **pipes)
    assert normalize(np.frombuffer(wine.stdout)) == expected


@pytest.mark.skipif(
    not list(ARM.glob("python/usr/bin/python3.*")), reason="make .venv/aarch64 fetches a Python"
)
def test_the_wheel_for_arm_has_the_same_bits_in_the_emulator(wheels, tmp_path):
    (python,) = ARM.glob("python/usr/bin/python3.*")
    version = python.name.removeprefix("python")
    words = [sys.executable, "-m", "pip", "install", "--quiet", "--target", tmp_path, "numpy"]
    words += ["--no-deps", "--only-binary=:all:", "--python-version", version]
    words += [f"--platform=manylinux_2_{minor}_aarch64" for minor in (17, 27, 28)]
    execute([*words, "--platform=manylinux2014_aarch64"], check=True, timeout=600)
    emulator = [ARM / "usr/bin/qemu-aarch64-static", "-L", ARM / "python"]
    path = os.pathsep.join(map(str, (wheels["manylinux_2_28_aarch64"], tmp_path)))
    options = ["-E", f"PYTHONHOME={ARM / 'python/usr'}", "-E", f"PYTHONPATH={path}"]
    assert compute([*emulator, *options, python]) == BITS
