"""The file of the compiled kernel: where it is, and why it cannot be used."""

import ctypes
import hashlib
import os
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parent
FILE = FOLDER / f"libsymtop{ {'win32': '.dll', 'darwin': '.dylib'}.get(sys.platform, '.so') }"
SOURCES = (".cpp", ".hpp", ".h")
ROOT = FOLDER.parents[2]  # a checkout, or where packages are installed
BUILD = "`pip install -e .`"


class UnfitError(Exception):
    """A library is there and cannot be used; the text says why."""


def load_library() -> ctypes.CDLL:
    """Return the library of this folder, or that of an installed copy with the same sources.

    In a checkout Python imports its package and not the copy that `pip install .` or colcon has
    put elsewhere, with the compiled kernel.

    Raises
    ------
    ImportError
        If there is none that fits.
    """
    if FILE.exists():
        try:
            return _open(FILE)
        except UnfitError as error:
            raise ImportError(f"{error}: {_name_remedy()}") from None
    unfit = ""
    for path in _list_installed():
        try:
            return _open(path)
        except UnfitError as error:
            unfit = unfit or f", and {error}"
    raise ImportError(f"no compiled kernel is in {FOLDER}{unfit}: {_name_remedy()}")


def _open(path: Path) -> ctypes.CDLL:
    digest = f"symtop {digest_sources()}".encode()
    try:
        library = ctypes.CDLL(str(path))
        if (ctypes.c_char * len(digest)).in_dll(library, "symtop_digest").value == digest:
            return library
    except OSError as error:
        raise UnfitError(f"the compiled kernel {path} cannot be loaded ({error})") from None
    except ValueError:  # it has no such variable
        pass
    raise UnfitError(f"the compiled kernel {path} was built from other sources")


def _list_installed() -> Iterator[Path]:
    """Yield the libraries of other copies of the package that Python would import."""
    for entry in sys.path:
        path = Path(entry, *FILE.relative_to(ROOT).parts)
        # unlike Path.exists, False for a folder that may not be read
        if os.path.isfile(path) and not path.parent.samefile(FOLDER):
            yield path


def _name_remedy() -> str:
    if (ROOT / "setup.py").exists():
        return f"{BUILD} in {ROOT} builds it"
    return f"install symtop_ros again, from a checkout by {BUILD}"


@cache
def digest_sources() -> str:
    """Return the digest of the kernel's sources, as build_kernel.py finds it."""
    digest = hashlib.sha256()
    for path in sorted(each for each in FOLDER.rglob("*") if each.suffix in SOURCES):
        digest.update(f"{path.relative_to(FOLDER).as_posix()}\0".encode() + path.read_bytes())
    return digest.hexdigest()[:32]
