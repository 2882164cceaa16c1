"""The files of MCAP's conformance tests: every legal combination of features that a writer has.

They are written here from the rules by which foxglove/mcap generates them (tests/conformance), with
the same bytes: checksums of data and summaries are those of its 416 descriptions.
"""

import zlib
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any

from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    Message,
    MessageIndex,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)

from symtop_ros.run.log.reader import MAGIC

FEATURES = ("ch", "mx", "st", "rsh", "rch", "ax", "mdx", "chx", "sum", "pad")
SCHEMA = Schema(1, b"\x04\x05\x06", "c", "Example")
CHANNEL = Channel(1, "example", "a", {"foo": "bar"}, 1)
LOG_TIMES = (0, 2, 1, 3, 3, 5, 4, 7, 8, 9)
INPUTS: dict[str, Sequence[Any]] = {
    "NoData": (),
    "OneMessage": (SCHEMA, CHANNEL, Message(1, 2, b"\x01\x02\x03", 1, 10)),
    "OneSchemalessMessage": (
        Channel(1, "example", "text", {}, 0),
        Message(1, 2, b"\x01\x02\x03", 1, 10),
    ),
    "OneAttachment": (Attachment(1, 2, "myFile", "application/octet-stream", b"\x01\x02\x03"),),
    "OneMetadata": (Metadata("myMetadata", {"foo": "bar"}),),
    "TenMessages": (
        SCHEMA,
        CHANNEL,
        *(Message(1, t, b"\x01\x02\x03", t, k) for k, t in enumerate(LOG_TIMES)),
    ),
}
CHUNKED = (Schema, Channel, Message)
PADDING = b"\x01\xff\xff"
NOT_PADDED = (Message, Chunk, DataEnd, Footer)


def list_variants() -> Iterator[tuple[str, frozenset[str]]]:
    """Yield the names of inputs with the features that make sense for them."""
    for name, records in INPUTS.items():
        kinds = {type(each) for each in records}
        for count in range(len(FEATURES) + 1):
            for chosen in map(frozenset, combinations(FEATURES, count)):
                if _makes_sense(chosen, kinds):
                    yield name, chosen


def _makes_sense(features: frozenset[str], kinds: set[type]) -> bool:
    needs = {"ax": Attachment, "mdx": Metadata, "rsh": Schema, "rch": Channel}
    if any(each in features and kind not in kinds for each, kind in needs.items()):
        return False
    if features & {"ch", "chx", "mx"} and not kinds & set(CHUNKED):
        return False
    if "sum" in features and not features & {"chx", "rsh", "rch", "mdx", "ax", "st"}:
        return False
    return not (features & {"chx", "mx"} and "ch" not in features)


def encode(record: Any, is_padded: bool) -> bytes:
    """Return the bytes of a record, with bytes at its end that a reader passes over."""
    builder = RecordBuilder()
    record.write(builder)
    data = bytes(builder.end())
    if not is_padded or isinstance(record, NOT_PADDED):
        return data
    length = len(data) - 9 + len(PADDING)
    return data[:1] + length.to_bytes(8, "little") + data[9:] + PADDING


def write_variant(name: str, features: frozenset[str]) -> bytes:
    """Return the file of an input with some features."""
    records = INPUTS[name]
    is_padded = "pad" in features
    data = MAGIC + encode(Header("", ""), is_padded)
    indexes: dict[str, list[bytes]] = {"mdx": [], "ax": [], "chx": []}
    for each in records:
        if "ch" in features and isinstance(each, CHUNKED):
            continue
        part = encode(each, is_padded)
        if isinstance(each, Metadata):
            index = MetadataIndex(len(data), len(part), each.name)
            indexes["mdx"].append(encode(index, is_padded))
        if isinstance(each, Attachment):
            about = each.log_time, each.create_time, len(each.data), each.name, each.media_type
            indexes["ax"].append(encode(AttachmentIndex(len(data), len(part), *about), is_padded))
        data += part
    if "ch" in features:
        data, index = _add_chunk(data, records, features)
        indexes["chx"].append(index)
    data += encode(DataEnd(zlib.crc32(data)), is_padded)
    return data + _write_summary(len(data), records, features, indexes)


def _add_chunk(
    data: bytes, records: Sequence[Any], features: frozenset[str]
) -> tuple[bytes, bytes]:
    """Return the file so far with its chunk, and the index of that."""
    content = b""
    entries = {}
    is_padded = "pad" in features
    for each in records:
        if isinstance(each, Channel):
            entries.setdefault(each.id, [])
        if isinstance(each, Message):
            entries[each.channel_id].append((each.log_time, len(content)))
        content += encode(each, is_padded=False) if isinstance(each, CHUNKED) else b""
    times = [each.log_time for each in records if isinstance(each, Message)]
    first, last = min(times, default=0), max(times, default=0)
    chunk = encode(Chunk("", content, last, first, zlib.crc32(content), len(content)), is_padded)
    begin = len(data)
    behind = len(data) + len(chunk)
    offsets = {}
    data += chunk
    for number, found in entries.items() if "mx" in features else ():
        offsets[number] = len(data)
        data += encode(MessageIndex(number, found), is_padded)
    size = len(content)
    index = ChunkIndex(
        chunk_length=len(chunk),
        chunk_start_offset=begin,
        compression="",
        compressed_size=size,
        message_end_time=last,
        message_index_length=len(data) - behind,
        message_index_offsets=offsets,
        message_start_time=first,
        uncompressed_size=size,
    )
    return data, encode(index, is_padded)


def _write_summary(
    begin: int, records: Sequence[Any], features: frozenset[str], indexes: dict[str, list[bytes]]
) -> bytes:
    is_padded = "pad" in features
    groups = {
        Opcode.SCHEMA: _repeat(records, Schema, is_padded) if "rsh" in features else b"",
        Opcode.CHANNEL: _repeat(records, Channel, is_padded) if "rch" in features else b"",
        Opcode.STATISTICS: (
            encode(_count(records, features), is_padded) if "st" in features else b""
        ),
        Opcode.METADATA_INDEX: b"".join(indexes["mdx"]) if "mdx" in features else b"",
        Opcode.ATTACHMENT_INDEX: b"".join(indexes["ax"]) if "ax" in features else b"",
        Opcode.CHUNK_INDEX: b"".join(indexes["chx"]) if "chx" in features else b"",
    }
    summary = b"".join(groups.values())
    start = begin if summary else 0
    offsets = b""
    place = begin
    for opcode, group in groups.items():
        if group and "sum" in features:
            offsets += encode(SummaryOffset(opcode, place, len(group)), is_padded)
        place += len(group)
    offset_start = begin + len(summary) if "sum" in features else 0
    head = encode(Footer(start, offset_start, 0), is_padded=False)[:-4]
    checksum = zlib.crc32(summary + offsets + head)
    return summary + offsets + head + checksum.to_bytes(4, "little") + MAGIC


def _repeat(records: Sequence[Any], kind: type, is_padded: bool) -> bytes:
    return b"".join(encode(each, is_padded) for each in records if isinstance(each, kind))


def _count(records: Sequence[Any], features: frozenset[str]) -> Statistics:
    def count(kind: type) -> int:
        return sum(isinstance(each, kind) for each in records)

    times = [each.log_time for each in records if isinstance(each, Message)]
    return Statistics(
        attachment_count=count(Attachment),
        channel_count=count(Channel),
        channel_message_counts={1: len(times)} if times else {},
        chunk_count=int("ch" in features),
        message_count=len(times),
        message_end_time=max(times, default=0),
        message_start_time=min(times, default=0),
        metadata_count=count(Metadata),
        schema_count=count(Schema),
    )
