"""Keep what make needs in .venv: python workshop/set_up.py [--asked] NAME...

Each set-up has a stamp, a small file in .venv/set-up: the path of the checkout, the Python, and a
digest of what decides what is installed. If path or Python no longer fit, the environment is made
anew; if only sources have changed, the package is built anew; one line says why. If all fit,
nothing is run and nothing is fetched. With --asked the Python that runs this is the wanted one.

It runs before anything is installed, so it needs the standard library only.
"""

import contextlib
import fcntl
import hashlib
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HOME = ROOT / ".venv"
STAMPS = HOME / "set-up"
PYTHON = "python"  # the stamp of the environment itself
PACKAGE = "package"  # that of the package's build
# What an installation copies or compiles; Python is read from the checkout.
BUILT_OF = (
    "setup.py",
    "setup.cfg",
    "build_kernel.py",
    "package.xml",
    "symtop_ros/__init__.py",
    "config/*.*",
    "launch/*.py",
    "resource/*",
    *(f"symtop_ros/physics/kernel/**/*.{suffix}" for suffix in ("cpp", "hpp", "h")),
)
LIBRARY = "symtop_ros/physics/kernel/libsymtop.*"
ZIG = re.search(r'ZIG = "(.+?)"', (ROOT / "build_kernel.py").read_text())[1]  # type: ignore[index]
# The first that needs no `wheel`; without a build environment pip asks for nothing from PyPI.
SETUPTOOLS = "setuptools>=70.1"
CONSTRAINTS = "test/constraints.txt"  # of the tools of tests, which a new version may turn red
TOOLS = ("pytest", "hypothesis", "mpmath", "python-flint", "rosbags", "coverage")
IDENTIFY = "import os, sys; print(f'Python {sys.version_info[0]}.{sys.version_info[1]}"
IDENTIFY += "{sys.abiflags} in {os.path.realpath(sys.base_prefix)}')"
# By a shell, as pip has it: a path with a blank cannot follow `#!`. To Python the lines are a text.
PROGRAM = """\
#!/bin/sh
'''exec' {python} "$0" "$@"
' '''
import sys

sys.path.insert(0, {root!r})
from symtop_ros.programs import {name}

sys.exit({name}())
"""
LITTLE = 1e9  # bytes of a disk that may be too few
PERIOD = 10.0  # s between two lines: pip may be silent for minutes


@dataclass(frozen=True)
class SetUp:
    """Packages, or the results of a script, that targets of make need."""

    what: str  # said while it is fetched
    extras: tuple[str, ...] = ()  # of setup.py, with which the package is installed
    packages: tuple[str, ...] = ()  # of PyPI
    programs: tuple[str, ...] = ()  # that run from the checkout, without an installation
    script: tuple[str, ...] = ()  # a command in the checkout
    made_of: tuple[str, ...] = ()  # files that decide what is made
    place: str = ""  # folder of a separate environment in .venv
    needs: tuple[str, ...] = ()  # other set-ups


def _fetch(name: str, what: str) -> SetUp:
    script = f"test/get_{name}.sh"
    return SetUp(what, script=("sh", script, f".venv/{name}"), made_of=(script,))


SET_UPS = {
    PYTHON: SetUp("Python"),
    # The page has the kernel as WebAssembly: it needs no compiler, and runs from the checkout.
    "panel": SetUp(
        "NumPy and PyYAML (about 100 MB, once)",
        packages=("numpy>=1.24", "pyyaml>=6.0"),
        programs=("top_panel",),  # all others need the compiled kernel, or ROS
    ),
    # What build_kernel.py imports; from Python 3.12 on an environment is made without it.
    "setuptools": SetUp("setuptools (once)", packages=(SETUPTOOLS,)),
    "ros": SetUp("ROS 2, NumPy, SciPy and Rerun (about 1 GB, once)", extras=("ros", "playback")),
    "report": SetUp("ROS 2, Rerun and plots (once)", extras=("ros", "playback", "report")),
    "peers": SetUp(
        "plots, and the programs to compare with (about 2 GB, once)",
        extras=("ros", "playback", "report", "peers"),
    ),
    "quick": SetUp(
        "ROS 2, NumPy, SciPy, Rerun, plots and tools of the quick tests (about 1.4 GB, once)",
        extras=("ros", "playback", "report", "test"),
        made_of=(CONSTRAINTS,),
    ),
    "test": SetUp(
        "tools for style, types and workspaces (about 0.1 GB, once)",
        extras=("ros", "playback", "report", "test", "lint"),
        made_of=(CONSTRAINTS,),
    ),
    "docs": SetUp("Sphinx (once)", extras=("ros", "playback", "docs")),
    "messages": SetUp(
        "messages that PyPI does not have (once)",
        script=(".venv/bin/python", "workshop/messages.py"),
        made_of=("workshop/messages.py", "test/interfaces/*/*/*"),
        needs=("test",),
    ),
    "vulkan": _fetch("vulkan", "a software Vulkan driver, for pictures without a screen (once)"),
    "chromium": _fetch("chromium", "a browser, for the tests of the page (once)"),
    "aarch64": _fetch("aarch64", "a compiler and an emulator for ARM (once)"),
    "wine": _fetch("wine", "Wine, for the kernel on Windows (100 MB, once)"),
    "js": SetUp(
        "TypeScript and Biome (210 MB, once)",
        script=("sh", "test/get_js.sh", ".venv/js", ".venv/bin/python"),
        made_of=("test/get_js.sh",),
    ),
    "zig": SetUp(
        "a compiler for wheels and WebAssembly (about 400 MB, once)",
        packages=(ZIG, SETUPTOOLS),
        place="zig",
    ),
    "gpu": SetUp(
        "NVIDIA's compilers, to look at what they make, and MuJoCo Warp (1.5 GB, once)",
        packages=(
            "nvidia-cuda-nvrtc==13.0.88",
            "nvidia-cuda-nvcc==13.0.88",
            "nvidia-cuda-cuobjdump==13.5.37",
            "nvidia-cuda-nvdisasm==13.5.37",
            "nvidia-cuda-nvrtc-cu12==12.9.86",
            "nvidia-cuda-nvcc-cu12==12.9.86",
            "mujoco-warp>=4",
            "numpy>=2",
            "pyyaml",
            "scipy",
        ),
        place="gpu",
    ),
    "fonts": SetUp("tools for fonts (once)", packages=("fonttools[woff]>=4.50",), place="fonts"),
    "importers": SetUp(
        "programs that read models (about 1 GB, once)",
        packages=("pybullet>=3.2.7", "newton>=1.8", "newton-usd-schemas", "usd-core>=26", "numpy"),
        place="importers",
    ),
    # It misread inertial frames of URDF (docs/truth_importers.md).
    "mujoco-3.12": SetUp(
        "an earlier MuJoCo (30 MB, once)",
        packages=("mujoco==3.12.0", "numpy"),
        place="mujoco-3.12",
    ),
    "ubuntu": SetUp(
        "ROS 2 Jazzy, NumPy 1.26 and pytest 7.4 (about 300 MB, once)",
        extras=("jazzy",),
        packages=("numpy<2", "pytest==7.4.4", *TOOLS),
        place="ubuntu",
    ),
    "kilted": SetUp(
        "ROS 2 Kilted (about 300 MB, once)", extras=("kilted",), packages=TOOLS, place="kilted"
    ),
}


class FailedError(Exception):
    """A set-up could not be made; the text says what to do."""


def main(words: list[str]) -> int:
    """Make the set-ups that are named, if their stamps do not fit."""
    is_asked = "--asked" in words
    names = [word for word in words if word != "--asked"]
    try:
        with _lock(PYTHON):
            _keep_environment(is_asked)
        for name in names:
            keep(name)
    except FailedError as error:
        _say(f"{error}{_find_lack()}")
        return 1
    except OSError as error:
        _say(f"{error.filename}: {error.strerror}{_find_lack()}")
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


def _find_lack() -> str:
    """Return what a place lacks that pip and venv write to, as a part of a sentence."""
    for folder in (ROOT, Path(tempfile.gettempdir())):
        if not os.access(folder, os.W_OK):
            return f"; {folder} may not be written to"
        free = shutil.disk_usage(folder).free
        if free < LITTLE:
            return f"; only {free / 1e6:.0f} MB are free in {folder}"
    return ""


def keep(name: str) -> None:
    """Make a set-up and those that it needs, unless they are there."""
    set_up = SET_UPS[name]
    for each in set_up.needs:
        keep(each)
    # two runs of pip would meet in one environment
    with _lock(name if set_up.script else f"packages{set_up.place}"):
        if _read(name) != _stamp(name):
            _make(name, set_up)
        elif set_up.extras and (reason := _find_fault_of_package(set_up.place)):
            _say(f"{reason}: it is built anew")
            _install(set_up.place, "--no-deps", "--quiet", "--editable", ".")
            _write(_package_of(set_up.place))


def _make(name: str, set_up: SetUp) -> None:
    print(f"Setting up {_relative(_folder(set_up.place))}: {set_up.what} ...", flush=True)
    if set_up.place:
        _make_environment(_folder(set_up.place))
    if set_up.script:
        _run(set_up.script, f"{set_up.what} could not be made (the reason is above)")
    elif set_up.extras:
        _install(set_up.place, SETUPTOOLS, "--quiet")
        extras = f".[{','.join(set_up.extras)}]"
        pins = ("--constraint", CONSTRAINTS) if CONSTRAINTS in set_up.made_of else ()
        _install(set_up.place, "--editable", extras, *set_up.packages, *pins)
        _write(_package_of(set_up.place))
    elif set_up.packages:
        _install(set_up.place, *set_up.packages)
    for program in set_up.programs:
        _write_program(program)
    _write(name)
    for other in _list_contained(set_up):
        _write(other)


def _write_program(name: str) -> None:
    """Write a program that runs from the checkout, unless pip has installed it."""
    path = HOME / "bin" / name
    if path.exists():
        return
    path.write_text(
        PROGRAM.format(python=shlex.quote(str(HOME / "bin/python")), root=str(ROOT), name=name)
    )
    path.chmod(0o755)


def _list_contained(set_up: SetUp) -> list[str]:
    """Return the set-ups that are there with one of more extras."""
    return [
        name
        for name, each in SET_UPS.items()
        if each.place == set_up.place and {*each.extras} <= {*set_up.extras} and each.extras
    ]


def _keep_environment(is_asked: bool) -> None:
    """Make .venv, if it does not belong to this path and this Python."""
    if HOME.exists():
        if not (reason := _find_fault_of_environment(is_asked)):
            return
        _say(f".venv {reason}: it is made anew")
    print("Setting up .venv: Python ...", flush=True)
    _make_environment(HOME)
    _write(PYTHON)


def _find_fault_of_environment(is_asked: bool) -> str:
    stamp = _read(PYTHON)
    inside = _identify(HOME / "bin/python")
    if not stamp:
        return "was not completed, or is of an earlier version"
    if stamp["path"] != str(ROOT):
        return f"was made in {stamp['path']}"
    if stamp["python"] != inside:
        return f"was made of {stamp['python']}, which is {inside or 'gone'} now"
    if is_asked and (wanted := _identify(Path(sys.executable))) != inside:
        return f"has {inside}, and PYTHON is {wanted}"
    return ""


def _find_fault_of_package(place: str) -> str:
    """Return why the package must be built anew: pip may have put a copy in its place."""
    files = _folder(place).glob("lib/python*/site-packages/symtop_ros-*/direct_url.json")
    found = [json.loads(path.read_text())["dir_info"] for path in files]
    if not found:
        return "the package is not installed"
    if {"editable": True} not in found:
        return "the package was installed as a copy, which changes of the checkout do not reach"
    if not [*ROOT.glob(LIBRARY)]:
        return "the compiled kernel is missing"
    if _read(_package_of(place)) != _stamp(_package_of(place)):
        return "sources of the package have changed"
    return ""


def _make_environment(folder: Path) -> None:
    # Not that of an environment, which may be the one that is cleared; after an upgrade of the
    # distribution an environment names a Python that is gone.
    base = Path(getattr(sys, "_base_executable", sys.executable))
    python = str(base if base.exists() else Path(sys.executable).resolve())
    advice = f"{python} -m venv failed (Debian and Ubuntu: apt install python3-venv)"
    if not os.access(ROOT, os.W_OK):
        raise FailedError("the environment cannot be made")
    if folder.is_symlink():  # to the environment of another checkout, which is left alone
        folder.unlink()
    shutil.rmtree(folder, ignore_errors=True)
    _run((python, "-m", "venv", "--clear", str(folder)), advice)


def _install(place: str, *words: str) -> None:
    """Run pip in an environment. It fetches nothing that is there, the build's tools included."""
    python = str(_folder(place) / "bin/python")
    options = ["--no-compile", "--disable-pip-version-check"]  # 0.1 GB less than with all compiled
    if "--editable" in words and _has_compiler(python):
        options.append("--no-build-isolation")
    advice = "pip could not install what is missing (its reason is above; it may need a network)"
    _run((python, "-m", "pip", "install", *options, *words), advice)


def _has_compiler(python: str) -> bool:
    """Return False where the build has to fetch a compiler, into a separate environment."""
    code = "import sys, build_kernel; sys.exit(not build_kernel.find_compiler())"
    done = subprocess.run(
        [python, "-c", code], cwd=ROOT, env=_environment(), capture_output=True, check=False
    )
    return done.returncode == 0


def _run(words: tuple[str, ...], advice: str) -> None:
    with _ticking():
        # A session of its own: Ctrl-C would have each Python of it print a traceback.
        process = subprocess.Popen(words, cwd=ROOT, env=_environment(), start_new_session=True)
        try:
            status = process.wait()
        except KeyboardInterrupt:
            os.killpg(process.pid, signal.SIGTERM)
            process.wait()
            raise
    if status:
        raise FailedError(advice)


def _environment() -> dict[str, str]:
    """Return the variables without those by which another environment reaches into this one."""
    foreign = ("PYTHONPATH", "PYTHONHOME", "PYTHONSAFEPATH", "PIP_REQUIRE_VIRTUALENV")
    kept = {name: text for name, text in os.environ.items() if name not in foreign}
    return {**kept, "PIP_USER": "0"}


def _identify(python: Path) -> str:
    """Return version and place of a Python, "" if it does not run."""
    try:
        done = subprocess.run(
            [str(python), "-IS", "-c", IDENTIFY], capture_output=True, text=True, check=False
        )
    except OSError:
        return ""
    return done.stdout.strip()


def _stamp(name: str) -> dict[str, str]:
    """Return the stamp that a set-up must have."""
    digest = hashlib.sha256()
    if name in SET_UPS:
        set_up = SET_UPS[name]
        decides = (set_up.extras, set_up.packages, set_up.script, *set_up.programs)
        digest.update(repr(decides).encode())
        patterns = (*set_up.made_of, *(["setup.py"] if set_up.extras else []))
    else:
        patterns = BUILT_OF
    for path in sorted({path for each in patterns for path in ROOT.glob(each) if path.is_file()}):
        digest.update(f"{path.relative_to(ROOT).as_posix()}\0".encode() + path.read_bytes())
    python = _identify(HOME / "bin/python")
    return {"path": str(ROOT), "python": python, "digest": digest.hexdigest()}


def _read(name: str) -> dict[str, str]:
    try:
        return dict(json.loads((STAMPS / f"{name}.json").read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return {}


def _write(name: str) -> None:
    STAMPS.mkdir(parents=True, exist_ok=True)
    text = json.dumps(_stamp(name), indent=1, ensure_ascii=False)
    (STAMPS / f"{name}.json").write_text(f"{text}\n", encoding="utf-8")


@contextlib.contextmanager
def _lock(name: str) -> Iterator[None]:
    """Let one run at a time make a set-up: groups of tests ask for the same ones."""
    # The environment, with its files, may be removed.
    with Path(__file__).open() if name == PYTHON else (STAMPS / f"{name}.lock").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


@contextlib.contextmanager
def _ticking() -> Iterator[None]:
    done = threading.Event()

    def tick() -> None:
        seconds = 0.0
        while not done.wait(PERIOD):
            seconds += PERIOD
            print(f"  ... at work for {seconds:.0f} s", flush=True)

    thread = threading.Thread(target=tick, daemon=True)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join()


def _folder(place: str) -> Path:
    return HOME / place if place else HOME


def _package_of(place: str) -> str:
    return f"{PACKAGE}-{place}" if place else PACKAGE


def _relative(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def _say(text: str) -> None:
    print(f"make: {text}", flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
