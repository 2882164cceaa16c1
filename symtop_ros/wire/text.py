"""Text that came from elsewhere, for an answer or a terminal."""

from __future__ import annotations

LONGEST = 400  # characters of a sentence


def one_line(text: object, longest: int = LONGEST) -> str:
    """Return text in one line that can be printed, shortened in its middle where it is too long."""
    whole = str(text)
    half = longest // 2
    if len(whole) > 4 * longest:  # its middle will not be seen
        whole = f"{whole[: 2 * longest]}{whole[-2 * longest :]}"
    line = "".join(_escaped(each) for each in " ".join(whole.split()))
    return line if len(line) <= longest else f"{line[: half - 3]}...{line[-half:]}"


def _escaped(character: str) -> str:
    return character if character.isprintable() else ascii(character)[1:-1]
