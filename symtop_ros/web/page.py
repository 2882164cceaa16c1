"""The page: its markup with its script in it."""

from pathlib import Path

FOLDER = Path(__file__).parent
# Viser's own panel, on a narrow page at its lower edge, and notices such as that of a software
# renderer, which would cover the scene.
HIDING = (
    "<style>[data-testid=floating-panel], .mantine-Notifications-root, "
    '#root [style*="position: fixed"][style*="20em"] { display: none !important; }</style>'
)


def write_page(data: str = "") -> str:
    """Return the page as one document, with the data of a saved run if there are any."""
    markup, *scripts = (
        (FOLDER / name).read_text(encoding="utf-8")
        for name in ("page.html", "lesson.js", "page.js")
    )
    return markup.replace("/*SCRIPT*/", f"{data}{''.join(scripts)}", 1)
