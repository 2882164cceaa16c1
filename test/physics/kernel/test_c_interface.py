"""symtop.h from C: the bits of Python, on this processor and another, whatever a caller passes."""

import platform
import re
import shutil
import subprocess
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from physics.kernel.motions import encode, expect, list_many, list_samples, normalize
from programs import execute
from trials import choose

from symtop_ros.physics.kernel.library import load_library

FOLDER = Path(__file__).parent
ROOT = FOLDER.parents[2]
KERNEL = ROOT / "symtop_ros/physics/kernel"
OPTIONS = ["-O2", "-ffp-contract=off", "-I", str(KERNEL)]
STRICT = ["-Wall", "-Wextra", "-Werror", "-Wno-psabi"]
SANITIZERS = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
AARCH64 = ROOT / ".venv/aarch64/usr"

needs_compiler = pytest.mark.skipif(not shutil.which("g++"), reason="no C++ compiler")
pytestmark = needs_compiler


LOADED = Path(load_library()._name)  # that of Python
LIBRARY = LOADED, f"-Wl,-rpath,{LOADED.parent}"


def compile_kernel(folder, *options, **keywords):
    target = folder / "symtop.o"
    command = ["g++", "-std=c++17", *OPTIONS, *STRICT, *options, "-c", KERNEL / "symtop.cpp"]
    subprocess.run([*command, "-o", target], check=True, **keywords)
    return (target,)


def build(source, folder, kernel, *options):
    """Compile a program in C and link it with files of the kernel; return its path."""
    program = folder / source.removesuffix(".c")
    target = folder / "program.o"
    pedantic = ["gcc", *OPTIONS, "-std=c99", "-pedantic", *STRICT, *options]
    subprocess.run([*pedantic, "-c", FOLDER / source, "-o", target], check=True)
    subprocess.run(["g++", *options, target, *kernel, "-o", program], check=True)
    return program


def compare(command, samples, expected):
    done = subprocess.run(command, input=samples, capture_output=True, check=True, timeout=600)
    assert normalize(np.frombuffer(done.stdout)) == expected


@pytest.mark.slow
def test_a_program_in_c_has_the_bits_of_python_and_needs_none(tmp_path):
    program = build("print_motions.c", tmp_path, LIBRARY)
    compare([program], *list_many())
    libraries = subprocess.check_output(["ldd", program])
    assert b"libc.so" in libraries
    assert b"python" not in libraries


HOSTILE_SEEDS = 50_000  # a million calls


def run_hostile(program, seeds):
    """Run the program; return what it answered, and how many calls it made."""
    printed = subprocess.check_output([program, "1", str(seeds)], text=True, timeout=3000)
    answered, calls, digest = re.fullmatch(
        r"(\d+) of (\d+) calls answered, digest ([0-9a-f]{8})\n", printed
    ).groups()
    assert 0.3 < int(answered) / int(calls) < 0.7  # many of both kinds
    return digest, int(calls)


@pytest.mark.slow
def test_whatever_is_passed_is_refused_or_answered(tmp_path):
    assert run_hostile(build("hostile.c", tmp_path, LIBRARY), 500)[1] > 10_000


UNSOUND = {  # what the kernel's promises cannot bear, and a compiler may be asked for
    "order": ["-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math"],
    "fused": ["-mfma", "-ffp-contract=fast"],
    "reciprocal": ["-freciprocal-math"],
    "finite": ["-ffinite-math-only"],
    "zeros": ["-fno-signed-zeros"],
}
QUICK = ("order", "-O0")  # to compile; what the others change is changed only with -O2
BAD_ARITHMETIC = 12


@pytest.mark.parametrize("option", ["-ffast-math", "-Ofast"])
def test_a_build_with_fast_math_is_refused_in_words(tmp_path, option):
    with pytest.raises(subprocess.CalledProcessError) as failure:
        compile_kernel(tmp_path, option, "-Wfatal-errors", stderr=subprocess.PIPE, text=True)
    assert "symtop must be compiled without fast-math" in failure.value.stderr


# The second is what MSVC and compilers for 32 bits lack; the first asks for such a processor.
@pytest.mark.parametrize("option", ["-m32", "-U__SIZEOF_INT128__"])
def test_a_compiler_without_integers_of_128_bits_is_refused_in_words(tmp_path, option):
    if option == "-m32" and platform.machine() != "x86_64":
        pytest.skip("an option of x86")
    with pytest.raises(subprocess.CalledProcessError) as failure:
        compile_kernel(tmp_path, option, "-Wfatal-errors", stderr=subprocess.PIPE, text=True)
    assert "symtop must be compiled by GCC or Clang, 64 bits" in failure.value.stderr


@pytest.mark.slow
@pytest.mark.parametrize("asked", choose((QUICK, *product(UNSOUND, ("-O2",))), (QUICK,)))
def test_a_build_that_may_change_sums_answers_nothing(tmp_path, asked):
    name, level = asked
    kernel = compile_kernel(tmp_path, level, *UNSOUND[name])
    if name == "fused" and "fma" not in Path("/proc/cpuinfo").read_text():
        pytest.skip("this processor has no fused operations")
    assert run_sound(build_sound(tmp_path, kernel), "usual") == {BAD_ARITHMETIC}


@pytest.mark.long
def test_options_of_fast_math_before_those_of_the_kernel_change_no_bit(tmp_path):
    # as setup.py orders them: what CXXFLAGS says, then its own
    kernel = compile_kernel(tmp_path, "-ffast-math", "-fno-fast-math", "-ffp-contract=off")
    compare([build("print_motions.c", tmp_path, kernel)], *list_many())


MODES = ["usual", "upward", "downward", "towards zero", "flushed", "zeros"]


@pytest.mark.parametrize("state", MODES)
def test_a_thread_that_rounds_otherwise_gets_a_status_and_no_state(sound, state):
    if state in ("flushed", "zeros") and platform.machine() != "x86_64":
        pytest.skip("set by a register of x86")
    assert run_sound(sound, state) == {0 if state == "usual" else BAD_ARITHMETIC}


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    return build_sound(tmp_path_factory.mktemp("sound"), LIBRARY)


def build_sound(folder, kernel):
    return build("sound.c", folder, kernel, "-frounding-math", "-lm")


def run_sound(program, state):
    """The statuses of all functions in a thread that rounds otherwise, if they wrote nothing."""
    printed = subprocess.check_output([program, state], text=True, timeout=60)
    return set(map(int, printed.split()))


PROCESSORS = "x86-64-v4", "skylake-avx512", "native"


@pytest.mark.slow
@pytest.mark.parametrize("level", choose(("-fsyntax-only", "-O0"), ("-fsyntax-only",)))
@pytest.mark.parametrize("processor", choose(PROCESSORS, PROCESSORS[:1]))
def test_the_kernel_compiles_for_one_kind_of_processor(tmp_path, processor, level):
    if platform.machine() != "x86_64":
        pytest.skip("names of x86 processors")
    compile_kernel(tmp_path, level, f"-march={processor}")


@pytest.mark.long
def test_sanitizers_find_nothing_in_a_million_hostile_calls_or_in_ordinary_motions(tmp_path):
    kernel = compile_kernel(tmp_path, *SANITIZERS)
    hostile = build("hostile.c", tmp_path, kernel, *SANITIZERS)
    assert run_hostile(hostile, HOSTILE_SEEDS)[1] > 1_000_000
    compare([build("print_motions.c", tmp_path, kernel, *SANITIZERS)], *list_many())


@pytest.mark.parametrize("options", choose(((), ("-g", "-fsanitize=thread")), ((),)))
def test_threads_that_share_motions_get_the_same_bits_and_do_not_race(tmp_path, options):
    watched = compile_kernel(tmp_path, *options) if options else LIBRARY
    program = build("shared.c", tmp_path, watched, "-pthread", *options)
    done = execute([program], timeout=600)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.long
@pytest.mark.skipif(not AARCH64.exists(), reason="make .venv/aarch64 fetches compiler and emulator")
def test_an_arm_processor_has_the_same_bits(tmp_path):
    program = tmp_path / "print_motions"
    (compiler,) = AARCH64.glob("bin/aarch64-linux-gnu-g++-*")
    libraries = AARCH64 / "lib/x86_64-linux-gnu"
    sources = ["-x", "c", FOLDER / "print_motions.c", "-x", "c++", KERNEL / "symtop.cpp"]
    command = [compiler, *OPTIONS, "-static", *sources, "-o", program]
    subprocess.run(command, check=True, env={"LD_LIBRARY_PATH": str(libraries), "PATH": ""})
    emulator = AARCH64 / "bin/qemu-aarch64-static"
    samples = list_samples(range(40), range(8))
    compare([emulator, program], encode(samples), expect(samples))
