"""A claim of the article, what was measured of it, and tables of claims."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import wrap

WIDTH = 96  # characters of a line


@dataclass(frozen=True, slots=True)
class Claim:
    """A sentence that can be checked.

    Attributes
    ----------
    sentence : str
        What is claimed.
    measured : str
        What was found, with units.
    holds : bool
        Whether the one bears out the other.
    """

    sentence: str
    measured: str
    holds: bool

    @property
    def verdict(self) -> str:
        """The outcome in a word."""
        return "pass" if self.holds else "FAIL"


def table(claims: Sequence[Claim]) -> str:
    """Return the claims as text for a terminal, what was measured below each sentence."""
    blocks = []
    for number, claim in enumerate(claims, start=1):
        lines = wrap(claim.sentence, WIDTH - 9)
        lines += wrap(claim.measured, WIDTH - 11, initial_indent="  ", subsequent_indent="  ")
        head = f"{number:2}  {claim.verdict} "
        blocks += [head + lines[0], *(" " * len(head) + line for line in lines[1:])]
    return "\n".join([*blocks, "", tally(claims)])


def markdown(claims: Sequence[Claim]) -> str:
    """Return the claims as a table of Markdown."""
    rows = [
        f"| {number} | {_cell(claim.sentence)} | {_cell(claim.measured)} | {claim.verdict} |"
        for number, claim in enumerate(claims, start=1)
    ]
    head = ["| | claim | measured | |", "|--:|---|---|---|"]
    return "\n".join([*head, *rows, "", tally(claims), ""])


def tally(claims: Sequence[Claim]) -> str:
    """Return how many of the claims hold, as a sentence."""
    return f"{sum(claim.holds for claim in claims)} of {len(claims)} claims hold."


def _cell(text: str) -> str:
    """Text in which Markdown sees no cell borders and no emphasis."""
    for character in "\\|*_":
        text = text.replace(character, f"\\{character}")
    return text
