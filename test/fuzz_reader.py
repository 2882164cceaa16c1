"""Coverage-guided fuzzing of the log reader, by hand: pip install atheris, then

    python test/fuzz_reader.py -max_total_time=600 -rss_limit_mb=2048 -timeout=20 FOLDER

FOLDER collects inputs that reach something new. Each is read, checked and repaired; whatever else
than a sentence comes of it ends the run, and the input is kept in a file crash-*.
"""

import contextlib
import io
import struct
import sys
import tempfile
import zlib
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["symtop_ros", "mcap"]):
    from log_files import Run

    from symtop_ros.log import reader
    from symtop_ros.playback.main import main

SMALL = Run(seconds=0.1, rate=50.0)
CHUNK = struct.Struct("<QQQI")  # times, size and CRC; no compression and the data follow


def chunked(data):
    """A log whose only chunk holds the data, so that no CRC is in the way."""
    head = CHUNK.pack(0, 1, len(data), zlib.crc32(data)) + struct.pack("<I", 0)
    body = head + struct.pack("<Q", len(data)) + data
    return reader.MAGIC + reader.RECORD_START.pack(6, len(body)) + body


def read(data):
    with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
        path = Path(folder, "log.mcap")
        path.write_bytes(chunked(data[1:]) if data[:1] == b"c" else reader.MAGIC + data[1:])
        for way in (["--check"], ["--repair", f"{folder}/whole.mcap"]):
            told = io.StringIO()
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(told):
                status = main([str(path), *way])
            assert status in (0, 1)
            assert all(line.isprintable() for line in told.getvalue().splitlines())


def seeds(folder):
    """Begin with a log, whole and as the records of a chunk."""
    with tempfile.TemporaryDirectory() as logs:
        file = reader.McapFile(SMALL.write(Path(logs)))
        whole = file.path.read_bytes()
        (folder / "whole").write_bytes(b"w" + whole[len(reader.MAGIC) :])
        with file.path.open("rb") as stream:
            stream.seek(len(reader.MAGIC))
            chunks = [record.data for record in file._records(stream) if record.opcode == 6]
        for number, data in enumerate(chunks):
            chunk = reader.Chunk.read(reader._stream(data))
            (folder / f"chunk{number}").write_bytes(b"c" + reader._decompress(chunk))


if __name__ == "__main__":
    corpus = Path(sys.argv[-1])
    corpus.mkdir(exist_ok=True)
    seeds(corpus)
    atheris.Setup(sys.argv, read)
    atheris.Fuzz()
