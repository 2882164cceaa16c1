"""symtop.h from C: the bits of Python, on this processor and another, whatever a caller passes."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from physics.kernel.motions import encode, expect, list_many, list_samples, normalize

FOLDER = Path(__file__).parent
ROOT = FOLDER.parents[2]
KERNEL = ROOT / "symtop_ros/physics/kernel"
OPTIONS = ["-O2", "-ffp-contract=off", "-I", str(KERNEL)]
STRICT = ["-Wall", "-Wextra", "-Werror", "-Wno-psabi"]
SANITIZERS = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
AARCH64 = ROOT / ".venv/aarch64/usr"

needs_compiler = pytest.mark.skipif(not shutil.which("g++"), reason="no C++ compiler")


@pytest.fixture(scope="module")
def kernel(tmp_path_factory):
    """The kernel compiled once, for all programs."""
    return compile_kernel(tmp_path_factory.mktemp("kernel"))


def compile_kernel(folder, *options):
    target = folder / "symtop.o"
    command = ["g++", "-std=c++17", *OPTIONS, *STRICT, *options, "-c", KERNEL / "symtop.cpp"]
    subprocess.run([*command, "-o", target], check=True)
    return target


def build(source, folder, kernel, *options):
    """Compile a program in C and link it with the kernel; return the path of the program."""
    program, target = folder / source.removesuffix(".c"), folder / "program.o"
    pedantic = ["gcc", *OPTIONS, "-std=c99", "-pedantic", *STRICT, *options]
    subprocess.run([*pedantic, "-c", FOLDER / source, "-o", target], check=True)
    subprocess.run(["g++", *options, target, kernel, "-o", program], check=True)
    return program


def compare(command, samples, expected):
    done = subprocess.run(command, input=samples, capture_output=True, check=True, timeout=600)
    assert normalize(np.frombuffer(done.stdout)) == expected


@needs_compiler
def test_a_program_in_c_has_the_bits_of_python(tmp_path, kernel):
    compare([build("print_motions.c", tmp_path, kernel)], *list_many())


@needs_compiler
def test_a_program_that_uses_the_kernel_needs_no_python(tmp_path, kernel):
    ldd = "ldd", build("print_motions.c", tmp_path, kernel)
    libraries = subprocess.check_output(ldd)
    assert b"libc.so" in libraries
    assert b"python" not in libraries


@needs_compiler
def test_whatever_is_passed_is_refused_or_answered(tmp_path, kernel):
    program = build("hostile.c", tmp_path, kernel)
    output = subprocess.check_output([program, "1", "3000"], text=True, timeout=100)
    made = int(re.fullmatch(r"(\d+) of 3000 motions made\n", output)[1])
    assert 300 < made < 2700  # many of both kinds


@pytest.mark.long
@needs_compiler
def test_sanitizers_find_nothing_in_fifty_thousand_hostile_calls_or_in_ordinary_motions(tmp_path):
    kernel = compile_kernel(tmp_path, *SANITIZERS)
    # 10 000 motions of which a third are made, with nine calls each and more
    hostile = build("hostile.c", tmp_path, kernel, *SANITIZERS)
    subprocess.run([hostile, "100000", "20000"], check=True, timeout=3000)
    compare([build("print_motions.c", tmp_path, kernel, *SANITIZERS)], *list_many())


@pytest.mark.long
@pytest.mark.skipif(not AARCH64.exists(), reason="make .venv/aarch64 fetches compiler and emulator")
def test_an_arm_processor_has_the_same_bits(tmp_path):
    program = tmp_path / "print_motions"
    (compiler,) = AARCH64.glob("bin/aarch64-linux-gnu-g++-*")
    libraries = AARCH64 / "lib/x86_64-linux-gnu"
    sources = ["-x", "c++", FOLDER / "print_motions.c", KERNEL / "symtop.cpp"]
    command = [compiler, "-std=c++17", *OPTIONS, "-static", *sources, "-o", program]
    subprocess.run(command, check=True, env={"LD_LIBRARY_PATH": str(libraries), "PATH": ""})
    emulator = AARCH64 / "bin/qemu-aarch64-static"
    samples = list_samples(range(40), range(8))
    compare([emulator, program], encode(samples), expect(samples))
