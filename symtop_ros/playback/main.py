"""Entry point of `top_replay`: logs in Rerun, checked against the closed form, or repaired."""

from __future__ import annotations

import argparse
import signal
import sys
import tempfile
from pathlib import Path

from symtop_ros.playback.check import Deviation, check
from symtop_ros.playback.mcap_file import LogError, McapFile, told
from symtop_ros.playback.repair import repair
from symtop_ros.playback.top_log import TopLog
from symtop_ros.wire.text import one_line

ENDED = 130  # as a shell says it of Ctrl-C


def main(args: list[str] | None = None) -> int:
    """Replay, check or repair a log; return 0 (good), 1 (failed), 2 (usage) or 130 (ended)."""
    options = _parser().parse_args(args)
    try:
        for number in (signal.SIGINT, signal.SIGTERM):  # what is half written is removed
            signal.signal(number, signal.default_int_handler)
        return _run(options)
    except LogError as error:
        print(f"top_replay: {one_line(error)}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return ENDED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="top_replay",
        description="Play a log of top_node in Rerun; without an option, at once.",
    )
    parser.add_argument("file", type=Path, metavar="FILE.mcap", help="a log, whole or damaged")
    parser.add_argument("--node", help="full name of the node, where a log holds several tops")
    ways = parser.add_mutually_exclusive_group()
    ways.add_argument("--save", type=Path, metavar="OUT.rrd", help="write a Rerun recording")
    ways.add_argument("--web", action="store_true", help="show it in a browser on this machine")
    ways.add_argument("--check", action="store_true", help="compute the run again and compare")
    ways.add_argument(
        "--repair", type=Path, metavar="OUT.mcap", help="write a whole log of what is readable"
    )
    return parser


def _run(options: argparse.Namespace) -> int:
    file = McapFile(options.file)
    if options.repair:
        count = repair(file, options.repair)
        _tell(file.problems)
        print(f"wrote {count} messages to {options.repair}")
        return 0
    log = TopLog(file, options.node)
    if options.check:
        return _check(log)
    return _show(log, options.save, options.web)


def _check(log: TopLog) -> int:
    deviations = check(log)
    _tell(log.problems)
    for name, deviation in deviations.items():
        print(_row(log.topics[name], deviation))
    unreached = sum(each.unreached for each in deviations.values())
    if unreached:
        msg = f"{unreached} samples are of a motion too fast or too long to be integrated again"
        raise LogError(msg)
    if not any(each.samples for each in deviations.values()):
        msg = "nothing could be checked: no sample comes after an event"
        raise LogError(msg)
    good = all(each.is_rounding for each in deviations.values())
    print(f"the log is {'' if good else 'NOT '}what its events say")
    return 0 if good else 1


def _row(topic: str, deviation: Deviation) -> str:
    row = f"{topic:28}{deviation.samples:9} samples, largest deviation {deviation.largest:g}"
    if deviation.largest:
        row += f" ({deviation.relative:.1e} of its size)"
    if deviation.unchecked:
        row += f"; {deviation.unchecked} before the first event are not checked"
    return row


def _show(log: TopLog, save: Path | None, web: bool) -> int:
    try:
        from symtop_ros.playback import viewer
        from symtop_ros.playback.replay import replay
    except ModuleNotFoundError as error:
        msg = f"{error.name} is missing: pip install 'symtop_ros[playback]'"
        raise LogError(msg) from None
    if save:
        if save.suffix != ".rrd":
            msg = f"--save: got {save}, allowed is a name that ends in .rrd"
            raise LogError(msg)
        replay(log, save)
        _tell(log.problems)
        print(f"wrote {save}: rerun {save}")
        return 0
    if not web and not viewer.has_screen():
        msg = "there is no screen: --save OUT.rrd writes a recording, --web serves a browser"
        raise LogError(msg)
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder, f"{log.file.path.stem}.rrd")
        replay(log, recording)
        _tell(log.problems)
        return viewer.show(recording, web)


def _tell(problems: list[str]) -> None:
    for problem in told(problems):
        print(f"top_replay: {problem}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
