"""Rerun's viewer in a browser reaches nothing but this machine."""

import re
from urllib.parse import urlsplit

import pytest
from browser import running_browser
from waiting import until

from symtop_ros.playback import viewer

TIMEOUT = 120.0


@pytest.fixture(name="address")
def _address(capsys):
    process = viewer.start(web=True)
    try:
        yield re.search(r"open (\S+) in", capsys.readouterr().out)[1]
    finally:
        process.terminate()
        process.wait(timeout=TIMEOUT)


def open_viewer(browser, address):
    """The hosts that the page asks, and those that its policy refuses, until the viewer runs."""
    tab = browser.new_page()
    asked, refused = [], []
    tab.on("response", lambda response: asked.append(urlsplit(response.url).hostname))
    tab.on("requestfinished", lambda request: asked.append(urlsplit(request.url).hostname))
    tab.on("console", lambda line: refused.append(line.text))
    until(lambda: tab.goto(f"{address}&renderer=webgl").status != 503, timeout=TIMEOUT)
    return tab, asked, [text for text in refused if "Content Security Policy" in text]


def test_the_page_asks_no_other_host(address):
    with running_browser() as browser:
        tab, asked, refused = open_viewer(browser, address)
        assert {host for host in asked if host} == {"127.0.0.1"}
        assert any("fonts.googleapis.com" in text for text in refused)  # as it tries to
        tab.close()
