"""colcon and pip install the files that `ros2 run` looks for."""

import os
import re
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

import lint
import pytest
from documents import ROOT
from programs import execute
from trials import choose

from symtop_ros import __version__

pytestmark = pytest.mark.untraced
PARTS = (
    "symtop_ros",
    "config",
    "launch",
    "resource",
    "setup.py",
    "setup.cfg",
    "package.xml",
    "build_kernel.py",
    "pyproject.toml",
    "MANIFEST.in",
    "LICENSE",
    "README.md",
    "CITATION.cff",
    "CHANGELOG.rst",
)
PROGRAMS = ("node", "ctl", "replay", "live", "panel", "model", "imu", "judge", "testset", "fit")
OLDEST_PYTHON = 11  # 3.11
LIBRARY = "symtop_ros/physics/kernel/libsymtop.so"
CONFIG = sorted(path.name for path in (ROOT / "config").iterdir())


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    """A copy of what is built, so that building leaves no traces here."""
    folder = tmp_path_factory.mktemp("workspace") / "src" / "symtop_ros"
    folder.mkdir(parents=True)
    for part in PARTS:
        copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
        copy(ROOT / part, folder / part)
    (folder / "test").mkdir()
    (folder / "test/test_nothing.py").touch()
    return folder


def assert_tree(prefix, programs):
    """Package marker, configuration, package.xml and programs are where ROS 2 looks for them."""
    assert (prefix / "share/ament_index/resource_index/packages/symtop_ros").is_file()
    assert (prefix / "share/symtop_ros/package.xml").is_file()
    assert (prefix / "share/symtop_ros/launch/top.launch.py").is_file()
    installed = (prefix / "share/symtop_ros/config").iterdir()
    assert sorted(path.name for path in installed) == CONFIG
    (package,) = prefix.glob("lib/python*/site-packages/symtop_ros")
    assert (package.parent / LIBRARY).is_file()
    for name in PROGRAMS:
        assert os.access(programs / f"top_{name}", os.X_OK)


def build(workspace, *options, **variables):
    """Build a workspace with colcon; return the prefix of the package and what is printed."""
    colcon = shutil.which("colcon", path=str(Path(sys.executable).parent))
    if colcon is None:
        pytest.skip("colcon is not installed")
    words = [colcon, "build", "--packages-select", "symtop_ros", *options]
    variables = {**os.environ, **variables}
    result = execute(words, cwd=workspace, check=True, timeout=300, env=variables)
    return workspace / "install" / "symtop_ros", result.stdout + result.stderr


@pytest.fixture
def workspace(sources, tmp_path):
    """A separate workspace."""
    shutil.copytree(sources, tmp_path / "src/symtop_ros")
    return tmp_path


@pytest.mark.long
def test_colcon_build_with_links_leads_to_the_sources(workspace):
    prefix, printed = build(workspace, "--symlink-install")
    (link,) = prefix.glob("lib/python*/site-packages/symtop-ros.egg-link")
    assert (Path(link.read_text().splitlines()[0]) / "symtop_ros/py.typed").is_file()
    assert os.access(prefix / "lib/symtop_ros/top_node", os.X_OK)
    assert sorted(path.name for path in (prefix / "share/symtop_ros/config").iterdir()) == CONFIG
    assert (workspace / "build/symtop_ros" / LIBRARY).is_file()
    assert "Failed" not in printed


def write_compiler(folder):
    """Write a compiler that has compiled the kernel already, as the set-up did; return its path."""
    compiler = folder / "compiler"
    compiler.write_text(f'#!/bin/sh\nfor target; do :; done\ncp "{ROOT / LIBRARY}" "$target"\n')
    compiler.chmod(0o755)
    return str(compiler)


def build_extension(workspace, variables):
    words = [sys.executable, "setup.py", "-q", "build_ext", "--inplace"]
    execute(words, cwd=workspace / "src/symtop_ros", check=True, env=variables)


BUILDERS = {"setup.py": build_extension, "colcon": lambda place, names: build(place, **names)}


@pytest.mark.parametrize("builder", choose(BUILDERS, ("setup.py",)))
def test_a_build_without_a_compiler_ends_with_a_line_that_names_one(workspace, builder):
    tools = workspace / "tools"
    tools.mkdir()
    for name in ("sh", "bash", "env"):
        (tools / name).symlink_to(shutil.which(name))
    environment = {**os.environ, "PATH": str(tools), "CXX": ""}
    with pytest.raises(subprocess.CalledProcessError) as failure:
        BUILDERS[builder](workspace, environment)
    printed = failure.value.stdout + failure.value.stderr
    assert "error: symtop_ros needs a C++ compiler: install g++" in printed
    assert "Traceback" not in printed


@pytest.mark.slow
def test_colcon_build_installs_what_ros2_run_looks_for(workspace):
    prefix, printed = build(workspace, CXX=write_compiler(workspace))
    assert "stderr" not in printed
    assert_tree(prefix, prefix / "lib/symtop_ros")
    site = next(prefix.glob("lib/python*/site-packages"))
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",  # as in an active venv
        "PYTHONPATH": str(site),
        "AMENT_PREFIX_PATH": str(prefix),
    }
    result = execute([prefix / "lib/symtop_ros/top_node", "--help"], env=environment)
    assert result.returncode == 0, result.stderr
    assert "perry_fails" in result.stdout
    # the Python of a venv that is active, where mcap may be installed
    for program in (prefix / "lib/symtop_ros").iterdir():
        assert program.read_text().startswith("#!/usr/bin/env python3\n")


@pytest.mark.long  # as colcon does, and the set-up of the tests
def test_pip_installs_the_same_tree(sources, tmp_path):
    # --ignore-installed leaves the installed version in place
    options = ["--no-deps", "--ignore-installed", "--quiet", "--prefix", str(tmp_path)]
    words = [sys.executable, "-m", "pip", "install", *options, sources]
    execute(words, check=True, timeout=300)
    assert_tree(tmp_path, tmp_path / "lib/symtop_ros")
    assert_tree(tmp_path, tmp_path / "bin")


def list_files(folder, *parts):
    """Paths of the files of some parts of a folder, but for those that are built."""
    paths = [path for part in parts for path in [folder / part, *(folder / part).rglob("*")]]
    files = {path for path in paths if path.is_file() and path.suffix not in (".pyc", ".so")}
    return {str(path.relative_to(folder)) for path in files}


def test_every_file_of_the_package_is_installed(sources, tmp_path):
    setup = [sys.executable, "setup.py", "-q", "build_py", "-d", tmp_path]
    execute(setup, cwd=sources, check=True)
    needed, found = (list_files(folder / "symtop_ros", "") for folder in (sources, tmp_path))
    # the digest is for those who build the module anew
    assert needed - found == {"page/web/kernel.sha256"}


@pytest.mark.slow
def test_a_module_that_is_gone_after_an_upgrade_is_not_installed(workspace):
    """By pip, which installs what setuptools has in its folder build, and by colcon."""
    folder = workspace / "src/symtop_ros"
    compiler = write_compiler(workspace)
    variables = {**os.environ, "CXX": compiler}
    prefix = workspace / "of pip"
    prefix.mkdir()
    (prefix / "COLCON_IGNORE").touch()
    words = [sys.executable, "setup.py", "-q", "install", "--single-version-externally-managed"]
    words += ["--prefix", str(prefix), "--record", str(workspace / "record")]
    (moved := folder / "symtop_ros/base/moved.py").touch()

    def list_installed():
        execute(words, cwd=folder, check=True, env=variables)
        colcon, _ = build(workspace, CXX=compiler)
        (built,) = folder.glob("build/lib*/symtop_ros")
        places = [built]
        for each in (prefix, colcon):
            places += each.glob("lib*/python*/site-packages/symtop_ros")
        assert all((each / "physics/kernel/libsymtop.so").is_file() for each in places)
        return [list_files(each, "") for each in places]

    assert all("base/moved.py" in each for each in list_installed())
    moved.unlink()
    needed = list_files(folder / "symtop_ros", "") - {"page/web/kernel.sha256"}
    assert list_installed() == [needed] * 3


@pytest.mark.slow
def test_an_sdist_has_the_whole_project(tmp_path):
    """So that the README, which speaks of make and of tests, is true of it."""
    project = {*lint.list_files()}
    folder = tmp_path / "checkout"
    for name in project:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, folder / name)
    setup = [sys.executable, "setup.py", "-q", "sdist", "-d", tmp_path]
    execute(setup, cwd=folder, check=True)
    with tarfile.open(next(tmp_path.glob("*.tar.gz"))) as archive:
        packed = {name.partition("/")[2] for name in archive.getnames()}
    assert project - packed == set()


def test_the_version_is_the_same_everywhere():
    release = __version__.partition(".dev")[0]  # package.xml allows three numbers only
    assert f"<version>{release}</version>" in (ROOT / "package.xml").read_text()
    assert f"\nversion: {__version__}\n" in (ROOT / "CITATION.cff").read_text()


def test_the_oldest_python_is_the_same_everywhere():
    places = {
        "setup.py": r'python_requires=">=3\.(\d+)"|Python :: 3\.(\d+)"',
        "pyproject.toml": r'target-version = "py3(\d+)"|python_version = "3\.(\d+)"',
        "Makefile": r"version_info < \(3, (\d+)\)",
        "README.md": r"Python 3\.(\d+) or later",
        "CONTRIBUTING.md": r"Python 3\.(\d+) or later",
    }
    for name, pattern in places.items():
        found = re.findall(pattern, (ROOT / name).read_text())
        versions = [int("".join(each)) for each in found]
        assert versions, name
        assert min(versions) == OLDEST_PYTHON, name


def test_nothing_but_the_extra_brings_ros_from_pypi():
    text = (ROOT / "setup.py").read_text()
    required = text.split("install_requires=[")[1].split("]")[0]
    assert "ros-" not in required
