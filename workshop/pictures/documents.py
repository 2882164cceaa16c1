"""The pictures of the documents that show motions, and the steps of docs/lesson.md.

Those of the page, which need a browser, are drawn by page.py; the plots of what was measured are
written with their tables.
"""

import io
import sys
from pathlib import Path
from unittest import SkipTest

from workshop.article.figures import FIGURES
from workshop.article.maps import draw_map, map_spin
from workshop.lesson.page import PAGE, write_page
from workshop.lesson.pictures import write_lesson
from workshop.pictures.pack import pack, pack_figure
from workshop.pictures.replay import write_replays
from workshop.pictures.traces import draw_traces

POINTS = 1000  # along each side of the map of Perry's rule
MAP_COLORS = 64


def write_pictures(docs: Path) -> int:
    """Write the pictures into a folder such as docs; return the exit status."""
    (docs / "article").mkdir(parents=True, exist_ok=True)
    (docs / PAGE.name).write_text(write_page(), encoding="utf-8")
    (docs / "traces.svg").write_text(draw_traces(), encoding="utf-8")
    for name, draw in FIGURES.items():
        (docs / f"article/{name}.png").write_bytes(pack_figure(draw))
    print(f"wrote {len(FIGURES)} figures to {docs / 'article'}")
    write_lesson(docs / "lesson")
    drawn = io.BytesIO()
    draw_map(map_spin(POINTS), drawn)
    (docs / "perry.png").write_bytes(pack(drawn, MAP_COLORS))
    print(f"wrote {docs / 'perry.png'}")
    try:
        write_replays(docs)
    except SkipTest as reason:  # no program that renders without a screen
        print(f"workshop: {reason}", file=sys.stderr)
        return 1
    return 0
