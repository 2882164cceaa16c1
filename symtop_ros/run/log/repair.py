"""Repair of a damaged log: everything readable is written to a new, complete file.

What is lost is written as well, with its place, so that the new file has the catalog of the old.
"""

import json
from bisect import bisect_left
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from functools import cache, partial
from itertools import chain
from pathlib import Path

from mcap.writer import CompressionType, Writer

from symtop_ros.base.counts import write_count
from symtop_ros.run.log.catalog import Catalog
from symtop_ros.run.log.reader import LOST_BEFORE, LogError, McapFile, log_errors
from symtop_ros.run.log.source import Loss
from symtop_ros.run.log.writer import REPAIR, REPAIR_LOSSES


@dataclass(frozen=True, slots=True)
class Repaired:
    """Numbers of what was written to a new log."""

    messages: int
    attachments: int
    metadata: int  # records

    def __str__(self) -> str:
        """Return it in words; every log of ours has metadata, which need no word."""
        counts = {"attachment": self.attachments}
        if not self.messages:
            counts["metadata record"] = self.metadata
        some = [write_count(n, name) for name, n in counts.items() if n]
        return ", ".join([write_count(self.messages, "message"), *some])


def repair(file: McapFile, target: Path, catalog: Catalog) -> Repaired:
    """Write the readable parts of a log with new indexes and checksums, and what is lost."""
    with log_errors("write", target):
        if target.exists():
            raise LogError(f"{target} must not exist (nothing is overwritten)")
        with target.open("xb") as stream, ExitStack() as undo:
            undo.callback(target.unlink)
            writer = Writer(stream, compression=CompressionType.ZSTD)
            writer.start(file.profile, "symtop_ros top_replay --repair")
            found = _copy(file, writer, catalog.losses)
            writer.finish()  # type: ignore[no-untyped-call]
            undo.pop_all()  # the file stays
    return found


def _copy(file: McapFile, writer: Writer, losses: Sequence[Loss]) -> Repaired:
    register = cache(partial(_copy_channel, file, writer))
    left_out: list[int] = []  # places of messages that no channel describes
    for place, message in enumerate(chain.from_iterable(file.chunks())):
        if number := register(message.channel_id):
            writer.add_message(
                number, message.log_time, message.data, message.publish_time, message.sequence
            )
        else:
            left_out.append(place)
    for number in file.channels:  # those without messages as well
        register(number)
    attachments = 0
    for attachments, each in enumerate(file.attachments(), start=1):  # noqa: B007 - the count
        writer.add_attachment(
            each.create_time, each.log_time, each.name, each.media_type, each.data
        )
    metadata = [each for each in file.list_metadata() if each[0] != REPAIR]
    for name, values in metadata:
        writer.add_metadata(name, values)
    if losses:
        lost = json.dumps([asdict(_move(each, left_out)) for each in losses])
        writer.add_metadata(REPAIR, {REPAIR_LOSSES: lost})
    return Repaired(file.count - len(left_out), attachments, len(metadata))


def _move(loss: Loss, left_out: Sequence[int]) -> Loss:
    """Return a loss with its place in the new log."""
    place = None if loss.place is None else loss.place - bisect_left(left_out, loss.place)
    return replace(loss, text=loss.text.removeprefix(LOST_BEFORE), place=place)


def _copy_channel(file: McapFile, writer: Writer, number: int) -> int:
    """Register a channel and return its new id; 0 if the file does not describe it."""
    channel = file.channels.get(number)
    if channel is None:
        return 0
    schema = file.schemas.get(channel.schema_id)
    new = writer.register_schema(schema.name, schema.encoding, schema.data) if schema else 0
    return writer.register_channel(channel.topic, channel.message_encoding, new, channel.metadata)
