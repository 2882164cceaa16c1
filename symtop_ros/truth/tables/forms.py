"""The form of a file by its first bytes: names of files may end in anything."""

from pathlib import Path

from symtop_ros.base.refusals import RefusedError

SOME = 4096  # bytes that are looked at
LOGS = (b"\x89MCAP0\r\n", b"SQLite format 3\0")
SUFFIXES = (".zst", ".zstd", ".gz", ".bz2", ".xz", ".zip")
# First bytes of what has to be unpacked, with what to type.
PACKED = {
    b"\x28\xb5\x2f\xfd": "zstd -dc",
    b"\x1f\x8b": "gzip -dc",
    b"BZh": "bzip2 -dc",
    b"\xfd7zXZ\0": "xz -dc",
    b"PK\x03\x04": "unzip -p",
}


def name_unpacked(path: Path) -> str:
    """Return a name for what is in a packed file, which may end as if it were not packed."""
    if path.suffix in SUFFIXES:
        return path.stem
    return f"unpacked{path.suffix}"


def is_table(path: Path) -> bool:
    """Return True for a file of text, False for a log or a folder; refuse what is packed.

    A file that is not there is a log if it ends so; the reader says that it is missing.
    """
    if not path.is_file():
        return not path.is_dir() and path.suffix != ".mcap"
    try:
        with path.open("rb") as file:
            first = file.read(SOME)
    except OSError as error:
        raise RefusedError(f"cannot open {path}: {error.strerror}") from None
    for magic, words in PACKED.items():
        if first.startswith(magic):
            what = f"{path} must be a log or a table, got a packed file"
            raise RefusedError(f"{what}: {words} {path} > {name_unpacked(path)}")
    return not first.startswith(LOGS) and b"\0" not in first
