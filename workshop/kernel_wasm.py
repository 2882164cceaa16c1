"""The kernel in WebAssembly: `make kernel-wasm` runs this with the Python of .venv/zig.

    python workshop/kernel_wasm.py [FILE]

The module is kept in the package, because few have its compiler. With it goes the digest of what it
was built from: a test fails if that has changed since. Only the standard library is needed here.
"""

import hashlib
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / "symtop_ros/physics/kernel"
MODULE = ROOT / "symtop_ros/page/web/kernel.wasm"
DIGEST = MODULE.with_suffix(".sha256")  # of the sources and of the command
# The functions of the header: one that is added there is exported here.
FUNCTIONS = re.findall(r"^SYMTOP_API .*?symtop_(\w+)\(", (SOURCES / "symtop.h").read_text(), re.M)
# Vectors of WebAssembly would take 1.4 instead of 2.5 ms for 10 s of friction, and 70 instead of
# 90 ns for a state without; browsers of before 2023 have none. With -O2 it would be a fifth larger,
# set-up and states a tenth faster, and friction slower.
OPTIONS = (
    "-target",
    "wasm32-wasi",
    "-mexec-model=reactor",
    "-Os",
    "-std=c++17",
    "-ffp-contract=off",
    "-fno-exceptions",
    "-fno-rtti",
    "-Wno-psabi",
    "-Wl,--strip-all",
    "-Wl,--export=malloc",
    "-Wl,--export=free",
    *(f"-Wl,--export=symtop_{name}" for name in FUNCTIONS),
)


def digest_sources() -> str:
    """Return the digest of the kernel's sources without Python's module, and of the options."""
    paths = [*SOURCES.rglob("*.h*"), SOURCES / "symtop.cpp"]
    digest = hashlib.sha256(" ".join(OPTIONS).encode())
    for path in sorted(paths):
        digest.update(f"{path.relative_to(SOURCES)}\0".encode() + path.read_bytes())
    return digest.hexdigest()


def build(target: Path) -> None:
    """Compile the module."""
    compiler = (sys.executable, "-m", "ziglang", "c++")
    # From this folder, so that no path of this machine gets into the module.
    subprocess.run([*compiler, *OPTIONS, "symtop.cpp", "-o", target], cwd=SOURCES, check=True)


def main() -> None:
    """Build the module into a file, by default that of the package with its digest."""
    target = Path(sys.argv[1] if sys.argv[1:] else MODULE).absolute()
    build(target)
    if target == MODULE:
        DIGEST.write_text(digest_sources() + "\n")
    print(f"{target.name}: {target.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
