"""A claim of the article with the value that was measured for it, and tables of claims."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import wrap

WIDTH = 96  # characters in a line


@dataclass(frozen=True, slots=True)
class Claim:
    """A sentence that can be checked.

    Attributes
    ----------
    sentence : str
        The claim.
    measured : str
        The measured values with units.
    holds : bool
        True if the measurement confirms the sentence.
    equation : str
        The equation behind the sentence, in the symbols of the article.
    tolerance : str
        The bound on the measured values, with its reason.

    Examples
    --------
    >>> Claim("The period is about 0.16 s.", "0.1607 s", holds=True).verdict
    'pass'
    """

    sentence: str
    measured: str
    holds: bool
    equation: str = ""
    tolerance: str = ""

    @property
    def verdict(self) -> str:
        """Return "pass" or "FAIL"."""
        return "pass" if self.holds else "FAIL"


def table(claims: Sequence[Claim]) -> str:
    """Return the claims as text for a terminal: sentence, equation, measurement, tolerance.

    Examples
    --------
    >>> print(table([Claim("The period is about 0.16 s.", "0.1607 s", holds=True)]))
     1  pass The period is about 0.16 s.
               0.1607 s
    <BLANKLINE>
    1 of 1 claims hold.
    """
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
    """Return the claims as a Markdown table.

    Examples
    --------
    >>> print(markdown([Claim("The period is about 0.16 s.", "0.1607 s", holds=True)]))
    | | claim | equation | measured | tolerance | |
    |--:|---|---|---|---|---|
    | 1 | The period is about 0.16 s. |  | 0.1607 s |  | pass |
    <BLANKLINE>
    1 of 1 claims hold.
    <BLANKLINE>
    """
    rows = [
        f"| {number} | {' | '.join(map(_cell, _texts(claim)))} | {claim.verdict} |"
        for number, claim in enumerate(claims, start=1)
    ]
    head = ["| | claim | equation | measured | tolerance | |", "|--:|---|---|---|---|---|"]
    return "\n".join([*head, *rows, "", summarize(claims), ""])


def summarize(claims: Sequence[Claim]) -> str:
    """Return the number of claims that hold, as a sentence.

    Examples
    --------
    >>> summarize([Claim("The top rises.", "it falls", holds=False)])
    '0 of 1 claims hold.'
    """
    return f"{sum(claim.holds for claim in claims)} of {len(claims)} claims hold."


def _texts(claim: Claim) -> tuple[str, str, str, str]:
    return claim.sentence, claim.equation, claim.measured, claim.tolerance


def _cell(text: str) -> str:
    """Escape the characters that Markdown would read as cell borders or emphasis."""
    for character in "\\|*_":
        text = text.replace(character, f"\\{character}")
    return text
