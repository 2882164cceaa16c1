"""Builds the kernel as a plain shared library, and asks for a compiler if there is no compiler.

`setup.py` compiles by this file, and pip reads it as the backend of the build (PEP 517): it adds
Zig, a C++ compiler on PyPI, to what a wheel needs if no other was found. The library is reached by
ctypes, so it needs no header of Python, and one serves every version.
"""

import hashlib
import os
import shlex
import subprocess
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from sysconfig import get_platform
from tempfile import TemporaryDirectory

from setuptools import build_meta
from setuptools.build_meta import *  # noqa: F403  the other hooks of the backend
from setuptools.command.build_ext import build_ext
from setuptools.errors import CompileError

KERNEL = Path("symtop_ros/physics/kernel")
SOURCE = "symtop.cpp"
# No fused products and sums, so that states have the same bits on every machine
# (design/fused_products.py). -fno-fast-math stands behind all that CXXFLAGS may say. -O3 would
# change no bit, and no time but that of a set-up (5 % less), with a library larger by a seventh.
OPTIONS = (
    "-O2",
    "-std=c++17",
    "-fno-fast-math",
    "-ffp-contract=off",
    "-fno-exceptions",
    "-fno-rtti",
    "-fPIC",
    "-shared",
    "-fvisibility=hidden",
    "-Wno-psabi",
    "-DSYMTOP_SHARED",
)
ZIG = "ziglang==0.15.2"  # pinned: another Zig is another compiler
TRIAL = "#include <mutex>\nint main() {}\n"
NO_COMPILER = (
    "symtop_ros needs a C++ compiler: install g++ or clang (Debian and Ubuntu: apt install g++), "
    f"or {ZIG.partition('==')[0]} from PyPI, or name one by CXX"
)


def _works(compiler: list[str]) -> bool:
    """Return True if a compiler runs and has the headers of C++: a g++ may be there without."""
    command = [*compiler, "-std=c++17", "-fsyntax-only", "-x", "c++", "-"]
    try:
        done = subprocess.run(command, input=TRIAL, text=True, capture_output=True, check=False)
    except OSError:
        return False
    return done.returncode == 0


@cache
def find_compiler() -> list[str] | None:
    """Return the command of a C++ compiler, or None. A CXX is taken at its word."""
    if given := shlex.split(os.environ.get("CXX", "")):
        return given
    for name in ("c++", "g++", "clang++"):
        if _works([name]):
            return [name]
    if find_spec("ziglang"):
        # Without a processor Zig would compile for this very one.
        return [sys.executable, "-m", "ziglang", "c++", "-mcpu=baseline"]
    return None


def digest_sources() -> str:
    """Return the digest of the sources, which the library holds and its loader compares."""
    digest = hashlib.sha256()
    for path in sorted(each for each in KERNEL.rglob("*") if each.suffix in (".cpp", ".hpp", ".h")):
        digest.update(f"{path.relative_to(KERNEL).as_posix()}\0".encode() + path.read_bytes())
    return digest.hexdigest()[:32]


def list_flags() -> list[str]:
    """Return what CXXFLAGS, LDFLAGS and this file say, in this order: the last one decides."""
    words = [os.environ.get(name, "") for name in ("CPPFLAGS", "CXXFLAGS", "LDFLAGS")]
    return [*(flag for each in words for flag in shlex.split(each)), *OPTIONS]


class BuildKernel(build_ext):
    """Compiles the kernel with one command; unchanged sources and flags are not compiled again."""

    def get_ext_filename(self, fullname: str) -> str:
        """Return the file name without the tag of a version of Python."""
        suffix = {"win": ".dll", "mac": ".dylib"}.get(get_platform()[:3], ".so")
        return str(Path(*fullname.split(".")).with_suffix(suffix))

    def get_export_symbols(self, _ext: object) -> list[str]:
        """Return no names: the library is no module of Python."""
        return []

    def build_extension(self, ext: object) -> None:
        """Compile the library, and replace the one that is there."""
        target = Path(self.get_ext_fullpath(ext.name)).absolute()  # type: ignore[attr-defined]
        flags = list_flags()
        if target.suffix == ".dylib":  # which is named by its place otherwise
            flags.append(f"-Wl,-install_name,@rpath/{target.name}")
        built_of = (
            f"{digest_sources()} {hashlib.sha256(shlex.join(flags).encode()).hexdigest()[:16]}"
        )
        if target.exists() and built_of.encode() in target.read_bytes():
            return
        compiler = find_compiler()
        if not compiler:
            raise CompileError(NO_COMPILER)
        target.parent.mkdir(parents=True, exist_ok=True)
        # Next to it: a library that is in use stays whole, and other results of a compiler go.
        with TemporaryDirectory(dir=target.parent) as folder:
            part = Path(folder, target.name)
            # From this folder, so that no path of this machine gets into the library.
            if self.verbose:  # seen by `pip -v`
                print(f"symtop_ros: compiling the kernel with {shlex.join(compiler)}", flush=True)
            command = [*compiler, *flags, f'-DSYMTOP_DIGEST="{built_of}"', SOURCE, "-o", str(part)]
            try:
                subprocess.run(command, cwd=KERNEL, check=True)
            except (OSError, subprocess.CalledProcessError) as error:
                target.unlink(missing_ok=True)  # an older library would only be refused
                raise CompileError(f"the C++ compiler refused the kernel: {error}") from error
            part.replace(target)


def _list_needs() -> list[str]:
    if find_compiler():
        return []
    print(f"symtop_ros: no C++ compiler was found; {ZIG} is fetched (100 MB) to build with")
    return [ZIG]


def get_requires_for_build_wheel(config_settings: dict[str, str] | None = None) -> list[str]:
    """Return what a wheel needs to be built."""
    return [*build_meta.get_requires_for_build_wheel(config_settings), *_list_needs()]


def get_requires_for_build_editable(config_settings: dict[str, str] | None = None) -> list[str]:
    """Return what an editable installation needs to be built."""
    return [*build_meta.get_requires_for_build_editable(config_settings), *_list_needs()]
