"""The kernel as one header and one source: the same program, and the bits of Python from C."""

import os
import platform
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from physics.kernel.motions import list_many
from physics.kernel.test_c_interface import KERNEL, ROOT, build, compare, needs_compiler
from programs import execute
from trials import choose

from symtop_ros import __version__

WARNINGS = ["-Wall", "-Wextra", "-Werror"]
HAS_FMA = platform.machine() == "x86_64" and " fma " in Path("/proc/cpuinfo").read_text()
HAS_CMAKE = all(map(shutil.which, ("g++", "cmake", "pkg-config")))
needs_cmake = pytest.mark.skipif(not HAS_CMAKE, reason="no C++ compiler, CMake or pkg-config")
PROJECT = "cmake_minimum_required(VERSION 3.14)\nproject(mine LANGUAGES C CXX)\n"
# In the order of their numbers, by which programs that are compiled know them.
STATUSES = (
    "OK",
    "NO_MEMORY",
    "BAD_TOP",
    "BAD_ORIENTATION",
    "BAD_ANGULAR_VELOCITY",
    "BAD_FRICTION",
    "BAD_TORQUE",
    "BAD_TIME",
    "TOO_FAR",
    "TOO_FAST",
    "TOO_STIFF",
    "MORE_STEPS",
    "BAD_ARITHMETIC",
    "BAD_ANGLES",
    "BAD_KICK",
    "VERTICAL",
    "TOO_LONG",
    "BAD_POINTER",
    "BAD_COUNT",
    "BAD_HOLD",
    "BAD_KICK_KIND",
    "BAD_RATE",
    "BAD_STEPS",
    "BAD_DISC",
    "BAD_PUSHES",
    "BAD_CLAMP",
    "BAD_QUESTION",
    "BAD_PART",
    "BAD_TOLERANCE",
)


@pytest.fixture(scope="module")
def drop_in(tmp_path_factory):
    """The folder of the files, written once as `make -C workshop drop-in` does."""
    folder = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "workshop.drop_in.write", folder]
    printed = execute(command, cwd=ROOT, check=True).stdout
    return Path(re.fullmatch(r"wrote (.*)\n", printed)[1])


def read_console(folder, number):
    """The commands of a block of the README as one script, and the output that it shows."""
    block = re.findall(r"```console\n(.*?)```", (folder / "README.md").read_text(), re.S)[number]
    lines = block.splitlines()
    commands = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
    return "\n".join(commands), [line for line in lines if not line.startswith("$ ")]


def run_script(script, folder):
    command = ["sh", "-e", "-c", script]
    return execute(command, cwd=folder, check=True, timeout=600).stdout.splitlines()


def configure_and_build(source, folder, *options):
    """Build a project of CMake as a stranger would, without options of this machine."""
    plain = {k: v for k, v in os.environ.items() if k not in ("CFLAGS", "CXXFLAGS", "LDFLAGS")}
    for command in (["cmake", "-S", source, "-B", folder, *options], ["cmake", "--build", folder]):
        done = execute(command, env=plain, timeout=600)
        assert done.returncode == 0, done.stdout + done.stderr


def test_all_files_are_written_and_name_the_version(drop_in):
    assert drop_in.name == f"symtop-{__version__}"
    names = {"CMakeLists.txt", "LICENSE", "README.md", "example.c", "symtop.cpp", "symtop.h"}
    names |= {"symtop-config.cmake.in", "symtop.pc.in"}
    assert {path.name for path in drop_in.iterdir()} == names
    for name, original in (("symtop.h", KERNEL / "symtop.h"), ("LICENSE", ROOT / "LICENSE")):
        assert (drop_in / name).read_bytes() == original.read_bytes()
    for name in ("README.md", "symtop.cpp"):
        assert f"symtop {__version__}" in (drop_in / name).read_text().partition(":")[0]
    assert (drop_in / "example.c").read_text() in (drop_in / "README.md").read_text()


@needs_compiler
def test_the_one_source_is_the_kernel_word_for_word(drop_in):
    """As the compiler reads both, so what is asked of the kernel elsewhere holds here."""
    found, expected = (
        subprocess.check_output(["g++", "-std=c++17", "-E", "-P", folder / "symtop.cpp"], text=True)
        for folder in (drop_in, KERNEL)
    )
    of_warnings = '#pragma GCC diagnostic ignored "-Wpsabi"'  # the other one is for FMA
    assert found.replace(of_warnings, "", 1).split() == expected.split()


@pytest.mark.long
@needs_compiler
def test_the_example_compiles_without_a_warning_and_says_what_is_refused(drop_in, tmp_path):
    """The one source needs no other file, and the example is C99 to the letter."""
    kernel, program = tmp_path / "symtop.o", tmp_path / "example"
    options = ["-O2", "-ffp-contract=off", *WARNINGS, "-c", "symtop.cpp", "-o", kernel]
    subprocess.run(["g++", "-std=c++17", *options], cwd=drop_in, check=True, timeout=300)
    options = [*WARNINGS, "example.c", kernel, "-lstdc++", "-lm", "-o", program]
    subprocess.run(["gcc", "-std=c99", "-pedantic", *options], cwd=drop_in, check=True, timeout=60)
    done = execute([program, "1e101"])
    assert done.returncode == 1
    assert done.stderr == "angular_velocity must be finite, at most 1e100 rad/s in size\n"


@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize("level", choose(("-O0", "-O2"), ("-O0",)))
def test_the_first_commands_of_its_readme_print_what_it_shows(drop_in, tmp_path, level):
    folder = shutil.copytree(drop_in, tmp_path / "tree")
    script, shown = read_console(folder, 0)
    assert run_script(script.replace("-O2", level), folder) == shown
    assert len(shown) == 2


@pytest.mark.long
@needs_cmake
def test_the_other_commands_of_its_readme_install_it_for_cmake_and_pkg_config(drop_in, tmp_path):
    built = shutil.copytree(drop_in, tmp_path / "built")
    run_script(read_console(built, 1)[0], built)
    folder = built.rename(tmp_path / "moved")  # what is installed works there, too
    script, _ = read_console(folder, 2)
    *printed, version = run_script(f"{script}\npkg-config --modversion symtop", folder)
    assert (printed, version) == (read_console(folder, 0)[1], __version__)
    find = f"find_package(symtop {__version__[:3]} REQUIRED)"
    check_project(drop_in, tmp_path, find, f"-DCMAKE_PREFIX_PATH={folder}/installed")


@pytest.mark.long
@needs_cmake
def test_a_project_of_cmake_takes_the_folder_as_a_part(drop_in, tmp_path):
    shutil.copytree(drop_in, tmp_path / "symtop")
    check_project(drop_in, tmp_path, None)


@pytest.mark.long
@needs_cmake
@pytest.mark.parametrize("is_part", [True, False])
def test_a_project_in_c_alone_is_told_which_language_it_lacks(is_part, drop_in, tmp_path):
    shutil.copytree(drop_in, tmp_path / "symtop")
    if is_part:
        find = "add_subdirectory(symtop)"
    else:
        find = f"find_package(symtop REQUIRED PATHS {tmp_path}/installed NO_DEFAULT_PATH)"
        configure_and_build(tmp_path / "symtop", tmp_path / "b")
        run_script("cmake --install b --prefix installed", tmp_path)
    lines = [PROJECT.replace("LANGUAGES C CXX", "C"), find]
    (tmp_path / "CMakeLists.txt").write_text("\n".join(lines))
    words = ["cmake", "-S", str(tmp_path), "-B", str(tmp_path / "mine")]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode
    told = "the project must have the language CXX, got C: write project(NAME LANGUAGES C CXX)"
    assert told in " ".join(done.stderr.split())


def check_project(drop_in, project, find, *options):
    """Build a project with the two lines of the README, or with another first one."""
    (lines,) = re.findall(r"```cmake\n(.*?)```", (drop_in / "README.md").read_text(), re.S)
    first, last = lines.splitlines()
    program = f"add_executable(my_test {drop_in}/example.c)"
    (project / "CMakeLists.txt").write_text("\n".join([PROJECT, find or first, program, last]))
    configure_and_build(project, project / "build", *options)
    assert run_script("build/my_test", project) == read_console(drop_in, 0)[1]


OPTIONS = [("OFF", "-ffast-math"), ("ON", "-ffp-contract=fast")]


@pytest.mark.long
@needs_cmake
@pytest.mark.parametrize(("shared", "flags"), OPTIONS, ids=["static", "shared"])
def test_options_of_a_project_that_change_bits_are_overruled(shared, flags, drop_in, tmp_path):
    flags += " -mfma" if HAS_FMA else ""
    options = [f"-DBUILD_SHARED_LIBS={shared}", f"-DCMAKE_CXX_FLAGS={flags}"]
    configure_and_build(drop_in, tmp_path, *options)
    (library,) = (path for path in tmp_path.glob("libsymtop.*") if not path.is_symlink())
    program = build("print_motions.c", tmp_path, (library, f"-Wl,-rpath,{tmp_path}"))
    compare([program], *list_many())


def test_statuses_keep_their_numbers():
    """As the README promises: a new one is added at the end, and to the list above."""
    header = (KERNEL / "symtop.h").read_text()
    (body,) = re.findall(r"typedef enum \{([^}]*)\} symtop_status;", header)
    names = re.findall(r"\bSYMTOP_(\w+)", re.sub(r"/\*.*?\*/", "", body, flags=re.S))
    assert names == [*STATUSES]
