"""Faults put into the sources one at a time, and which tests see them.

python workshop/faults.py [--slow] [NUMBER...]

The faults are drawn with a fixed seed from the operators, comparisons and numbers of the package's
Python, C++ and JavaScript. A copy of the checkout gets one at a time. The quick tests of its folder
run first, then all quick ones; `--slow` tries what is left on the slow ones. Each run stops at its
first failure. A fault that no test sees may be equivalent to the right code: read it.
"""

from __future__ import annotations

import argparse
import io
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import tokenize
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SEED = 112
# Files of each language, and how many faults are drawn from them.
LANGUAGES = {
    "symtop_ros/**/*.py": 20,
    "symtop_ros/physics/kernel/**/*.?pp": 10,
    "symtop_ros/page/web/js/**/*.js": 10,
}
NOT_COPIED = (".git", ".venv", ".hypothesis", ".pytest_cache", "__pycache__", "report", "logs")
INSTEAD = {"+": "-", "-": "+", "*": "/", "/": "*", "<": "<=", "<=": "<", ">": ">=", ">=": ">"}
INSTEAD |= {"==": "!=", "!=": "==", "===": "!==", "!==": "===", "&&": "||", "||": "&&"}
INSTEAD |= {"and": "or", "or": "and"}
# Formatters put blanks around operators of two operands, and nothing else.
OPERATOR = re.compile(rf"(?<=\s)(?:{'|'.join(map(re.escape, INSTEAD))})(?=\s)")
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?![\w.])")
# Comments and texts of C++ and JavaScript, and regular expressions and templates of the latter.
PROSE = re.compile(
    r"//.*|/\*[\s\S]*?\*/|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`|#include.*"
    r"|(?<=[(,=] )/(?:\\.|[^/\\\n])+/|(?<=\()/(?:\\.|[^/\\\n])+/"
)
STAGES = "quick tests of its folder", "all quick tests", "slow tests"
LIMIT = "1800"  # s; a fault may make a loop endless
TOGETHER = ("-n", "3", "--dist", "loadfile")
PYTEST = ("timeout", LIMIT, sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider")


@dataclass(frozen=True)
class Fault:
    """A piece of a file and what stands in its place."""

    path: str
    begin: int
    old: str
    new: str

    def apply(self, text: str) -> str:
        """Return the text with the fault."""
        return text[: self.begin] + self.new + text[self.begin + len(self.old) :]

    def describe(self) -> str:
        """Return file, line, change and the line itself."""
        text = (ROOT / self.path).read_text(encoding="utf-8")
        number = text.count("\n", 0, self.begin) + 1
        line = text.splitlines()[number - 1].strip()
        return f"{self.path}:{number}: {self.old} -> {self.new}: {line}"


def main() -> int:
    """Try the faults, or some of them by their numbers; print what each stage sees."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--slow", action="store_true", help="try the slow tests on what is left")
    parser.add_argument("numbers", nargs="*", type=int, help="all if none is given")
    options = parser.parse_args()
    faults = draw()
    with tempfile.TemporaryDirectory(prefix="faults-") as name:
        copy = copy_checkout(Path(name, "checkout"))
        if not passes(copy, *TOGETHER, "test"):
            print("the quick tests must pass without a fault, and do not", file=sys.stderr)
            return 1
        left = [faults[number] for number in options.numbers or range(len(faults))]
        for stage in STAGES if options.slow else STAGES[:-1]:
            left = try_stage(stage, left, copy)
    for fault in left:
        print(f"not seen: {fault.describe()}")
    return 0


def try_stage(stage: str, faults: list[Fault], copy: Path) -> list[Fault]:
    """Try faults on the tests of a stage; print those that are seen, and return the others."""
    left = []
    for fault in faults:
        if is_seen(fault, stage, copy):
            print(f"{stage}: {fault.describe()}", flush=True)
        else:
            left.append(fault)
    print(f"{stage}: {len(faults) - len(left)} of {len(faults)} seen", flush=True)
    return left


def draw() -> list[Fault]:
    """Return the faults."""
    rng = random.Random(SEED)
    drawn = []
    for pattern, count in LANGUAGES.items():
        paths = sorted(path.relative_to(ROOT).as_posix() for path in ROOT.glob(pattern))
        drawn += rng.sample([fault for path in paths for fault in list_faults(path)], count)
    return drawn


def list_faults(path: str) -> Iterator[Fault]:
    """Yield a fault for each operator, comparison and number of a file."""
    text = (ROOT / path).read_text(encoding="utf-8")
    code = hide_prose(text) if path.endswith(".py") else PROSE.sub(blank, text)
    for found in OPERATOR.finditer(code):
        yield Fault(path, found.start(), found[0], INSTEAD[found[0]])
    for found in NUMBER.finditer(code):
        yield Fault(path, found.start(), found[0], str(float(found[0]) + 1).removesuffix(".0"))


def blank(found: re.Match[str]) -> str:
    """Return as many blanks as the text that was found has characters."""
    return re.sub(r"[^\n]", " ", found[0])


def hide_prose(text: str) -> str:
    """Return Python with blanks for texts and comments."""
    lines = text.splitlines(keepends=True)
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line))
    hidden = list(text)
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type in (tokenize.STRING, tokenize.COMMENT):
            begin, end = (starts[row - 1] + column for row, column in (token.start, token.end))
            hidden[begin:end] = ["\n" if each == "\n" else " " for each in text[begin:end]]
    return "".join(hidden)


def copy_checkout(folder: Path) -> Path:
    """Copy the checkout with its kernel, and link the environment."""
    shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns(*NOT_COPIED))
    (folder / ".venv").symlink_to(ROOT / ".venv")
    return folder


def is_seen(fault: Fault, stage: str, copy: Path) -> bool:
    """Return True if the tests of a stage, or the compiler, see a fault."""
    words = {
        STAGES[0]: find_tests(fault.path),
        STAGES[1]: [*TOGETHER, "test"],
        STAGES[2]: [*TOGETHER, "-m", "slow", "test"],
    }[stage]
    path = copy / fault.path
    right = path.read_text(encoding="utf-8")
    path.write_text(fault.apply(right), encoding="utf-8")
    try:
        return not (build(fault, copy) and passes(copy, *words))
    finally:
        path.write_text(right, encoding="utf-8")
        build(fault, copy)


def build(fault: Fault, copy: Path) -> bool:
    """Compile the kernel if the fault is in it; return False if that fails."""
    if not fault.path.endswith("pp"):
        return True
    words = [sys.executable, "setup.py", "build_ext", "--inplace"]
    return not subprocess.run(words, cwd=copy, capture_output=True, check=False).returncode


def find_tests(path: str) -> list[str]:
    """Return the folder of tests that mirrors the folder of a file."""
    inner = Path(path).relative_to("symtop_ros").parent
    folders = [Path("test") / each for each in (inner, *inner.parents)]
    return [str(next(each for each in folders if (ROOT / each).is_dir()))]


def passes(copy: Path, *words: str) -> bool:
    """Return True if the tests pass in the copy, the programs that they start included."""
    environment = {**os.environ, "PYTHONPATH": str(copy), "HEADLESS_SHELL": "1"}
    environment["OPENBLAS_NUM_THREADS"] = "1"
    done = subprocess.run(
        [*PYTEST, *words], cwd=copy, env=environment, capture_output=True, check=False
    )
    return done.returncode in (0, 5)  # 5: the folder has no tests


if __name__ == "__main__":
    sys.exit(main())
