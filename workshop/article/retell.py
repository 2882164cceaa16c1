"""Retell the article in a folder: its claims with numbers, its figures, and its motions in 3D."""

from pathlib import Path

from symtop_ros.judge.figures import write_figures
from symtop_ros.physics import Top
from workshop.article.answers.corrections import claims_on_corrections
from workshop.article.answers.fictitious import claims_on_fictitious_forces
from workshop.article.answers.ledger import claims_on_energy
from workshop.article.answers.release import claims_on_release
from workshop.article.answers.resolution import claims_on_resolution
from workshop.article.answers.starts import claims_on_starts
from workshop.article.answers.statements import claims_on_statements
from workshop.article.claims import Claim, markdown, table
from workshop.article.figures import FIGURES
from workshop.article.frames import claims_on_frames
from workshop.article.kinds import claims_on_kinds
from workshop.article.momentum import claims_on_momentum
from workshop.article.motions import TOP
from workshop.article.nutation import claims_on_nutation
from workshop.article.pivot import claims_on_pivot
from workshop.article.rates import claims_on_rates
from workshop.article.recordings import write_recordings
from workshop.article.torque import claims_on_torque


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
        *claims_on_energy(top),
        *claims_on_starts(top),
        *claims_on_resolution(top),
        *claims_on_statements(top),
        *claims_on_frames(top),
    ]
