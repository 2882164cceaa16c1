"""The kernel as one header and one source: `make -C workshop drop-in` runs this.

    python -m workshop.drop_in.write [FOLDER]

FOLDER/symtop-VERSION, by default in dist/, gets symtop.h unchanged, symtop.cpp with the headers of
the kernel inside it, and the files that lie here: an example in C, a README that shows it, and what
CMake and pkg-config need.
"""

import re
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

from build_kernel import KERNEL, OPTIONS, SOURCE

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
SOURCES = ROOT / KERNEL
HEADER = SOURCES / "symtop.h"
(VERSION,) = re.findall(r'^#define SYMTOP_VERSION "(.+)"$', HEADER.read_text(), re.M)
FILES = ("README.md", "CMakeLists.txt", "symtop-config.cmake.in", "symtop.pc.in", "example.c")
# CMake has its own words for these, and a static library takes no -shared.
SAID_BY_CMAKE = ("-std=", "-fPIC", "-shared")
LOCAL_INCLUDE = re.compile(r'^#include "(.+)"\n', re.M)
SYSTEM_INCLUDE = re.compile(r"^#include <.+>\n", re.M)
# The pragma is for those who drop the file into a tree whose options are not theirs to choose:
# compilers warn of vectors in calls, which are all inlined.
HEAD = f"""\
// symtop {VERSION}: the motion of the heavy symmetric top, in one file. See symtop.h and README.md.
// SPDX-License-Identifier: Apache-2.0
//
// Compile it as C++17 with -ffp-contract=off and without fast-math. It is written from the sources
// of symtop_ros, where each part below a line of dashes is a file: change it there.
#ifdef __GNUC__
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
#include "symtop.h"
"""


def inline(path: Path, seen: set[Path]) -> Iterator[str]:
    """Yield a source in one piece, after those of the kernel that it is the first to include."""
    *heads, body = LOCAL_INCLUDE.split(path.read_text())
    before = "".join(heads[::2])
    names = heads[1::2]
    # These come first, as they do there: a header may rest on what is included before it.
    yield from SYSTEM_INCLUDE.findall(before)
    for header in [(path.parent / name).resolve() for name in names]:
        if header not in seen:
            seen.add(header)
            yield from inline(header, seen)
    yield f"\n// ---- {path.relative_to(SOURCES).as_posix()} ----\n\n"
    yield (SYSTEM_INCLUDE.sub("", before) + body).replace("#pragma once\n", "")


def join() -> str:
    """Return the whole kernel but symtop.h as one source."""
    text = HEAD + "".join(inline(SOURCES / SOURCE, {HEADER}))
    return re.sub(r"\n{3,}", "\n\n", text)


def fill(name: str) -> str:
    """Return a file that lies here, with the version, the options and the example in its places."""
    options = " ".join(each for each in OPTIONS if not each.startswith(SAID_BY_CMAKE))
    values = {"SYMTOP": VERSION, "OPTIONS": options, "EXAMPLE": (HERE / "example.c").read_text()}
    # others are for CMake
    return re.sub("@([A-Z]+)@", lambda found: values[found[1]], (HERE / name).read_text())


def write(folder: Path) -> Path:
    """Write all files into a new folder; return its path."""
    target = folder / f"symtop-{VERSION}"
    target.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(HEADER, target / HEADER.name)  # without the rights of a read-only checkout
    shutil.copyfile(ROOT / "LICENSE", target / "LICENSE")
    (target / SOURCE).write_text(join())
    for name in FILES:
        (target / name).write_text(fill(name))
    return target


if __name__ == "__main__":
    print(f"wrote {write(Path(sys.argv[1] if sys.argv[1:] else 'dist'))}")
