"""Repair of a damaged log: everything readable is written to a new, complete file."""

from contextlib import ExitStack
from functools import cache, partial
from itertools import chain
from pathlib import Path

from mcap.writer import CompressionType, Writer

from symtop_ros.log.reader import LogError, McapFile, log_errors


def repair(file: McapFile, target: Path) -> int:
    """Write the readable messages with new indexes and checksums; return their number."""
    with log_errors("write", target):
        if target.exists():
            raise LogError(f"{target} must not exist (nothing is overwritten)")
        with target.open("xb") as stream, ExitStack() as undo:
            undo.callback(target.unlink)
            writer = Writer(stream, compression=CompressionType.ZSTD)
            writer.start(file.profile, "symtop_ros top_replay --repair")
            count = _copy(file, writer)
            writer.finish()  # type: ignore[no-untyped-call]
            undo.pop_all()  # the file stays
    return count


def _copy(file: McapFile, writer: Writer) -> int:
    register = cache(partial(_copy_channel, file, writer))
    count = 0
    for message in chain.from_iterable(file.chunks()):
        if number := register(message.channel_id):
            writer.add_message(
                number, message.log_time, message.data, message.publish_time, message.sequence
            )
            count += 1
    for name, metadata in file.metadata.items():
        writer.add_metadata(name, metadata)
    return count


def _copy_channel(file: McapFile, writer: Writer, number: int) -> int:
    """Register a channel and return its new id; 0 if the file does not describe it."""
    channel = file.channels.get(number)
    if channel is None:
        file.problems.append(f"channel {number} is not described: its messages are lost")
        return 0
    schema = file.schemas.get(channel.schema_id)
    new = writer.register_schema(schema.name, schema.encoding, schema.data) if schema else 0
    return writer.register_channel(channel.topic, channel.message_encoding, new, channel.metadata)
