"""Runs that the page is given: read as Python wrote them, or refused; its own run is kept."""

import json
from functools import partial

import pytest
from drawn import Numbers
from page.web.opened import USUAL
from run.session.test_random_sessions import move
from run.simulation.page_runs import change, find_refusal, list_hostile_runs
from trials import choose, seeds

from symtop_ros.page.web.join import write_file
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.run_file import record_run, write_run

PUSHES = {"axle_impulse": 1e-5, "rate": 20, "number": 20}
HOSTILE = [content for _, content in list_hostile_runs()]
BROKEN = [
    change(0, kind="kick"),
    change(1, time=-1.0),
    change(2, time=1.0),
    change(1, kind="push", act={"axle_impulse": 1e-5, "rate": 20, "hold": "spin_rate"}),
    change(1, kind="push", act={**PUSHES, "number": 2.5}),
    change(1, kind="push", act={**PUSHES, "rate": 1001}),
    {"format": 1, "events": [3]},
    {"format": 1, "events": []},
    {"format": 1, "events": "__proto__"},
    {**change(1), "end": "soon"},
    change(1, mass=1e-9),
    change(1, gravity=0),
    {**change(1), "events": change(1)["events"][:1] * 10_001},
]
LATE = 1500.0  # s; after 956 s one state would take 100 000 steps
LINK = "#theta=0.7&psi_dot=180"
NO_RUN = [[], None, 3, "", {}, {"format": 6, "events": []}, {"__proto__": 1}]
UNREADABLE = (change(1, kind="__proto__"), change(1, act=None), {"events": 1})
# The kernel and Python have other words for these.
NO_MOTION = [change(1, orientation=[number] * 4) for number in (0, 1)]
NO_MOTION += [change(1, top=[1, 3, 1]), change(1, top=[0, 0, 0]), change(1, friction=[-1, 0])]


def get_condition(refusal):
    return refusal.split(", got ")[0]


def refuse(opened, runs):
    """Drop runs, and return their refusals; the present run stays, and a key is answered."""
    answers = opened.tab.evaluate("acts.refuse", [json.dumps(run) for run in runs])
    assert {(is_same, added) for _, is_same, added in answers} == {(True, 1)}
    return [refusal for refusal, *_ in answers]


# Of the hostile runs every fifth in each run of the tests: some of each field.
@pytest.mark.slow
@pytest.mark.parametrize("step", [5, pytest.param(1, marks=pytest.mark.long)])
def test_hostile_runs_are_refused_as_by_python_and_the_present_run_stays(opened, step):
    known = [*HOSTILE[::step], *BROKEN]
    refusals = map(get_condition, refuse(opened, known))
    assert [*refusals] == [get_condition(find_refusal(run)) for run in known]
    expected = "a run must be one of the page (run.json, format 1 or 2 or 3 or 4 or 5)"
    assert {*map(get_condition, refuse(opened, NO_RUN))} == {expected}
    for refusal, run in zip(refuse(opened, NO_MOTION), NO_MOTION, strict=True):
        assert refusal.startswith("events[1]: ")
        assert find_refusal(run).startswith("events[1]: ")


@pytest.mark.long
def test_a_run_of_most_events_is_reloaded_and_takes_no_more(opened):
    most = 10_000
    opened.drop({**change(1), "events": change(1)["events"][:1] * most})
    opened.until(lambda: len(opened.read_events()) == most)
    opened.press("h")
    assert f"at most {most} events" in opened.say("refusal")
    assert len(opened.read_events()) == most
    opened.reload()
    assert len(opened.read_events()) == most
    assert opened.say("refusal") == ""


def test_a_reset_after_a_run_was_opened_keeps_the_top_that_was_changed(opened):
    content = change(2, top=[0.000228, 0.0000572, 0.05], friction=[0, 0], torque=[0, 0, 0])
    opened.drop(content)
    opened.until(lambda: len(opened.read_events()) == 3)
    opened.press("r")
    event = opened.read_events()[-1]
    assert event["kind"] == "start"
    assert event["top"] == content["events"][2]["top"]
    assert event["orientation"] == content["events"][0]["orientation"]


NO_ROOM = """
const fail = () => { throw new DOMException("full", "QuotaExceededError"); };
Storage.prototype.setItem = fail;
"""
FORBID = "() => { history.replaceState = () => { throw new DOMException('', 'SecurityError'); }; }"


@pytest.mark.slow
def test_a_browser_without_room_is_said_once(open_page):
    opened = open_page(script=NO_ROOM + USUAL)
    opened.open_tab("view")
    for theme in ("dark", "light"):
        opened.tab.select_option("#theme", theme)
        opened.wait_for_frames()
        expected = "the storage of the browser is full" if theme == "dark" else ""
        assert opened.say("refusal").startswith(expected)
        opened.press("Escape")
        assert opened.say("refusal") == ""
    opened.tab.evaluate(FORBID)
    opened.press("h")
    assert opened.say("refusal") == ""


def test_a_refusal_of_the_kept_run_stays_where_the_address_starts_another(open_page):
    remembered = f"history.replaceState({{run: {json.dumps(UNREADABLE[0])}}}, '');"
    opened = open_page(LINK, script=remembered + USUAL)
    assert " must " in opened.say("refusal")


@pytest.mark.slow
@pytest.mark.parametrize("number", seeds(1, len(UNREADABLE)))
def test_a_run_that_cannot_be_read_ends_no_page_that_has_it(open_page, tmp_path, number):
    run = UNREADABLE[number]
    remembered = f"history.replaceState({{run: {json.dumps(run)}}}, '');"
    saved = tmp_path / "saved.html"
    saved.write_text(write_file(run=run))
    for opened in (open_page(script=remembered + USUAL), open_page(file=saved)):
        assert " must " in opened.say("refusal")
        opened.press("h")
        assert [event["kind"] for event in opened.read_events()] == ["start", "kick"]
        assert opened.say("refusal") == ""
    opened.reload()
    assert [event["kind"] for event in opened.read_events()] == ["start", "kick"]


def list_late_events(time):
    """A torque, and another event so late that its motion takes many steps."""
    driven = change(2, torque=[0, 0, 1e-4])
    return {**driven, "events": [*driven["events"], {**driven["events"][2], "time": time}]}


@pytest.mark.long
def test_a_run_that_takes_too_long_to_integrate_is_refused_or_reached_later(opened):
    driven = change(2, torque=[0, 0, 1e-4])
    driven["end"] = 4e6
    opened.drop(driven)
    opened.until(lambda: len(opened.read_events()) == 3)
    assert driven["events"][2]["time"] < opened.read_run()["end"] < 4e6
    refused = "a run must take at most 500000 steps, got to event 3"
    assert refuse(opened, [list_late_events(4e6)]) == [refused]


@pytest.mark.long
def test_a_run_of_more_steps_than_one_state_may_take_is_opened(opened):
    """A page in which a motion has run for long has it, frame by frame."""
    late = list_late_events(LATE)
    opened.drop(late)
    opened.until(lambda: len(opened.read_events()) == 4)
    opened.reload()
    assert len(opened.read_events()) == 4


def has_read(opened, content):
    run = opened.read_run()
    return run["events"] == content["events"] and run["end"] >= content["end"]


@pytest.mark.slow
@pytest.mark.parametrize("first", seeds(1, 25))
def test_the_page_reads_the_runs_of_sessions_as_python_wrote_them(opened, tmp_path, first):
    for seed in range(12 * first, 12 * (first + 1)):
        folder = tmp_path / str(seed)
        folder.mkdir()
        path, stamp = move(Numbers(seed), folder)
        content = write_run(*record_run(TopLog(open_run([path])).catalog.events, stamp))
        content = json.loads(json.dumps(content))
        opened.drop(content)
        opened.until(partial(has_read, opened, content))


@pytest.mark.slow
@pytest.mark.parametrize("fragment", choose(("", LINK), (LINK,)))
def test_a_reload_loses_nothing(open_page, fragment):
    page = open_page(fragment)
    page.wait_for_time(0.02)
    page.tab.click("#hurry")
    page.tab.select_option("#speed", label="1/20 of real time")
    page.wait_for_time(0.04)
    page.tab.click("#pause")
    run = page.read_run()
    headline = page.say("headline")
    page.reload()
    assert page.read_run() == run
    assert page.say("headline") == headline
    assert page.say("pause") == "Run"
    assert page.tab.input_value("#speed") == "0.05"
    page.tab.click("#pause")
    page.wait_for_time(run["end"])
    page.reload()
    assert page.say("pause") == "Pause"  # what ran runs on
    assert page.read_events() == run["events"]


@pytest.mark.slow
def test_a_sleep_of_the_computer_loses_nothing(open_page):
    page = open_page()
    page.tab.click("#hurry")
    events = page.read_events()
    before, after = page.tab.evaluate("acts.sleep")
    assert page.read_events() == events
    assert before < after < before + 0.05  # s: in each frame at most a tenth of 0.1 s
    page.wait_for_time(after)


# Ten minutes by the clocks of the page.
HIDE = """async () => {
  const before = window.symtop.run().end;
  window.asleep(600_000);
  await window.acts.waitForFrames(3);
  return [before, window.symtop.run().end];
}"""


def test_in_a_tab_that_is_hidden_the_motion_waits_and_a_hand_lets_go(open_page):
    page = open_page(script=USUAL + "patches.letSleep();")
    page.tab.click("#hurry")
    page.open_tab("push")
    page.tab.dispatch_event("[data-hold=grasp]", "pointerdown")
    page.until(lambda: page.read_events()[-1]["kind"] == "clamp")
    events = page.read_events()
    before, after = page.tab.evaluate(HIDE)
    *held, let_go = page.read_events()
    assert held == events
    assert let_go["kind"] == "unclamp"
    assert let_go["time"] == before  # when it was hidden
    assert before < after < before + 0.05  # s: in each frame at most a tenth of 0.1 s
    page.wait_for_time(after)
