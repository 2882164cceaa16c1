"""A claim of the article with the value that was measured for it, and tables of claims."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, wraps
from importlib import import_module
from inspect import signature
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np
import yaml

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Top
from workshop.article.motions import TOP

TEXTS = Path(__file__).with_name("texts")
WIDTH = 96  # characters in a line
MODULES = (
    "torque",
    "rates",
    "nutation",
    "pivot",
    "frames",
    "answers.fictitious",
    "answers.release",
    "answers.ledger",
    "answers.starts",
    "answers.resolution",
    "answers.statements",
)
# The files of texts, in the order of the claims
CHAPTERS = (
    "torque",
    "momentum",
    "rates",
    "nutation",
    "kinds",
    "pivot",
    "fictitious",
    "release",
    "corrections",
    "ledger",
    "starts",
    "resolution",
    "statements",
    "frames",
)
# Characters that Markdown would read as cell borders or emphasis
ESCAPES = str.maketrans({character: f"\\{character}" for character in "\\|*_"})


@dataclass(frozen=True, slots=True)
class Claim:
    """A sentence that can be checked."""

    sentence: str  # the claim
    measured: str  # the measured values with units
    holds: bool  # True if the measurement confirms the sentence
    equation: str = ""  # the equation behind the sentence, in the symbols of the article
    tolerance: str = ""  # the bound on the measured values, with its reason

    @property
    def verdict(self) -> str:
        """Return "pass" or "FAIL"."""
        return "pass" if self.holds else "FAIL"


# The checks by their names, each with the further arguments of its claims
CHECKS: dict[str, tuple[Callable[..., Claim], list[tuple[Any, ...]]]] = {}


class Measured:
    """The result of a check: whether the claim holds, and the values that its texts name."""

    def __init__(self, holds: Any, **values: Any) -> None:
        self.holds = bool(holds)
        self.values = values


@cache
def read_texts() -> Mapping[str, Mapping[str, str]]:
    """Return the texts of all claims, in their order, by the names of the checks."""
    files = [(TEXTS / f"{chapter}.yaml").read_text(encoding="utf-8") for chapter in CHAPTERS]
    return {name: texts for file in files for name, texts in yaml.safe_load(file).items()}


def claim(*cases: Any) -> Callable[[Callable[..., Measured]], Callable[..., Claim]]:
    """Decorate a check of a top: it returns a claim, whose texts are those of its name.

    They name its arguments, the values that it has found, and constants of its module. With cases
    it makes a claim of each of them, which is its further argument, or a tuple of several. A check
    that cannot be made is a claim that fails: for a falsified constant a root may not be
    bracketed, or an extremum may not exist.
    """

    def decorate(check: Callable[..., Measured]) -> Callable[..., Claim]:
        @wraps(check)
        def attempt(*args: Any) -> Claim:
            try:
                with np.errstate(all="ignore"):  # what is not a number does not hold
                    found = check(*args)
                given = dict(zip(signature(check).parameters, args, strict=False))
                values = check.__globals__ | given | found.values
                texts = read_texts()[check.__name__].items()
                said = {field: text.format_map(values) for field, text in texts}
                return Claim(holds=found.holds, **said)
            except (ValueError, ArithmeticError, IndexError) as reason:
                sentence = (check.__doc__ or check.__name__).partition("\n")[0]
                return Claim(sentence, f"cannot be measured: {reason}", holds=False)

        listed = [case if isinstance(case, tuple) else (case,) for case in cases]
        CHECKS[check.__name__] = attempt, listed or [()]
        return attempt

    return decorate


def check_claims(top: Top = TOP) -> list[Claim]:
    """Check every claim of the article for its top, or for a different one."""
    for module in MODULES:
        import_module(f"workshop.article.{module}")
    order = list(read_texts())
    checks = [CHECKS[name] for name in sorted(CHECKS, key=order.index)]
    return [check(top, *case) for check, cases in checks for case in cases]


def differ(found: Real, expected: Real) -> float:
    """Return the largest difference of two arrays, as a part of the largest number expected."""
    return float(np.abs(found - expected).max() / np.abs(expected).max())


def table(claims: Sequence[Claim]) -> str:
    """Return the claims as text for a terminal: sentence, equation, measurement, tolerance."""
    blocks = []
    for number, claim in enumerate(claims, start=1):
        lines = wrap(claim.sentence, WIDTH - 9)
        tolerance = f"tolerance {claim.tolerance}" if claim.tolerance else ""
        for text in (claim.equation, claim.measured, tolerance):
            lines += wrap(text, WIDTH - 11, initial_indent="  ", subsequent_indent="  ")
        head = f"{number:2}  {claim.verdict} "
        blocks += [head + lines[0], *(" " * len(head) + line for line in lines[1:])]
    return "\n".join([*blocks, "", summarize(claims)])


def markdown(claims: Sequence[Claim]) -> str:
    """Return the claims as a Markdown table."""
    rows = []
    for number, claim in enumerate(claims, start=1):
        texts = claim.sentence, claim.equation, claim.measured, claim.tolerance
        cells = [text.translate(ESCAPES) for text in texts]
        rows.append(f"| {number} | {' | '.join(cells)} | {claim.verdict} |")
    head = ["| | claim | equation | measured | tolerance | |", "|--:|---|---|---|---|---|"]
    return "\n".join([*head, *rows, "", summarize(claims), ""])


def summarize(claims: Sequence[Claim]) -> str:
    """Return the number of claims that hold, as a sentence."""
    return f"{sum(claim.holds for claim in claims)} of {len(claims)} claims hold."
