"""Retell the article in a folder: its claims with numbers, its figures, and its motions in 3D."""

from pathlib import Path

from symtop_ros.base.figure_style import write_figures
from workshop.article.claims import check_claims, markdown, table
from workshop.article.figures import FIGURES
from workshop.article.recordings import write_recordings


def retell(folder: Path) -> int:
    """Write figures, recordings and claims.md; print the claims; return the exit status."""
    claims = check_claims()
    (folder / "claims.md").write_text(markdown(claims), encoding="utf-8")
    write_figures(FIGURES, folder)
    write_recordings(folder)
    print(table(claims))
    return 0 if all(claim.holds for claim in claims) else 1
