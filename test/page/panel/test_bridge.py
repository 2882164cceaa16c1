"""A running node behind the page: its events and attitude, and the acts of the page's users."""

import contextlib
import re
import threading
from functools import partial

import pytest
import rclpy
from machine_time import measuring
from page.web.opened import UNDRAWN, slow_frames
from ros.node.listener import Listener
from ros.node.running_top import RunningTop
from serving import serving
from waiting import TIMEOUT, until

from symtop_ros.page.panel.bridge import Bridge
from symtop_ros.page.panel.news import SILENCE
from symtop_ros.page.web.join import write_file
from symtop_ros.physics import State
from workshop.load.domains import share_domain

DOMAIN = share_domain()


@contextlib.contextmanager
def bridge_to(name, context, timeout=TIMEOUT):
    user = rclpy.create_node("top_panel", context=context, start_parameter_services=False)
    bridge = Bridge(user, name, timeout)
    yield bridge
    bridge.close()
    user.destroy_node()


@pytest.fixture(name="node")
def _node():
    """A node in real time, which a thread spins as another process would, and the bridge to it."""
    # a torque lasts long enough for threads that other programs keep waiting
    slow = {"real_time_factor": 0.1, "applied_torque_timeout": 1.0}
    running = RunningTop(realtime=True, scene="cusps", **slow)
    ending = threading.Event()
    thread = threading.Thread(target=running.spin_until, args=(ending.is_set, 1e9), daemon=True)
    thread.start()
    with bridge_to("/top", running.context) as bridge:
        yield running, bridge
    ending.set()
    thread.join()
    running.close()


class Page:
    """The news of one page, while the test waits for them."""

    def __init__(self, bridge):
        self._news = bridge.follow()
        self.events = []
        self.new = []
        self.state = {}

    def look(self):
        message = next(self._news)
        self.events += message.get("events", [])
        self.new += [message["new"]] if "new" in message else []
        self.state |= {k: v for k, v in message.items() if k not in ("events", "new")}

    def until(self, condition):
        until(condition, self.look)

    def close(self):
        self._news.close()


@pytest.fixture(name="page")
def _page(node):
    page = Page(node[1])
    page.until(lambda: page.events and "orientation" in page.state)
    yield page
    page.close()


def ask(bridge, service, argument=None):
    answer = bridge.answer({"service": service, "argument": argument})
    return answer["granted"], answer["answer"]


def test_a_page_is_sent_the_run_and_the_published_attitude(node, page):
    running, _ = node
    assert page.new == [True]
    start = page.events[0]["record"]
    assert (start["kind"], start["time"]) == ("start", 0.0)
    segment = running.top.simulation.segment
    published = segment.motion.at(page.state["time"] / 1e9).orientation
    # the time of the run is rounded to whole ns, of a motion of some 200 rad/s
    assert page.state["orientation"] == pytest.approx(published.tolist(), abs=2e-7)
    assert page.events[0]["factor"] == 0.1
    page.until(lambda: page.state["lost"] is None)  # samples may be late


def test_integers_of_a_page_are_doubles_of_the_node(node, page):
    _, bridge = node
    values = {"theta": 1, "phi_dot": 0, "psi_dot": 200}  # as JSON writes 200.0
    assert ask(bridge, "set_initial_conditions", values)[0]
    page.until(lambda: page.events[-1].get("record", {}).get("kind") == "start" and page.events[1:])
    w, x, y, z = page.events[-1]["record"]["orientation"]
    assert State((w, x, y, z), (0, 0, 0)).euler_angles.theta == pytest.approx(1.0, abs=1e-15)
    assert ask(bridge, "set_parameters_atomically", {"top.Mgl": 1, "steady_torque": [0, 0, 1]})[0]


@pytest.mark.parametrize(
    ("request_", "start"),
    [
        ({}, "service must be "),
        ({"service": "set_parameters"}, "service must be "),
        ({"service": "kick", "argument": "9"}, "argument must be "),
        ({"service": "kick", "argument": {"precession_rate": {}}}, "argument must "),
        ({"service": "kick", "argument": {"precession_rate": None}}, "argument must have "),
        ({"torque": [0, 0]}, "torque must have 3 "),
        ({"torque": [0, 0, "x"]}, "torque must be "),
        ({"torque": [10**400, 0, 0]}, "torque must be "),
        ({"service": "kick", "argument": {"precession_rate": 10**400}}, "precession_rate must "),
    ],
)
def test_a_request_that_is_none_is_one_message(node, request_, start):
    answer = node[1].answer(request_)
    assert not answer["granted"]
    assert answer["answer"].startswith(start)


def test_pauses_leave_the_time_of_the_run_alone_and_a_step_moves_it(node, page):
    running, bridge = node
    assert ask(bridge, "pause", True)[0]
    page.until(lambda: page.events[-1]["running"] is False)
    assert "record" not in page.events[-1]
    segment = running.top.simulation.segment
    before = round(segment.elapsed)  # ns, at every stamp; the run has one motion
    page.until(lambda: page.state["time"] == before)
    assert ask(bridge, "step", {"duration": 0.01})[0]
    page.until(lambda: page.state["time"] == before + 10_000_000)


def test_a_torque_reaches_the_node_and_ends(node, page):
    _, bridge = node

    def torques():
        return [e["record"]["torque"][2] for e in page.events if e["name"] == "torque"]

    page.until(lambda: torques() or not bridge.answer({"torque": [0, 0, 5e-4]})["granted"])
    page.until(lambda: torques()[-1] == 0.0)
    assert torques()[0] == 5e-4


def test_a_recording_is_known_to_the_page(node, page, tmp_path, monkeypatch):
    pytest.importorskip("mcap")
    _, bridge = node
    monkeypatch.chdir(tmp_path)
    granted, answer = ask(bridge, "record", True)
    assert granted, answer
    page.until(lambda: page.events[-1].get("recording"))
    said, _, number = answer.rpartition(" [event ")
    assert (page.events[-1]["said"], number[-1]) == (said, "]")
    assert ask(bridge, "record", False)[0]
    page.until(lambda: page.events[-1].get("recording") is False)


def test_a_node_without_pages_sends_events_only(node):
    running, bridge = node

    def count():
        return running.top.count_subscribers("/top/orientation")

    until(lambda: count() == 0)
    page = Page(bridge)
    page.until(lambda: "orientation" in page.state)
    until(lambda: count() == 1)
    page.close()
    until(lambda: count() == 0)


def test_a_node_that_falls_silent_is_told_of_and_its_return(node, page):
    running, _ = node
    running.top.close()  # no samples: as after its end
    page.until(lambda: page.state["lost"])
    assert f"/top for {SILENCE:g} s" in page.state["lost"]

    def is_back():
        for _ in range(20):  # what is late is dropped by one tick, and published by the next one
            running.top.simulation.tick()
        return not page.state["lost"]

    page.until(is_back)


def test_a_missing_node_is_one_message():
    with (
        Listener(DOMAIN) as alone,
        bridge_to("missing", alone.context, timeout=0.1) as bridge,
    ):
        assert bridge.name == "/missing"
        granted, answer = ask(bridge, "kick", {"precession_rate": 1.0})
    assert not granted
    assert answer.startswith("no answer from /missing ")


def start_of(running):
    return running.top.simulation.timeline.start.euler_angles


@pytest.mark.slow
def test_the_page_in_a_browser_kicks_the_node_and_survives_its_server(node, browser):
    running, bridge = node
    page = write_file(node=bridge.name)
    tab = browser.new_page()
    tab.add_init_script(UNDRAWN)
    look = partial(tab.wait_for_timeout, 20)
    problems = []
    tab.on("pageerror", lambda error: problems.append(str(error)))
    with serving(page, bridge) as server:
        port = server.server_address[1]
        tab.goto(server.url)
        until(lambda: "cusps" in tab.text_content("#headline"), look)
        assert tab.is_hidden("#timeline")
        tab.click("#hurry")
        until(lambda: "without the push" in tab.text_content("#headline"), look)
        act = tab.evaluate("window.symtop.run().events.at(-1).act")
        assert act == {"precession_rate_factor": 1.4, "hold": "spin_momentum"}
        tab.click("#tab-start")
        tab.fill("#field-top\\.Mgl", "0.05")
        tab.press("#field-top\\.Mgl", "Enter")
        until(lambda: running.top.simulation.settings.top.Mgl == 0.05, look)
        dismissed = []
        tab.once("dialog", lambda dialog: dismissed.append(dialog.dismiss()))
        tab.goto(f"{server.url}#theta=1.5")  # a link of another page
        until(lambda: dismissed, look)
        assert start_of(running).theta == pytest.approx(0.5)
        tab.once("dialog", lambda dialog: dialog.accept())
        tab.goto(f"{server.url}#theta=1.25")
        until(lambda: abs(start_of(running).theta - 1.25) < 1e-9, look)
    until(lambda: "connection is lost" in tab.text_content("#lost"), look)
    with serving(page, bridge, port):
        until(lambda: tab.is_hidden("#lost"), look)
        tab.click("#tab-history")
        assert "again" not in tab.text_content("#refusal")
        until(lambda: "71.62°" in tab.text_content("#entries"), look)
    tab.close()
    assert problems == []


@pytest.mark.slow
def test_a_held_button_pushes_the_node_until_it_is_released(node, browser):
    running, bridge = node
    with serving(write_file(node=bridge.name), bridge) as server:
        tab = browser.new_page()
        tab.add_init_script(UNDRAWN)
        look = partial(tab.wait_for_timeout, 20)
        tab.goto(server.url)
        tab.click("#tab-push")
        button = tab.locator("[data-hold=press]")
        button.dispatch_event("pointerdown")
        until(lambda: re.search(r"sideways \d+ times", tab.text_content("#headline")), look)
        button.dispatch_event("pointerup")
        until(lambda: bridge.news.last.name == "release", look)
        given = int(bridge.news.last.values["before.pushes"])
        assert running.top.simulation.segment.motion.pushes.number == given > 0
        events = partial(tab.evaluate, "window.symtop.run().events")
        until(lambda: events()[-1]["act"]["number"] == given, look)
        assert (events()[-1]["kind"], events()[-1]["act"]["rate"]) == ("push", 20)
        until(lambda: f"sideways {given} times" in tab.text_content("#headline"), look)
        assert bridge.news.last.verdict.startswith(f"Pushed sideways {given} times in ")
        tab.close()


HOLDS = {"torque": ["torque", "torque"], "grasp": ["clamp", "unclamp"]}


@pytest.mark.realtime  # the node lets go a torque of which it has not heard for some time
@pytest.mark.parametrize("hold", HOLDS)
def test_a_hold_on_a_page_that_draws_slowly_is_one_act_of_the_node(node, browser, hold):
    """Frames of 350 ms: the page cannot repeat a torque before the node lets it go."""
    _, bridge = node
    with serving(write_file(node=bridge.name), bridge) as server:
        tab = browser.new_page()
        tab.add_init_script(UNDRAWN + slow_frames(350))
        tab.goto(server.url)
        look = partial(tab.wait_for_timeout, 20)
        tab.click("#tab-push")
        button = tab.locator(f"[data-hold={hold}]").first
        kinds = (
            "window.symtop.run().events.map(({kind}) => kind).filter((each) => each !== 'start')"
        )
        with measuring() as machine:
            button.dispatch_event("pointerdown")
            until(lambda: tab.evaluate(kinds), look)
            tab.wait_for_timeout(2500)  # the hand is held in real time, longer than the time-out
            held = tab.evaluate(kinds)
            button.dispatch_event("pointerup")
            until(lambda: len(tab.evaluate(kinds)) > 1, look)
        whole = tab.evaluate(kinds)
        tab.close()
    if held != HOLDS[hold][:1]:  # the node has not heard of the torque for 1 s
        machine.demand(0.2)
    assert held == HOLDS[hold][:1]
    assert whole == HOLDS[hold]
