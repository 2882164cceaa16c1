"""The cost of the page: CPU time of the server, updates that pages get, and memory."""

import time

import pytest
from panel.page_cost import SLOW, measure, measure_age
from panel.pages import open_pages, running_panel

from symtop_ros.panel.page import Page
from symtop_ros.panel.server import LOCAL_HOST
from symtop_ros.panel.source import LocalTop
from symtop_ros.web.scene import CHUNKS
from workshop.load.usage import memory

pytestmark = pytest.mark.untraced
HALF_AN_HOUR = 1800.0  # s
# The series of the run, 2.2 MB, fill in the first minutes; the rest is what allocators keep.
GROWTH = 6.0  # MB


@pytest.fixture(scope="module", name="panel")
def _panel():
    with running_panel() as (process, url):
        yield process.pid, url


@pytest.mark.realtime
def test_a_closed_page_costs_next_to_nothing(panel):
    """Rates and CPU times of the page are measured by page_cost.py, not in this test."""
    cost = measure(*panel, 1, 2.0)
    assert cost.updates > 0
    # Closed, the page costs a look at the events twice a second: measured 0.2 %, and the clock
    # of CPU times has steps of 1 % here.
    assert measure(*panel, 0, 1.0).cpu < max(2.1, cost.cpu / 4)


@pytest.mark.realtime
def test_a_frame_is_not_old_behind_a_slow_line(panel):
    assert measure_age(panel[1], SLOW, 3.0) < 0.3  # s; measured 0.04


@pytest.mark.realtime
def test_a_page_gets_less_than_100_kilobytes_a_second(panel):
    assert measure(*panel, 1, 3.0).kilobytes < 100  # measured 50


@pytest.mark.long
def test_one_page_is_updated_60_times_a_second_for_a_quarter_of_a_core(panel):
    cost = measure(*panel, 1, 10.0)
    assert cost.updates > 57  # of 60: a frame may be late on a machine under load
    assert cost.cpu < 25


def test_frames_leave_nothing_behind():
    """Viser keeps one message for each property, for pages that are opened later."""
    page = Page(LocalTop("hurry_slow", factor=0.1), LOCAL_HOST, 0)
    kept = page.server._websock_server._broadcast_buffer.message_from_id
    try:
        with open_pages(page.server.url):
            counts = []
            for k in range(4):
                page.actions.start({"theta": 0.3 + 0.1 * k})
                page.actions.kick(1.4)  # so that the ghost moves in all frames below
                frame = page.frames
                deadline = time.monotonic() + 60
                while page.frames < frame + 30:
                    assert time.monotonic() < deadline
                    time.sleep(0.01)
                counts.append(len(kept))
        # The nodes of the trace are written one after the other, each for the first time once.
        assert counts[3] - counts[1] <= CHUNKS
    finally:
        page.close()


@pytest.mark.long
def test_ten_pages_are_updated_30_times_a_second(panel):
    cost = measure(*panel, 10, 20.0)
    assert cost.updates >= 30
    assert cost.cpu < 50


@pytest.mark.long
def test_the_memory_is_flat_over_half_an_hour():
    with running_panel() as (process, url), open_pages(url):
        time.sleep(HALF_AN_HOUR / 10)
        before = memory(process.pid)
        time.sleep(0.9 * HALF_AN_HOUR)
        assert memory(process.pid) - before < GROWTH
