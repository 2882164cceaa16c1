"""The news of a node for the pages, without a node: its clock and its events are the test's."""

from dataclasses import replace

from log_files import ARTICLE, CUSPS

from symtop_ros.page.panel.news import KEPT, SILENCE, News
from symtop_ros.physics import Motion
from symtop_ros.run.simulation.changes.follow import Act, follow
from symtop_ros.run.simulation.events import Event, start_event

START = start_event(Motion(ARTICLE, CUSPS))
UP = (0.0, 0.0, 0.0, 1.0)  # x, y, z, w


class Clock:
    def __init__(self):
        self.now = 1000.0

    def __call__(self):
        return self.now


def pages(news):
    """Return what a page follows, which has had the first message."""
    page = news.follow()
    return page, next(page)


def later(number, name="reset"):
    return replace(START, name=name, values={**START.values, "number": str(number)})


def test_a_page_gets_the_run_so_far_and_then_what_is_new():
    news = News("/top")
    news.tell([START], (0, UP), is_expected=True)
    page, first = pages(news)
    assert first["new"]
    assert [each["name"] for each in first["events"]] == ["start"]
    assert first["orientation"] == [1.0, 0.0, 0.0, 0.0]
    assert first["lost"] is None
    kick = Event.of(follow(START.segment(), Act("kick", 500, {"precession_rate_factor": 1.5})), 2)
    news.tell([kick], None, is_expected=True)
    second = next(page)
    assert not second["new"]
    assert [each["record"]["kind"] for each in second["events"]] == ["kick"]
    news.tell([], (1500, UP), is_expected=True)
    assert next(page) == {"time": 1500, "orientation": [1.0, 0.0, 0.0, 0.0], "lost": None}


def test_a_sample_of_the_motion_before_an_event_is_not_drawn():
    news = News("/top")
    stamp = 500
    kick = Event.of(follow(START.segment(), Act("kick", stamp, {"precession_rate_factor": 1.5})), 2)
    news.tell([START, kick], (stamp - 1, UP), is_expected=True)
    _, first = pages(news)
    assert "orientation" not in first


def test_silence_counts_from_the_moment_at_which_samples_are_asked_for():
    clock = Clock()
    news = News("/top", clock)
    news.tell([START], None, is_expected=False)
    clock.now += 2 * SILENCE
    page, first = pages(news)
    assert first["lost"] is None
    news.expect()
    clock.now += SILENCE + 0.5
    news.tell([], None, is_expected=True)
    assert f"/top for {SILENCE:g} s" in next(page)["lost"]
    news.tell([], (0, UP), is_expected=True)
    assert next(page)["lost"] is None


def test_a_paused_node_is_not_silent():
    clock = Clock()
    news = News("/top", clock)
    pause = Event.of(follow(START.segment(), Act("pause", 500, {})), 2)
    news.tell([START, pause], None, is_expected=True)
    clock.now += 2 * SILENCE
    news.tell([], None, is_expected=True)
    assert pages(news)[1]["lost"] is None


def test_an_event_with_the_first_number_begins_a_new_run():
    news = News("/top")
    news.tell([START, later(2)], (0, UP), is_expected=True)
    page, first = pages(news)
    assert len(first["events"]) == 2
    news.tell([START], None, is_expected=True)  # as of another process
    second = next(page)
    assert second["new"]
    assert len(second["events"]) == 1
    assert "orientation" not in second


def test_of_a_long_run_a_page_gets_the_last_events():
    news = News("/top")
    news.tell([START, *(later(number) for number in range(2, KEPT + 10))], None, is_expected=True)
    _, first = pages(news)
    assert len(first["events"]) == KEPT


def test_the_pages_that_follow_are_counted_until_they_are_closed():
    news = News("/top")
    news.tell([START], None, is_expected=True)
    page, _ = pages(news)
    other, _ = pages(news)
    assert news.pages == 2
    page.close()
    assert news.pages == 1
    news.close()
    assert [*other] == []
    assert news.pages == 0
