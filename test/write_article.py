"""Draw the figures in docs/article.md: PYTHONPATH=test python test/write_article.py."""

from __future__ import annotations

from pathlib import Path

from workshop.article.figures import FIGURES
from workshop.article.lesson import pack_figure

FOLDER = Path(__file__).parents[1] / "docs/article"


def main() -> None:
    """Draw all figures."""
    FOLDER.mkdir(exist_ok=True)
    for name, draw in FIGURES.items():
        (FOLDER / f"{name}.png").write_bytes(pack_figure(draw))


if __name__ == "__main__":
    main()
