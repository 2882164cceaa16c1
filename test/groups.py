"""Run all tests in groups, each with its output in a file, and print one summary at the end.

python test/groups.py [--coverage] [--keys] [GROUP...]

A failure does not keep other groups from running. Four groups run at a time: first those that take
longest, and that wait for downloads, nodes or pages while others compute. Those of real time run
alone afterwards, as they measure it.
"""

import argparse
import os
import re
import shlex
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).parents[1]))
from processors import old_processor
from traces import Traces

from workshop.browser import SHELL
from workshop.load.endings import bound

ROOT = Path(__file__).parents[1]
BIN = Path(sys.executable).parent
OUTPUT = Path(sys.prefix, "test-output")
AT_A_TIME = 4
PERIOD = 15.0  # s between two lines of progress
NODES = ("test/ros/node", "test/system", "test/load", "test/ros/client")
PLAIN = ("test/digits", "test/speed", "test/run/wire", "test/run/models", "test/truth/testset")
JUDGE = ("test/truth/judge", "test/truth/imu", "test/run/check")
# These run once more as on an old processor, on which BLAS, NumPy and libm round otherwise: what
# they test adds products or takes sines in these libraries. The kernel, refusals and records do
# not, and derivatives and references take long (`make test-elsewhere` runs all).
NUMBERS = (
    *(
        f"test/physics/test_{name}.py"
        for name in (
            "benchmarks",
            "clamp",
            "ledger",
            "motion",
            "pushes",
            "starts",
            "state",
            "values",
        )
    ),
    *(
        f"test/run/simulation/test_{name}.py"
        for name in ("block", "exact_stamps", "pushed", "sensor", "simulation", "turns")
    ),
    *(f"test/run/check/test_{name}.py" for name in ("events", "samples", "topics")),
)
# These run as on a machine without ROS and Rerun, but for two files that compare with ROS itself.
PAGE = ("test/page/panel", "test/page/web")
WITHOUT_ROS = ("test/run/simulation", "test/run/session", "test/run/log")
WITH_ROS = ("test/run/log/test_definitions.py", "test/page/panel/test_bridge.py")
ELSEWHERE = (*NODES, "test/physics", *PLAIN, *JUDGE, *PAGE, *WITHOUT_ROS)
REALTIME = ("test/ros/node", "test/system", "test/load", "test/page/panel/test_bridge.py")
# These read no wording: they pass with every template replaced by its key, but for marked ones.
KEYS = Path(__file__).with_name("keys")
READ_NO_WORDING = ("nodes", "page", "rest", "plain", "judge", "physics", "without-ros")
MARKS = "not realtime and not long"
# All but files that import what is installed only where it is measured, or built by a test.
EXAMPLES = ("--doctest-modules", "--ignore-glob=*/*_peer.py", "--ignore-glob=*/node/simulator.py")

COUNT = re.compile(r"(\d+) (passed|failed|skipped|errors?)\b")
CLOSING = re.compile(r"^(?:=+ )?(\d+ \w+.*) in [\d.]+s\b.*$", re.MULTILINE)
FAILURE = re.compile(r"^(?:FAILED|ERROR) (\S+?(?:\[.*?\])?)(?= - |$)", re.MULTILINE)
DOTS = re.compile(r"^([.FEsxX]+)(?: +\[ *\d+%\])?$", re.MULTILINE)
DETAILS = re.compile(r"^=+ (?:FAILURES|ERRORS) =+$", re.MULTILINE)


@dataclass(frozen=True)
class Command:
    """A program that runs tests, or that is one check itself."""

    words: tuple[str, ...]
    again: tuple[str, ...]  # what comes before the name of a test to run it alone; () for a check
    folder: Path | None = None  # in which it runs; this checkout if not given


@dataclass
class Outcome:
    """Counts and failures of a group of tests."""

    passed: int = 0
    skipped: int = 0
    failures: list[str] = field(default_factory=list)  # command lines that run a failed test alone
    seconds: float = 0.0

    def add(self, command: Command, status: int, text: str) -> None:
        """Add the exit status and the output of a command."""
        counts = {name.rstrip("s"): int(number) for number, name in COUNT.findall(closing(text))}
        failed = [shlex.join([*command.again, name]) for name in FAILURE.findall(text)]
        if command.again:
            self.passed += counts.get("passed", 0)
            self.skipped += counts.get("skipped", 0)
            self.failures += failed
        elif not status:
            self.passed += 1
        if status and not (command.again and failed):
            self.failures.append(f"{shlex.join(command.words)}  # exit status {status}")


def closing(text: str) -> str:
    """Return the line with pytest's counts, after which Python may print; empty without any."""
    return (CLOSING.findall(text) or [""])[-1]


def pytest(
    *words: str,
    options: Sequence[str] = (),
    trace: bool = False,
    before: Sequence[str] = (),
    folder: Path | None = None,
) -> Command:
    """Return the command for some tests that follow a simulated clock; `before` it may be env."""
    python = BIN / "python"
    start = [*before, str(python), "-m", *(("coverage", "run", "-m") if trace else ()), "pytest"]
    marked = () if "-m" in words else ("-m", MARKS)
    name = os.path.relpath(python, ROOT)
    return Command(
        (*start, "-q", "--color=no", *options, *marked, *words),
        (*before, name, "-m", "pytest", *options),
        folder,
    )


def fetch(*names: str) -> list[Command]:
    """Return the commands that fetch what only some groups need."""
    return [Command(("make", "--silent", f"set-up-{name}"), ()) for name in names]


def list_groups(trace: bool) -> dict[str, list[Command]]:
    """Return the commands of each group, by its name; with `trace` coverage is measured."""
    old = ("env", *(f"{name}={value}" for name, value in old_processor().items()))
    # the other groups open pages in the whole Chromium, and so does the coverage of the long run
    shell = () if trace else ("env", f"{SHELL}=1")

    def run(*words: str, **options: Any) -> Command:
        return pytest(*words, trace=trace, **options)

    return {
        "page": [*fetch("chromium"), run(*PAGE, options=("-p", "without_ros"), before=shell)],
        "nodes": [*fetch("messages"), run(*NODES)],
        "rest": [*fetch("vulkan", "chromium"), run("test", *ignore(ELSEWHERE))],
        "judge": [run(*JUDGE)],
        "lint": [  # early, because its tools come from a registry that may be slow
            *fetch("js"),
            *(
                Command((str(BIN / "python"), "test/lint.py", name), ())
                for name in ("style", "types")
            ),
        ],
        "plain": [*fetch("chromium"), run(*PLAIN, *WITH_ROS)],
        "physics": [run("test/physics")],
        "without-ros": [run(*WITHOUT_ROS, options=("-p", "without_ros"))],
        "old-processor": [run(*NUMBERS, before=old)],
        "examples": [run("symtop_ros", options=EXAMPLES)],
        "realtime": [*fetch("chromium"), run("-m", "realtime and not long", *REALTIME)],
    }


def replace_wording(groups: dict[str, list[Command]]) -> dict[str, list[Command]]:
    """Return the groups that read no wording, without the tests of wording itself."""
    marks = {MARKS: f"{MARKS} and not wording"}
    return {
        name: [replace(each, words=(*(marks.get(w, w) for w in each.words),)) for each in commands]
        for name, commands in groups.items()
        if name in READ_NO_WORDING
    }


def ignore(paths: Iterable[str]) -> Iterator[str]:
    """Yield the options that leave paths out."""
    yield from (f"--ignore={path}" for path in paths)


def run_group(name: str, commands: Sequence[Command]) -> Outcome:
    """Run the commands of a group one after the other; their output goes to one file."""
    outcome = Outcome()
    began = time.monotonic()
    path = file_of(name)
    path.write_text("")
    for command in commands:
        before = path.stat().st_size
        with path.open("a") as file:
            words = bound(command.words)
            folder = command.folder or ROOT
            status = subprocess.run(words, stdout=file, stderr=file, cwd=folder, check=False)
        text = path.read_bytes()[before:].decode(errors="replace")
        outcome.add(command, status.returncode, text)
    outcome.seconds = time.monotonic() - began
    return outcome


def file_of(name: str) -> Path:
    """Return the path of the output of a group."""
    return OUTPUT / f"{name}.txt"


def run_together(groups: dict[str, list[Command]]) -> dict[str, Outcome]:
    """Run some groups at a time, print their progress and return what they gave, by name."""
    began = time.monotonic()
    with ThreadPoolExecutor(AT_A_TIME) as pool:
        running = {pool.submit(run_group, *each): each[0] for each in groups.items()}
        left = set(running)
        try:
            while left:
                done, left = wait(left, PERIOD, "FIRST_COMPLETED")
                report_progress(time.monotonic() - began, running, done, left)
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True)
            raise
    return {name: future.result() for future, name in running.items()}


def report_progress(
    seconds: float,
    names: dict[Future[Outcome], str],
    done: set[Future[Outcome]],
    left: set[Future[Outcome]],
) -> None:
    """Print a line for each group that has ended, or else one on those that run."""
    for each in done:
        outcome = each.result()
        print(f"{seconds:4.0f} s  {names[each]}: {summarize([outcome])}", flush=True)
        if outcome.failures:
            print(find_details(file_of(names[each]).read_text(errors="replace")), flush=True)
    if not done:
        shares = [f"{names[each]} {progress_of(names[each])}" for each in left if each.running()]
        print(f"{seconds:4.0f} s  {', '.join(sorted(shares))}", flush=True)


def progress_of(name: str) -> str:
    """Return how many tests of a group have ended, by the letters that pytest prints."""
    lines = DOTS.findall(file_of(name).read_text(errors="replace"))
    return f"{sum(map(len, lines))} done"


def find_details(text: str) -> str:
    """Return the part of an output that explains its failures; all of it if there is no such."""
    found = DETAILS.search(text)
    return text[found.start() :] if found else text


def summarize(outcomes: Sequence[Outcome]) -> str:
    """Return counts in the words of pytest."""
    passed = sum(each.passed for each in outcomes)
    failed = sum(len(e.failures) for e in outcomes)
    skipped = sum(each.skipped for each in outcomes)
    return f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else "")


def print_summary(outcomes: dict[str, Outcome]) -> None:
    """Print the counts of each group, how to run each failed test alone, and the sum."""
    print("\nSummary")
    for name, each in outcomes.items():
        print(f"  {name:12} {summarize([each])}, {each.seconds:.0f} s")
    failures = [failure for each in outcomes.values() for failure in each.failures]
    if failures:
        print("\nTo run what failed alone:")
        print("\n".join(f"  {failure}" for failure in failures))
    print(f"\nOutput of each group: {OUTPUT}")
    print(summarize([*outcomes.values()]), flush=True)


def judge_traces(traces: Traces) -> Outcome:
    """Return the outcome of a check: nothing of the tests is left on the machine."""
    left = [f"ls -ld {shlex.quote(str(path))}  # is left by a test" for path in traces.find()]
    return Outcome(passed=not left, failures=left)


def main() -> int:
    """Run the groups that are named, or all; return 1 if any test failed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("groups", nargs="*", metavar="GROUP", help="all if none is named")
    parser.add_argument("--coverage", action="store_true", help="measure the coverage of lines")
    parser.add_argument("--keys", action="store_true", help="replace each template by its key")
    options = parser.parse_args()
    groups = list_groups(options.coverage)
    if options.keys:
        os.environ["PYTHONPATH"] = str(KEYS)
        groups = replace_wording(groups)
    if unknown := [name for name in options.groups if name not in groups]:
        parser.error(f"GROUP must be one of {', '.join(groups)}, got {unknown[0]}")
    return run_and_print({name: groups[name] for name in options.groups or groups})


def run_and_print(chosen: dict[str, list[Command]]) -> int:
    """Run groups, those of real time alone, and print the summary; return 1 if any test failed."""
    # Small matrices gain nothing by threads, which take a quarter of the time of two processors.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    OUTPUT.mkdir(parents=True, exist_ok=True)
    alone = {name: chosen.pop(name) for name in ["realtime"] if name in chosen}
    traces = Traces()
    os.environ |= traces.variables
    try:
        outcomes = {**run_together(chosen), **run_together(alone)}
        outcomes["traces"] = judge_traces(traces)
    except KeyboardInterrupt:
        return 130
    finally:
        traces.close()
    print_summary(outcomes)
    return 1 if any(each.failures for each in outcomes.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
