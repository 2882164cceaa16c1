"""A browser for all tests of the page, and the page in it."""

from pathlib import Path

import pytest
from page.web.modules import load_kernel, open_tab
from page.web.opened import KNOWN, USUAL, Opened

from symtop_ros.page.web.join import write_file
from workshop import page_coverage


@pytest.fixture(scope="module")
def tab(browser):
    """A tab in which each module can be imported, with a kernel."""
    tab = open_tab(browser)
    load_kernel(tab)
    yield tab
    tab.close()


@pytest.fixture(scope="module")
def films(tab):
    """The tab with what tests do with films."""
    tab.add_script_tag(content=Path(__file__).with_name("film_acts.js").read_text())
    return tab


@pytest.fixture(scope="session")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("file") / "top.html"
    path.write_text(write_file(), encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def spare():
    """Unused tabs, by whether their browsers know the page: a new one takes longer."""
    return {KNOWN: [], "": []}


@pytest.fixture
def open_page(browser, path, spare, request):
    """A function that opens the page, with a fragment, in a browser of some kind."""
    used = []
    failed = request.session.testsfailed

    def open_one(fragment="", file=path, script=USUAL, known=KNOWN, locale="en-US", **look):
        # lines are counted when a browser is closed
        is_usual = (script, locale) == (USUAL, "en-US") and not page_coverage.FOLDER
        free = spare[known] if is_usual else None
        page = free.pop() if free else Opened(browser, script, known, locale)
        used.append((page, free))
        return page.open(file, fragment, **look)

    yield open_one
    for page, free in used:
        if free is None or request.session.testsfailed > failed:  # a key may be pressed
            page.close()
        else:
            page.leave()
            free.append(page)


@pytest.fixture
def opened(open_page):
    return open_page()


@pytest.fixture(scope="module")
def _shared(browser, path):
    page = Opened(browser)
    yield page.open(path)
    page.close()


@pytest.fixture
def shared(_shared, path, request):
    """The page, opened once for all tests of a file that ask for it, and put back after each."""
    failed = request.session.testsfailed
    yield _shared
    if request.session.testsfailed > failed:  # a key may be pressed
        _shared.open(path)
    else:
        _shared.put_back()
