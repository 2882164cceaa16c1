"""The format of a file, recognised by its first bytes instead of its name."""

from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE
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
# Packed folders with a meaning of their own, by a name within their first bytes.
WORKBOOKS = {
    b"[Content_Types].xml": "a workbook of Excel: save it as CSV",
    b"xl/": "a workbook of Excel: save it as CSV",
    b"opendocument.spreadsheet": "a workbook of LibreOffice: save it as CSV",
    b".npy": "arrays of NumPy: write them with numpy.savetxt",
}
BINARY = {
    b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1": "a workbook of Excel: save it as CSV",
    b"\x93NUMPY": "an array of NumPy: write it with numpy.savetxt",
    b"\x89HDF\r\n\x1a\n": "a file of HDF5 or of MATLAB: write its arrays as CSV",
    b"MATLAB ": "a file of MATLAB: write its arrays with writematrix",
    b"PAR1": "a file of Parquet: write it as CSV",
    b"ARROW1": "a file of Arrow: write it as CSV",
    b"#ROSBAG V": "a bag of ROS 1: rostopic echo -p writes a topic as CSV",
    b"\x1aE\xdf\xa3": "a film: click its frames on the page, or in Tracker",
    b"RIFF": "a film: click its frames on the page, or in Tracker",
    b"\x89PNG": "a picture",
    b"\xff\xd8\xff": "a picture",
    b"GIF8": "a picture",
    b"%PDF": "a document",
}
FILM, AT = b"ftyp", slice(4, 8)  # of MP4 and MOV
UTF16 = (BOM_UTF16_LE, BOM_UTF16_BE)  # as Excel writes "Unicode text"


def name_unpacked(path: Path) -> str:
    """Return a file name for the content of a compressed file."""
    if path.suffix in SUFFIXES:
        return path.stem
    return f"unpacked{path.suffix}"


def read_start(path: Path) -> bytes:
    """Return the first bytes of a file."""
    try:
        with path.open("rb") as file:
            return file.read(SOME)
    except OSError as error:
        raise RefusedError(f"cannot open {path}: {error.strerror}") from None


def is_table(path: Path) -> bool:
    """Return True for a file of text, False for a log or a folder; refuse what is packed or binary.

    A missing file counts as a log if its name ends like one; the reader then reports that it is
    missing.
    """
    if not path.is_file():
        return not path.is_dir() and path.suffix != ".mcap"
    first = read_start(path)
    if first.startswith(LOGS):
        return False
    refuse_binary(path, first)
    return first.startswith(UTF16) or b"\0" not in first


def refuse_binary(path: Path, first: bytes) -> None:
    """Refuse a file that is neither text nor a log, and name its kind."""
    what = f"{path} must be a log or a table, got"
    for magic, words in PACKED.items():
        if first.startswith(magic):
            for name, kind in WORKBOOKS.items():
                if name in first:
                    raise RefusedError(f"{what} {kind}")
            raise RefusedError(f"{what} a packed file: {words} {path} > {name_unpacked(path)}")
    found = next((kind for magic, kind in BINARY.items() if first.startswith(magic)), "")
    if first[AT] == FILM:
        found = BINARY[b"RIFF"]
    if found:
        raise RefusedError(f"{what} {found}")


def find_encoding(path: Path, first: bytes) -> str:
    """Return how the text of a file is written: UTF-8, UTF-16 by its mark, or that of Windows.

    Excel writes the degree sign of a unit as one byte; such text is no UTF-8.
    """
    refuse_binary(path, first)
    if first.startswith(UTF16):
        return "utf-16"
    if b"\0" in first:
        raise RefusedError(f"cannot read {path}: not a table of text, but binary")
    try:
        first[: first.rfind(b"\n") + 1].decode("utf-8")
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8-sig" if first.startswith(BOM_UTF8) else "utf-8"
