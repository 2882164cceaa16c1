"""A run in one file: opened without a server and without a network, it moves as the run did."""

import json
import re

import numpy as np
import pytest
from browser import FEW_FRAMES, running_browser

from symtop_ros.panel.source import LocalTop
from symtop_ros.web.facts import compare
from symtop_ros.web.run import Run
from symtop_ros.web.saved import FRAME, save_run
from symtop_ros.wording import write

TIMEOUT = 60.0
STEP = 0.04  # s of the clock; a batch advances it by at most 0.05 s


@pytest.fixture(name="played", scope="module")
def _played():
    """A run of some seconds with a kick, a pause, a step, and another start."""
    top, run, now = LocalTop("hurry_slow", factor=0.1), Run(), [0.0]

    def move(count):
        for _ in range(count):
            now[0] += STEP
            run.follow(top.batch())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("symtop_ros.panel.source.time.monotonic", lambda: now[0])
        top.watch(True)
        move(50)
        top.request("kick", {"precession_rate_factor": 1.4})
        move(60)
        top.request("pause", True)
        move(20)
        top.request("step", {"duration": 0.01})
        top.request("pause", False)
        move(30)
        top.close()
    return run


@pytest.fixture(name="page", scope="module")
def _page(played):
    return save_run([moment.event for moment in played.moments], played.stamp)


def data_of(page):
    return json.loads(re.search(r"window.SAVED_RUN = (.*);\n", page)[1])


def test_the_rows_are_those_of_the_run_without_its_pauses(played, page):
    data = data_of(page)
    rows = np.array([row[:4] + row[5:] for row in data["rows"]])
    assert np.all(np.diff(rows[:, 0]) >= 0)  # in 1e-6 s: an event may be near a frame
    series = played.series()
    assert rows[-1, 0] == pytest.approx(series[-1, 0], abs=2 * FRAME * 1e-10)  # a frame at 1/10
    for column in (1, 2, 3):
        expected = np.interp(rows[:, 0], series[:, 0], series[:, column])
        # The samples of the run are 5e-4 s apart, in which a nutation (40 rad/s) bends by 1e-4 of
        # its size; at the kick phi' jumps by 2.6 rad/s within one of these steps.
        apart = np.abs(rows[:, column] - expected)
        assert np.sort(apart)[-4] < 2e-4 * np.ptp(series[:, column]) + 1e-5
    # 140 batches of the clock, of which 0.6 s of a step are shown
    assert rows[-1, -1] == pytest.approx(140 * STEP, abs=0.5)


def test_the_facts_change_with_the_motion(played, page):
    facts = data_of(page)["facts"]
    headlines = [each[1]["headline"] for each in facts]
    assert headlines[-1] == write("headline", compare(played.announced))
    assert headlines[0] != headlines[-1]
    # 50 batches at a tenth of real time, of which the first one begins to count
    assert facts[-1][1]["marks"] == pytest.approx([5 * STEP], abs=0.1 * STEP)


def test_of_a_long_run_the_end_is_kept(played, monkeypatch):
    shown = 3.0  # s
    monkeypatch.setattr("symtop_ros.web.saved.LONGEST", round(shown * 1e9))
    events = [moment.event for moment in played.moments]
    end = events[-1].stamp + round(10 * shown * 1e9)
    rows = data_of(save_run(events, end))["rows"]
    assert rows[-1][5] == pytest.approx(shown, abs=2 * FRAME * 1e-9)
    assert rows[0][0] > 0.1 * 8 * shown  # s of the motion, at a tenth of real time


@pytest.mark.parametrize("events", [0, 1])
def test_a_run_in_which_nothing_moves_is_refused(played, events):
    first = [moment.event for moment in played.moments][:events]
    with pytest.raises(ValueError, match="must last for some frames"):
        save_run(first, first[0].stamp if first else 0)


def test_the_file_plays_with_the_network_off(page, played, tmp_path):
    path = tmp_path / "run.html"
    path.write_text(page)
    with running_browser() as browser:
        context = browser.new_context(viewport={"width": 400, "height": 300}, offline=True)
        context.add_init_script(FEW_FRAMES)
        tab, asked = context.new_page(), []
        tab.on("request", lambda request: asked.append(request.url))
        tab.goto(path.as_uri())
        scene = tab.frame_locator("iframe")
        scene.locator("canvas").first.wait_for(timeout=TIMEOUT * 1000)
        headline = tab.locator("#headline")
        seen, angles = set(), set()
        for _ in range(600):
            tab.wait_for_timeout(50)
            seen.add(headline.inner_text())
            angles.add(tab.locator("body").get_attribute("data-theta"))
            if len(seen) == 2 and len(angles) > 5:
                break
        assert seen == {each[1]["headline"] for each in data_of(page)["facts"]}
        assert len(angles) > 5  # the charts move
        assert tab.locator("#theta .kick").count() == 1
        assert [url for url in asked if not re.match(r"(file|data|blob):", url)] == []
        context.close()
