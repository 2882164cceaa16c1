"""Wheels with the compiled kernel: `make wheels` runs this with the Python of .venv/zig.

    python workshop/wheels.py [FOLDER]

A wheel for each processor is built from the checkout, with Zig as a compiler that brings the
headers and the libraries of an old C library: it runs on every Linux of the last years, and on any
Python from 3.11 on. Only the standard library is needed here.
"""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[1]
GLIBC = (2, 28)  # of Debian 10 and of the platform manylinux_2_28
PROCESSORS = ("x86_64", "aarch64")
KERNEL = "symtop_ros/physics/kernel/libsymtop.so"

# Of a checkout: an environment, and what an earlier build left, which may be of other files.
LEFT_OUT = shutil.ignore_patterns(".*", "build", "install", "*.egg-info", "*.so", "__pycache__")


def build(source: Path, processor: str, folder: Path) -> Path:
    """Build the wheel for a processor; return its path."""
    platform = f"manylinux_{GLIBC[0]}_{GLIBC[1]}_{processor}"
    subprocess.run(
        [
            *(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", folder),
            *("--no-build-isolation", f"--config-settings=--build-option=--plat-name={platform}"),
            source,
        ],
        env=os.environ | compilers(processor),
        check=True,
    )
    (wheel,) = folder.glob(f"symtop_ros-*-py3-none-{platform}.whl")
    if KERNEL not in zipfile.ZipFile(wheel).namelist():
        raise SystemExit(f"{wheel.name} has no kernel: the compiler said why")
    return wheel


def compilers(processor: str) -> dict[str, str]:
    """Return the variables by which build_kernel.py finds Zig."""
    target = f"{processor}-linux-gnu.{GLIBC[0]}.{GLIBC[1]}"
    compiler = f"{sys.executable} -m ziglang c++ -target {target}"
    # No symbols: a tenth of the size. Options for the compiler of this machine are not for Zig.
    return {"CXX": compiler, "CXXFLAGS": "-s", **dict.fromkeys(("CPPFLAGS", "LDFLAGS"), "")}


def main() -> None:
    """Build the wheels into a folder, by default dist/."""
    folder = Path(sys.argv[1] if sys.argv[1:] else ROOT / "dist").absolute()
    folder.mkdir(parents=True, exist_ok=True)
    for processor in PROCESSORS:
        with TemporaryDirectory() as place:
            source = shutil.copytree(ROOT, Path(place) / "source", ignore=LEFT_OUT)
            wheel = build(source, processor, folder)
        print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
