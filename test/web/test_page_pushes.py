"""Pushes on the axle while a button is held: one event, with as many as were given."""

import json

import numpy as np
from simulation.page_runs import to_json
from web.opened import find_time, read_motion, read_state

from symtop_ros.physics import ExactTimes, Top
from symtop_ros.simulation.changes.outcomes import Pushed
from symtop_ros.simulation.run_file import RunEvent, read_run, write_run
from symtop_ros.simulation.segment import PushedMotion, Pushes
from symtop_ros.wording import write

SECOND = 1_000_000_000
ACT = {"axle_impulse": 2.0**-14, "rate": 20.0, "number": 20.0}  # N m s, per s


def read_pushed(event):
    """The pushed motion of an event of a run."""
    act = event["act"]
    pushes = Pushes(act["axle_impulse"], act["rate"], act["number"])
    return PushedMotion(Top(*event["top"]), read_state(event), pushes)


def test_a_held_button_pushes_as_python_does_to_the_last_bit_and_letter(opened):
    opened.wait_for_time(0.02)
    opened.open_tab("push")
    button = opened.tab.locator("[data-hold=press]")
    button.dispatch_event("pointerdown")
    opened.until(lambda: opened.read_events()[-1].get("act", {}).get("number", 0) > 2)
    button.dispatch_event("pointerup")
    start, event = opened.read_events()
    assert event["kind"] == "push"
    given = (event["time"], event["act"]["number"])
    opened.wait_for_time(given[0] + given[1] / 20 + 0.1)  # nothing is pushed any more
    opened.tab.click("#hurry")
    start, event, after = opened.read_events()
    assert (event["time"], event["act"]["number"]) == given
    motion, before = read_pushed(event), read_motion(start).at(find_time(start, event))
    opened.seek(after["time"] - 0.02)
    assert opened.say("why") == write("push", Pushed.of(motion, before))
    reached = motion.at(find_time(event, after))
    assert after["orientation"] == reached.given_orientation.tolist()


def test_what_is_done_during_the_pushes_of_a_run_ends_them(open_page, tmp_path):
    opened = open_page()
    start = read_motion(opened.read_events()[0])
    before = start.at(ExactTimes(SECOND))
    pushed = PushedMotion(start.top, before, Pushes(2.0**-14, 20.0, 20))
    run = [RunEvent("start", 0, start, {}), RunEvent("push", SECOND, pushed, ACT)]
    opened.drop(write_run(run, 3 * SECOND))
    opened.until(lambda: len(opened.read_events()) == 2)
    assert opened.read_run() == json.loads(json.dumps(write_run(run, 3 * SECOND)))
    opened.wait_for_time(2.9)
    opened.seek(1.33)
    opened.tab.click("text=Delay")
    path = tmp_path / "run.json"
    path.write_text(json.dumps(opened.read_run()))
    events, _ = read_run(path)
    assert [each.kind for each in events] == ["start", "push", "kick"]
    assert events[1].act["number"] == 7
    assert to_json(events[:1]) == to_json(run[:1])
    reached = pushed.at(ExactTimes(330_000_000))
    assert np.array_equal(events[2].motion.start.orientation, reached.orientation)
