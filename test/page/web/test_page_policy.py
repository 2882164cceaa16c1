"""The page runs no other code: data stand as data, and its policy allows its own script."""

import time

import pytest
from page.web.opened import FUNCTIONS, KNOWN, USUAL
from run.simulation.page_runs import change
from serving import serving

from symtop_ros.page.web.join import EXPORT, MODULES, write_file

SITE = "http://top.test/"
HOSTILE = (
    ";/*END*/window.pwned = 1;//",
    "</script><script>window.pwned = 1</script>",
    "<!--<script>window.pwned = 1",
    "\\u003c/script\\u003e<img src=x onerror='window.pwned = 1'>",
)
FORBIDDEN = ["connect-src", "frame-src", "img-src", "media-src", "script-src", "script-src-attr"]
FORBIDDEN += ["script-src-elem", "style-src-attr", "style-src-elem"]


class Node:
    """A node without events."""

    def follow(self):
        while True:
            yield {"events": [], "lost": "no node here"}
            time.sleep(0.1)

    def answer(self, request):
        return {"granted": True, "answer": ""}


@pytest.fixture
def tab(browser):
    context = browser.new_context()
    context.add_init_script(FUNCTIONS + KNOWN + USUAL)
    yield context.new_page()
    context.close()


def attack(frame, own="http://elsewhere.test/"):
    answer = frame.evaluate("acts.attack", own)
    assert answer["forbidden"] == FORBIDDEN
    return answer["done"]


def check(frame):
    """The page works, and no attack does."""
    frame.locator("#headline:not(:empty)").wait_for()
    frame.locator("#hurry").click()
    assert "without the push" in frame.locator("#headline").text_content()
    assert attack(frame) == []


def test_the_page_is_small_enough_to_be_sent_by_mail():
    assert len(write_file().encode()) < 600_000


def test_what_modules_export_is_what_the_joined_script_takes():
    """Constants and classes, and no functions by other words: those would break the whole page."""
    for path in MODULES.rglob("*.js"):
        lines = [each for each in path.read_text().split("\n") if each.startswith("export")]
        assert all(map(EXPORT.match, lines)), path


@pytest.mark.slow
def test_a_hostile_text_is_only_a_text_in_a_saved_page_of_a_saved_page(open_page, tmp_path):
    run = change(1)
    file = tmp_path / "run.html"
    run["events"] = [{**event, "request": text} for event, text in zip_texts(run["events"])]
    file.write_text(write_file(run=run))
    for _ in range(3):
        page = open_page(file=file)
        file = page.save("This run as a page", tmp_path)
        assert file.stat().st_size - len(write_file().encode()) < 20_000
        assert [event["request"] for event in page.read_events()] == [*HOSTILE]
        assert page.tab.evaluate("window.pwned") is None
    check(page.tab.main_frame)
    page.problems.clear()  # what was forbidden
    page.requests.clear()


def zip_texts(events):
    return zip([*events, events[-1]], HOSTILE, strict=True)


def test_a_saved_page_that_is_dropped_onto_a_page_is_opened(opened, tmp_path):
    opened.tab.click("#hurry")
    events = opened.read_events()
    saved = opened.save("This run as a page", tmp_path)
    opened.press("r")
    assert opened.read_events() != events
    opened.tab.evaluate("acts.drop", ["top.html", saved.read_text()])
    opened.until(lambda: opened.read_events() == events)


@pytest.mark.slow
def test_the_policy_holds_in_a_page_that_is_served(tab):
    with serving(write_file()) as server:
        tab.goto(server.url)
        check(tab.main_frame)


@pytest.mark.slow
def test_the_policy_of_a_node_allows_its_server_only(tab):
    with serving(write_file(node="/top"), Node()) as server:
        tab.goto(server.url)
        tab.wait_for_selector("#lost:not([hidden])")
        assert tab.text_content("#lost") == "no node here"
        assert attack(tab.main_frame, f"{server.url}news") == [f"{server.url}news"]


@pytest.mark.slow
def test_the_policy_holds_in_a_frame_of_the_site(tab):
    pages = {
        "docs/library.html": "<!doctype html><iframe src='../top.html#theta=0.6&psi_dot=200' "
        "width=900 height=700></iframe>",
        "top.html": write_file(),
    }
    tab.route(
        f"{SITE}**",
        lambda route: route.fulfill(
            body=pages[route.request.url.removeprefix(SITE).split("#")[0]],
            content_type="text/html; charset=utf-8",
        ),
    )
    tab.goto(f"{SITE}docs/library.html")
    check(tab.frame(url=f"{SITE}top.html*"))
