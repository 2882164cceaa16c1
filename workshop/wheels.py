"""Wheels with the compiled kernel: `make wheels` runs this with the Python of .venv/zig.

    python workshop/wheels.py [FOLDER]

A wheel for each platform is built from the checkout, with Zig as a compiler that brings the headers
and the libraries of all of them. Those for Linux need an old C library: they run on every Linux of
the last years, and all on any Python from 3.11 on. Only the standard library is needed here.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[1]
# Zig's name of each platform, by Python's. manylinux_2_28 is that of Debian 10's C library.
TARGETS = {
    "manylinux_2_28_x86_64": "x86_64-linux-gnu.2.28",
    "manylinux_2_28_aarch64": "aarch64-linux-gnu.2.28",
    "macosx-11.0-arm64": "aarch64-macos.11.0",
    "macosx-11.0-x86_64": "x86_64-macos.11.0",
    "win-amd64": "x86_64-windows-gnu",
}

# Of a checkout: an environment, and what an earlier build left, which may be of other files.
LEFT_OUT = shutil.ignore_patterns(
    ".*", "build", "install", "*.egg-info", "libsymtop.*", "__pycache__"
)


def build(source: Path, platform: str, folder: Path) -> Path:
    """Build the wheel for a platform; return its path."""
    compiler = f"{sys.executable} -m ziglang c++ -target {TARGETS[platform]}"
    # No symbols: a tenth of the size. Options for the compiler of this machine are not for Zig.
    options = {"CXXFLAGS": "-s", **dict.fromkeys(("CPPFLAGS", "LDFLAGS"), "")}
    subprocess.run(
        [
            sys.executable,
            "-m",
            "pip",
            "wheel",
            "--quiet",
            "--no-deps",
            "--wheel-dir",
            folder,
            "--no-build-isolation",
            source,
        ],
        # What Python says of its machine: the name of the wheel, and of the library, follow it.
        env=os.environ | {"CXX": compiler, "_PYTHON_HOST_PLATFORM": platform} | options,
        check=True,
    )
    tag = re.sub(r"[-.]", "_", platform)
    (wheel,) = folder.glob(f"symtop_ros-*-py3-none-{tag}.whl")
    return wheel


def main() -> None:
    """Build the wheels into a folder, by default dist/."""
    folder = Path(sys.argv[1] if sys.argv[1:] else ROOT / "dist").absolute()
    folder.mkdir(parents=True, exist_ok=True)
    for platform in TARGETS:
        with TemporaryDirectory() as place:
            source = shutil.copytree(ROOT, Path(place) / "source", ignore=LEFT_OUT)
            wheel = build(source, platform, folder)
        print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB", flush=True)


if __name__ == "__main__":
    main()
