"""Retell the article in a folder: its claims with numbers, its figures, and its motions in 3D."""

from pathlib import Path

from symtop_ros.article.answers.corrections import claims_on_corrections
from symtop_ros.article.answers.fictitious import claims_on_fictitious_forces
from symtop_ros.article.answers.release import claims_on_release
from symtop_ros.article.claims import Claim, markdown, table
from symtop_ros.article.figures import FIGURES
from symtop_ros.article.kinds import claims_on_kinds
from symtop_ros.article.momentum import claims_on_momentum
from symtop_ros.article.motions import TOP
from symtop_ros.article.nutation import claims_on_nutation
from symtop_ros.article.pivot import claims_on_pivot
from symtop_ros.article.rates import claims_on_rates
from symtop_ros.article.recordings import write_recordings
from symtop_ros.article.torque import claims_on_torque
from symtop_ros.drawing.style import write_figures
from symtop_ros.physics import Top


def retell(folder: Path) -> int:
    """Write figures, recordings and claims.md; print the claims; return the exit status."""
    folder.mkdir(parents=True, exist_ok=True)
    claims = check_claims()
    (folder / "claims.md").write_text(markdown(claims), encoding="utf-8")
    write_figures(FIGURES, folder)
    write_recordings(folder)
    print(table(claims))
    return 0 if all(claim.holds for claim in claims) else 1


def check_claims(top: Top = TOP) -> list[Claim]:
    """Check every claim of the article for its top, or for a different one."""
    return [
        *claims_on_torque(top),
        *claims_on_momentum(top),
        *claims_on_rates(top),
        *claims_on_nutation(top),
        *claims_on_kinds(top),
        *claims_on_pivot(top),
        *claims_on_fictitious_forces(top),
        *claims_on_release(top),
        *claims_on_corrections(top),
    ]
