"""Entry point of `top_replay`: play a log or a run in Rerun, check, repair or convert it."""

import argparse
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from symtop_ros.check.events import Mismatch
from symtop_ros.check.run import check_run
from symtop_ros.check.samples import Deviation
from symtop_ros.command import has_screen, tell_failures
from symtop_ros.log.reader import LogError, McapFile, list_problems, log_errors
from symtop_ros.log.repair import repair
from symtop_ros.log.top_log import TopLog, open_run
from symtop_ros.playback.options import make_parser, view_options
from symtop_ros.session.run_log import write_run_log
from symtop_ros.simulation.run_file import RATE, RunEvent, read_run, record_run, write_run
from symtop_ros.simulation.settings import MAX_PUBLISH_RATE
from symtop_ros.simulation.topics import EVENTS
from symtop_ros.simulation.validation import number, one_line
from symtop_ros.web.join import write_file


def main(args: list[str] | None = None) -> int:
    """Replay, check or repair a log; return 0 (success), 1 (failure) or 2 (usage)."""
    parser = make_parser()
    options = parser.parse_args(args)
    if options.rate is not None and not options.mcap:
        parser.error("--rate goes with --mcap")
    return tell_failures("top_replay", lambda: _run(options))


def _run(options: argparse.Namespace) -> int:
    if options.mcap:
        _write_mcap(options.files, options.mcap, RATE if options.rate is None else options.rate)
        print(f"wrote {options.mcap}")
        return 0
    if options.repair:
        if len(options.files) > 1:
            raise LogError(f"--repair must be given one log, got {len(options.files)}")
        file = McapFile(options.files[0])
        count = repair(file, options.repair)
        _print_problems(file.problems)
        print(f"wrote {count} messages to {options.repair}")
        return 0
    with _open_file(options.files, options.node) as log:
        return _check(log) if options.check else _show(log, options)


def _check(log: TopLog) -> int:
    found = check_run(log)
    _print_problems(log.problems + found.damage + found.missing)
    for name, deviation in found.deviations.items():
        print(_row(log.topics[name], deviation))
    unreached = sum(each.unreached for each in found.deviations.values())
    if unreached:
        raise LogError(
            f"{unreached} samples cannot be checked: "
            "the motion is too fast or too long to integrate"
        )
    if not any(each.samples for each in found.deviations.values()):
        raise LogError("nothing can be checked: no sample follows an event")
    _print_problems([_describe(log, each) for each in found.mismatches])
    print(f"the samples {'agree' if found.samples_agree else 'DO NOT agree'} with the events")
    if found.mismatches:
        print("events or descriptions of the motion DO NOT agree with the computation")
    if found.first > 1:
        print(f"the log begins with event {found.first} of the run")
    if found.foreign:
        by = f"symtop_ros {', '.join(found.versions)}" if found.versions else "another engine"
        print(f"{found.foreign} events are of {by}: their words and verdicts are not judged")
    is_whole = not (log.damage or found.damage or found.missing)
    if found.samples_agree and not is_whole:
        print("the log is damaged or incomplete")
    return 0 if found.samples_agree and not found.mismatches and is_whole else 1


def _describe(log: TopLog, mismatch: Mismatch) -> str:
    topic = EVENTS.resolve(log.node or "") if mismatch.topic == EVENTS.name else mismatch.topic
    right, got = one_line(mismatch.expected, 100), one_line(mismatch.got, 100)
    return f"{topic} at {mismatch.stamp} ns: {mismatch.field} must be {right}, got {got}"


def _row(topic: str, deviation: Deviation) -> str:
    row = f"{topic:28}{deviation.samples:9} samples, largest difference {deviation.largest:g}"
    if deviation.largest:
        row += f" ({deviation.relative:.1e} of its size)"
    notes = {
        "before the first event not checked": deviation.unchecked,
        "after missing events not judged": deviation.unjudged,
        "agree with an event, but the order of messages is not known": deviation.unordered,
    }
    return row + "".join(f"; {count} {text}" for text, count in notes.items() if count)


def _show(log: TopLog, options: argparse.Namespace) -> int:
    # Rerun, which a check and a repair do without
    from symtop_ros.playback import viewer
    from symtop_ros.playback.view.view import ViewOptions

    drawn, save = ViewOptions(**view_options(options)), options.save
    if save:
        if save.suffix == ".html":
            _save_page(log, save)
        elif save.suffix == ".rrd":
            viewer.replay(log, save, drawn)
        else:
            raise LogError(f"--save must be a name that ends in .rrd or .html, got {save}")
        _print_problems(log.problems)
        program = "in a browser" if save.suffix == ".html" else f"with: rerun {save}"
        print(f"wrote {save}; open it {program}")
        return 0
    if not options.web and not has_screen():
        raise LogError(
            "no screen for the viewer: use --save OUT.rrd to write a recording, or --web for a "
            "browser"
        )
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder, f"{log.file.path.stem}.rrd")
        viewer.replay(log, recording, drawn)
        _print_problems(log.problems)
        return viewer.show(recording, options.web)


def _print_problems(problems: list[str]) -> None:
    for problem in list_problems(problems):
        print(f"top_replay: {problem}", file=sys.stderr)


def _read_run(paths: Sequence[Path]) -> tuple[list[RunEvent], int]:
    """Return the events of a run of the page, and its end in ns."""
    if len(paths) != 1:
        raise LogError(f"a run of the page must be one file, got {len(paths)}")
    with log_errors("open", paths[0]):
        return read_run(paths[0])


@contextmanager
def _open_file(paths: Sequence[Path], node: str | None) -> Iterator[TopLog]:
    """Open a log, or the log that a node would have written of a run of the page."""
    if all(path.suffix != ".json" for path in paths):
        yield TopLog(open_run(paths), node)
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"{paths[0].stem}.mcap")
        write_run_log(*_read_run(paths), path)
        yield TopLog(open_run([path]), node)


def _save_page(log: TopLog, path: Path) -> None:
    """Write the page with the run of a log in it."""
    stamps = (int(each.stamps[-1]) for batch in log.batches() for each in batch.columns.values())
    run, reached = record_run(log.events(), max([0, *stamps]))
    if not run:
        raise LogError(f"{log.file.path}: a run must have an event to be saved")
    with log_errors("write", path):
        path.write_text(write_file(run=write_run(run, reached)), encoding="utf-8")


def _write_mcap(paths: Sequence[Path], path: Path, rate: float) -> None:
    """Write the log that a node would have written of a run of the page."""
    if path.suffix != ".mcap" or not path.parent.is_dir():
        raise LogError(f"--mcap must be a name that ends in .mcap in a folder, got {path}")
    number("--rate", rate, "Hz", 1.0, MAX_PUBLISH_RATE)
    with log_errors("write", path):
        write_run_log(*_read_run(paths), path, rate)
