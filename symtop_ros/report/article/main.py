"""Retell the article into a folder: its claims with numbers, its figures, and two motions in 3D."""

from __future__ import annotations

import sys
from pathlib import Path

from symtop_ros.report.article.claim import Claim, markdown, table
from symtop_ros.report.article.claims import claims
from symtop_ros.report.article.figures import write_figures
from symtop_ros.report.article.recordings import write_recordings


def retell(folder: Path) -> int:
    """Write figures, recordings and claims.md; print the claims.

    Parameters
    ----------
    folder : Path
        Is made where there is none; files of the same names are replaced.

    Returns
    -------
    int
        Exit status: 0 where all claims hold, 1 where one does not, or a file cannot be written.
    """
    try:
        found = _written(folder)
    except OSError as error:
        print(f"top_report: {error.filename or folder}: {error.strerror or error}", file=sys.stderr)
        return 1
    print(table(found))
    return 0 if all(claim.holds for claim in found) else 1


def _written(folder: Path) -> list[Claim]:
    folder.mkdir(parents=True, exist_ok=True)
    found = claims()
    (folder / "claims.md").write_text(markdown(found), encoding="utf-8")
    write_figures(folder)
    write_recordings(folder)
    return found
