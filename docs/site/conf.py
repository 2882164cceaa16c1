"""Settings of the HTML site, which `make docs` builds from the root of the repository."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

from symtop_ros import __version__

ROOT = Path(__file__).parents[2]
LINK = re.compile(r"\[([^\]]+)\]\(([^)#:]+)(?:#[^)]*)?\)")
TOP_LINK = re.compile(r"\[([^\]]+)\]\((\.\./top\.html[^)]*)\)")
# Documents with a live top before their first section, and what it shows. `make docs` writes the
# page next to the site.
LIVE = {"docs/library": "theta=0.5&psi_dot=200", "docs/article": "scene=cusps"}
FRAME = """
```{{raw}} html
<iframe src="../top.html#{}" title="A top to play with" loading="lazy"
  style="width: 100%; height: 640px; border: 1px solid #8884; border-radius: 8px"></iframe>
```

## """

project = "symtop_ros"
author = "The symtop_ros authors"
copyright = "2026 The symtop_ros authors"  # noqa: A001
version = release = __version__

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # the pages need no network
]
root_doc = "docs/site/index"
include_patterns = ["*.md", "*.rst", "docs/*.md", "docs/site/*.md", "symtop_ros/truth/testset/*.md"]
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings have the types
numpydoc_show_class_members = False
html_theme = "furo"
html_title = f"symtop_ros {release}"


def _unlink_sources(_: Sphinx, page: str, source: list[str]) -> None:
    """Show links to folders, and to documents that the site does not have, as text."""
    here = (ROOT / page).parent
    pages = {path for pattern in include_patterns for path in ROOT.glob(pattern)}

    def replace(link: re.Match[str]) -> str:
        target = (here / link[2]).resolve()
        has_page = target.suffix != ".md" or target in pages
        return link[0] if has_page and not target.is_dir() else f"`{link[2]}`"

    source[0] = LINK.sub(replace, source[0])


def _show_top(_: Sphinx, page: str, source: list[str]) -> None:
    """Let links lead to the page of the site, which is no document, and show it if it is live."""
    text = TOP_LINK.sub(r'<a href="\2">\1</a>', source[0])
    if page in LIVE:
        text = text.replace("\n## ", FRAME.format(LIVE[page]), 1)
    source[0] = text


def _escape_bars(*arguments: Any) -> None:
    """Keep |x| an absolute value: reStructuredText would look for a substitution named x."""
    lines: list[str] = arguments[-1]
    lines[:] = [
        line if line.lstrip().startswith((">>>", "...")) else line.replace("|", r"\|")
        for line in lines
    ]


def _skip_aliases(*arguments: Any) -> bool | None:
    """Leave out the fields of named tuples, which the section Attributes describes."""
    member = arguments[3]
    return True if (member.__doc__ or "").startswith("Alias for field") else None


def setup(app: Sphinx) -> None:
    """Connect what this file adds to Sphinx."""
    app.connect("source-read", _unlink_sources)
    app.connect("source-read", _show_top)
    app.connect("autodoc-process-docstring", _escape_bars)
    app.connect("autodoc-skip-member", _skip_aliases)
