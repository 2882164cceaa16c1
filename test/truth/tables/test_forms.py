"""Files are told by their first bytes, whatever their names end in."""

import gzip
import subprocess

import pytest

from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.tables.forms import is_table

ROWS = b"t,w,x,y,z\n0,1,0,0,0\n"
PACKED = {
    "run.mcap.zst": (b"\x28\xb5\x2f\xfd", "zstd -dc {0} > run.mcap"),
    "run.mcap": (b"\x28\xb5\x2f\xfd", "zstd -dc {0} > unpacked.mcap"),
    "run.csv.gz": (b"\x1f\x8b", "gzip -dc {0} > run.csv"),
    "run.csv": (b"\x1f\x8b", "gzip -dc {0} > unpacked.csv"),
    "run.bz2": (b"BZh", "bzip2 -dc {0} > run"),
    "run.xz": (b"\xfd7zXZ\0", "xz -dc {0} > run"),
    "run.zip": (b"PK\x03\x04", "unzip -p {0} > run"),
}


@pytest.mark.parametrize("name", PACKED)
def test_what_is_packed_is_refused_with_what_to_type(name, tmp_path):
    path = tmp_path / name
    magic, words = PACKED[name]
    path.write_bytes(magic + b"more")
    with pytest.raises(RefusedError) as refused:
        is_table(path)
    assert str(refused.value).endswith(f"got a packed file: {words.format(path)}")


def test_the_line_unpacks_a_table(tmp_path):
    path = tmp_path / "run.csv"
    path.write_bytes(gzip.compress(ROWS))
    with pytest.raises(RefusedError) as refused:
        is_table(path)
    words = str(refused.value).partition("a packed file: ")[2]
    subprocess.run(words, shell=True, check=True, cwd=tmp_path)
    assert (tmp_path / "unpacked.csv").read_bytes() == ROWS


@pytest.mark.parametrize(
    ("content", "expected"),
    [(ROWS, True), (b"\x89MCAP0\r\n", False), (b"SQLite format 3\0", False), (b"a\0b", False)],
)
@pytest.mark.parametrize("name", ["run.mcap", "run.csv", "run.db3", "run"])
def test_tables_and_logs_may_have_any_name(content, expected, name, tmp_path):
    path = tmp_path / name
    path.write_bytes(content)
    assert is_table(path) is expected
