"""A browser for all tests of the page, and the page in it."""

import pytest
from web.modules import load_kernel, open_tab
from web.opened import Opened

from symtop_ros.web.join import write_file


@pytest.fixture(scope="session")
def browser():
    from browser import running_browser  # it needs Playwright

    with running_browser() as running:
        yield running


@pytest.fixture(scope="module")
def tab(browser):
    """A tab in which each module can be imported, with a kernel."""
    tab = open_tab(browser)
    load_kernel(tab)
    yield tab
    tab.close()


@pytest.fixture(scope="session")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("file") / "top.html"
    path.write_text(write_file(), encoding="utf-8")
    return path


@pytest.fixture
def open_page(browser, path):
    """A function that opens the page, with a fragment and options of the browser's context."""
    pages = []

    def open_one(fragment="", file=path, **options):
        pages.append(Opened(browser, file, fragment, **options))
        return pages[-1]

    yield open_one
    for page in pages:
        page.close()


@pytest.fixture
def opened(open_page):
    return open_page()
