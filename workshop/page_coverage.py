"""Coverage of the lines of the page's modules, by the browser's own counter.

With a folder in PAGE_COVERAGE each test process writes there what its tabs have run. `python
-m workshop.page_coverage FOLDER` sums it up, prints the share of each module, and returns 1 if less
than 90 % of all lines ran. A line counts if it has code other than brackets.
"""

import json
import os
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from symtop_ros.page.web.join import EXPORT, IMPORT, MODULES, drop_comments

FOLDER = os.environ.get("PAGE_COVERAGE")
PLACES = {path.stem: path for path in MODULES.rglob("*.js")}  # no two have the same name
LEAST = 90.0  # %
START = re.compile(r"^const module_(\w+) = \(\(\) => \{\n", re.MULTILINE)
BRACKETS = set("{}[]();, ")
Ran = dict[str, list[bool]]  # of the lines of each module, by its name


def list_lines(name: str) -> list[str]:
    """Return the lines of a module as the joined page has them."""
    text = drop_comments(PLACES[name].read_text(encoding="utf-8"))
    return EXPORT.sub(r"\1 \2", IMPORT.sub("", text)).strip().split("\n")


def counts(line: str) -> bool:
    """Return True for a line with code."""
    return not set(line) <= BRACKETS and not line.strip().startswith(("//", "*", "/*"))


class Counter:
    """Counts what the tabs of a browser run."""

    def __init__(self) -> None:
        self.ran: Ran = {}
        self._known: dict[str, dict[tuple[int, int], Any]] = {}  # functions of a script
        self._sessions: list[tuple[Any, Any]] = []

    def watch(self, tab: Any) -> None:
        """Count what a tab runs from now on."""
        session = tab.context.new_cdp_session(tab)
        for command in ("Profiler.enable", "Debugger.enable"):
            session.send(command)
        session.send("Profiler.startPreciseCoverage", {"callCount": True, "detailed": True})
        self._sessions.append((tab, session))

    def take(self) -> None:
        """Take over what the open tabs have run."""
        from playwright import sync_api as api

        for tab, session in self._sessions:
            if tab.is_closed():
                continue
            for script in session.send("Profiler.takePreciseCoverage")["result"]:
                wanted = {"scriptId": script["scriptId"]}
                try:
                    found = session.send("Debugger.getScriptSource", wanted)
                except api.Error:  # of a page that was loaded again
                    continue
                self._add(script["url"], found["scriptSource"], script["functions"])
        self._sessions = [each for each in self._sessions if not each[0].is_closed()]

    def _add(self, url: str, source: str, functions: Sequence[Mapping[str, Any]]) -> None:
        # A browser says once of a function that it has not run, and then leaves it out.
        found = {place_of(each): each for each in functions}
        known = self._known.setdefault(source, {})
        known.update({place: leave(place) for place in found})
        has_run = mark(source, [*{**known, **found}.values()])
        stem = Path(url).stem
        if url.endswith(".js") and stem in PLACES:
            self._add_module(stem, source, has_run)
        places = [*START.finditer(source)]
        for place in places:
            end = source.index("\nreturn {", place.end())
            self._add_module(place[1], source[place.end() : end], has_run[place.end() : end])

    def _add_module(self, name: str, text: str, has_run: Sequence[bool]) -> None:
        lines = []
        place = 0
        for line in text.split("\n"):
            part = has_run[place : place + len(line)]
            is_code = [ran for ran, letter in zip(part, line, strict=True) if not letter.isspace()]
            lines.append((line.removeprefix("export "), any(is_code)))
            place += len(line) + 1
        wanted = list_lines(name)
        found = align(wanted, lines)
        before = self.ran.get(name, [False] * len(wanted))
        self.ran[name] = [a or b for a, b in zip(before, found, strict=True)]

    def write(self, folder: str) -> None:
        """Write what has run to a file of this process."""
        Path(folder).mkdir(parents=True, exist_ok=True)
        Path(folder, f"{os.getpid()}.json").write_text(json.dumps(self.ran))


def place_of(function: Mapping[str, Any]) -> tuple[int, int]:
    """Return begin and end of a function."""
    whole = function["ranges"][0]
    return whole["startOffset"], whole["endOffset"]


def leave(place: tuple[int, int]) -> Mapping[str, Any]:
    """Return a function that has not run."""
    begin, end = place
    return {"ranges": [{"startOffset": begin, "endOffset": end, "count": 0}]}


def mark(source: str, functions: Sequence[Mapping[str, Any]]) -> list[bool]:
    """Return for each letter of a script whether it ran: an inner range overrides the outer."""
    has_run = [True] * len(source)
    ranges = [each for function in functions for each in function["ranges"]]
    for each in sorted(ranges, key=lambda each: each["startOffset"] - each["endOffset"]):
        begin, end = each["startOffset"], each["endOffset"]
        has_run[begin:end] = [each["count"] > 0] * (min(end, len(source)) - begin)
    return has_run


def align(wanted: Sequence[str], lines: Iterable[tuple[str, bool]]) -> list[bool]:
    """Return whether each wanted line ran, from lines among which they stand in their order."""
    rest = iter(lines)
    return [next((ran for text, ran in rest if text == line), False) for line in wanted]


def main() -> int:
    """Print the coverage that test processes have written to a folder."""
    ran: Ran = {name: [False] * len(list_lines(name)) for name in PLACES}
    for path in Path(sys.argv[1]).glob("*.json"):
        for name, lines in json.loads(path.read_text()).items():
            ran[name] = [a or b for a, b in zip(ran[name], lines, strict=True)]
    total = [0, 0]
    for name, lines in sorted(ran.items()):
        texts = list_lines(name)
        code = [k for k, text in enumerate(texts) if counts(text)]
        missed = sum(not lines[k] for k in code)
        total[0] += len(code) - missed
        total[1] += len(code)
        share = 100 * (1 - missed / max(len(code), 1))
        print(f"{name + '.js':22} {len(code):4} lines {share:6.1f} %")
    share = 100 * total[0] / total[1]
    print(f"{'all':22} {total[1]:4} lines {share:6.1f} %, {LEAST:g} % required")
    return int(share < LEAST)


if __name__ == "__main__":
    sys.exit(main())
