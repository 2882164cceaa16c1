"""The head of records in JSON: schema, version, and digests of the files."""

from collections.abc import Iterator, Sequence
from hashlib import file_digest
from pathlib import Path
from typing import Any

from symtop_ros import __version__


def make_header(kind: str, files: Sequence[Path]) -> dict[str, Any]:
    """Return the schema of a kind of record, the version of the program, and digests of files.

    Examples
    --------
    >>> from symtop_ros.base.header import make_header
    >>> make_header("judge", [])["schema"]
    'symtop_ros/judge/1'
    """
    digests = [each for path in files for each in _digest(path)]
    return {"schema": f"symtop_ros/{kind}/1", "version": __version__, "files": digests}


def _digest(path: Path) -> Iterator[dict[str, str]]:
    """Yield the digest of a file, or of each file of a folder."""
    for each in sorted(path.rglob("*")) if path.is_dir() else [path]:
        if each.is_file():
            with each.open("rb") as file:
                yield {"name": str(each), "sha256": file_digest(file, "sha256").hexdigest()}
