"""The HTML site builds without a warning, is complete, and needs no network."""

import inspect
import re
import sys

import pytest
from documents import ROOT
from programs import execute

from symtop_ros import physics

pytestmark = [pytest.mark.untraced, pytest.mark.long]
LOADED = re.compile(r'<(?:script|img|link)[^>]*(?:src|href)="([^"]+)"')


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-c", "docs/site"]
    words = [*command, "-d", folder / "doctrees", "-b", "html", ".", folder / "html"]
    built = execute(words, cwd=ROOT, timeout=120)
    assert (built.returncode, built.stderr) == (0, "")
    return folder / "html"


def test_each_document_has_a_page(site):
    for document in [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")]:
        assert (site / document.relative_to(ROOT)).with_suffix(".html").is_file()


def test_pages_load_nothing_from_a_network(site):
    for page in site.rglob("*.html"):
        for address in LOADED.findall(page.read_text()):
            if address.startswith("data:"):  # the icon of the page with the top
                continue
            assert "//" not in address, (page, address)
            assert (page.parent / address.partition("?")[0].partition("#")[0]).exists(), address


def test_the_pages_of_the_library_and_the_article_have_a_live_top(site):
    for name, opened in (("library", "theta=0.5"), ("article", "scene=cusps")):
        page = (site / "docs" / f"{name}.html").read_text()
        (frame,) = re.findall(r'<iframe src="\.\./top\.html#([^"]+)"', page)
        assert frame.startswith(opened)
    assert '<a href="../top.html#scene=disc">' in page


def test_each_public_name_of_the_library_is_described(site):
    page = (site / "docs" / "site" / "api.html").read_text()
    described = (inspect.isclass, inspect.isroutine)  # constants and names of types have no text
    names = [each for each in physics.__all__ if any(f(getattr(physics, each)) for f in described)]
    assert len(names) > 20
    for name in names:
        assert f'id="symtop_ros.physics.{name}"' in page
