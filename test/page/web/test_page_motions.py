"""Acts on the page: starts, kicks, torques and pushes are those of Python."""

import json

import numpy as np
import pytest
from page.web.opened import find_time, read_motion, read_state
from run.simulation.page_runs import to_json

from symtop_ros.physics import ExactTimes, Motion, Pushes, Top, apply_impulse
from symtop_ros.run.simulation.changes.outcomes import Pushed
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.presets import scene_names
from symtop_ros.run.simulation.run_file import RunEvent, read_run, write_run
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.words import write

SAID = {
    (False, False): "The ",
    (True, False): "Friction acts. Without it, the ",
    (False, True): "A torque acts. Without it, the ",
    (True, True): "Friction and a torque act. Without them, the ",
}


@pytest.mark.slow
def test_every_scene_starts_with_the_doubles_of_a_node_and_says_what_acts(opened):
    said = set()
    for name in scene_names():
        opened.start_scene(name)
        assert opened.say("refusal") == ""
        event = opened.read_events()[-1]
        motion = start_motion(Settings.from_scene(name))
        assert event["orientation"] == motion.start.given_orientation.tolist()
        assert event["angular_velocity"] == motion.start.angular_velocity.tolist()
        assert event["top"] == list(motion.top.moments)
        assert event["friction"] == [motion.friction.axial, motion.friction.transverse]
        assert event["torque"] == list(motion.applied_torque)
        said.add(acts := (any(event["friction"]), any(event["torque"])))
        assert event.get("clamped", False) == motion.clamped
        expected = "Clamped, the " if motion.clamped else SAID[acts]
        assert opened.say("headline").startswith(expected)
        assert not any(acts) or opened.say("why").startswith("What follows neglects ")
    assert said >= {(True, False), (False, True)}


@pytest.mark.slow
def test_somebody_goes_on_from_an_earlier_moment(opened):
    opened.wait_for_time(0.03)
    opened.tab.click("#hurry")
    first, kick = opened.read_events()
    opened.wait_for_time(kick["time"] + 0.02)
    opened.seek(kick["time"] / 2)
    assert opened.say("headline").startswith("The top precesses steadily")
    opened.tab.click("text=Delay")
    events = opened.read_events()
    assert events[0] == first
    assert len(events) == 2
    assert events[1]["time"] == pytest.approx(kick["time"] / 2, rel=1e-12)


@pytest.mark.slow
def test_the_series_are_those_of_the_motion(opened, tmp_path):
    opened.wait_for_time(0.03)
    opened.tab.click("text=Pause")
    event = opened.read_events()[0]
    head, *rows = opened.save("Series (CSV)", tmp_path).read_text().splitlines()
    angles, rates = "phi (rad),theta (rad),psi (rad)", "phi_dot (rad/s),theta_dot (rad/s)"
    assert head == f"time (s),{angles},{rates},psi_dot (rad/s)"
    table = np.array([row.split(",") for row in rows], float)
    stamps = np.rint(table[:, 0] * 1e9).astype(np.int64)
    states = read_motion(event).at(ExactTimes(stamps))
    assert table[:, 1:4].T.tolist() == np.array(states.euler_angles).tolist()
    assert table[:, 4] == pytest.approx(states.euler_rates.phi_dot, rel=1e-14)
    assert table[:, 6] == pytest.approx(states.euler_rates.psi_dot, rel=1e-14)


def test_a_torque_acts_and_is_said_while_its_button_is_held(opened):
    opened.open_tab("push")
    button = opened.tab.locator("[data-sign='1']")
    button.dispatch_event("pointerdown")
    opened.until(lambda: opened.say("headline").startswith("A torque acts. Without it, the top "))
    button.dispatch_event("pointerup")
    opened.until(lambda: opened.say("headline").startswith("The torque has ended: the top "))
    torques = [each["torque"] for each in opened.read_events() if each["kind"] == "torque"]
    # a page that is held up for long lets go
    assert torques == [[0, 0, pytest.approx(0.0075 * 0.068)], [0, 0, 0]] * (len(torques) // 2)


@pytest.mark.slow
def test_an_event_keeps_its_nanosecond_and_what_was_asked(opened, tmp_path):
    opened.wait_for_time(0.01)
    opened.tab.click("#hurry")
    opened.open_tab("push")
    for way in ("up", "along"):
        opened.tab.click(f"[data-push={way}]")
    _, kick, up, along = events = opened.read_events()
    saved = opened.save("This run (JSON)", tmp_path).read_text()
    assert json.loads(saved)["events"] == events
    for event in (kick, up, along):
        assert round(event["time"] * 1e9) / 1e9 == event["time"]
    assert kick["act"] == {"precession_rate_factor": 1.4, "hold": "spin_momentum"}
    assert along["act"] == {"precession_rate_change": 1, "hold": "spin_momentum"}
    before = read_motion(kick).at(find_time(kick, up))
    after = apply_impulse(Top(*up["top"]), before, up["act"]["angular_impulse"])
    assert up["angular_velocity"] == after.angular_velocity.tolist()
    assert after.euler_rates.theta_dot - before.euler_rates.theta_dot == pytest.approx(
        -1.0, rel=1e-12
    )


SECOND = 1_000_000_000
ACT = {"axle_impulse": 2.0**-14, "rate": 20.0, "number": 20.0}  # N m s, per s


def read_pushed(event):
    """The pushed motion of an event of a run."""
    act = event["act"]
    pushes = Pushes(act["axle_impulse"], act["rate"], act["number"])
    return Motion(Top(*event["top"]), read_state(event), pushes=pushes)


@pytest.mark.slow
def test_a_held_button_pushes_as_python_does_to_the_last_bit_and_letter(opened):
    opened.wait_for_time(0.02)
    opened.open_tab("push")
    button = opened.tab.locator("[data-hold=press]")
    button.dispatch_event("pointerdown")
    opened.until(lambda: opened.read_events()[-1].get("act", {}).get("number", 0) > 2)
    button.dispatch_event("pointerup")
    event = opened.read_events()[-1]
    assert event["kind"] == "push"
    given = (event["time"], event["act"]["number"])
    opened.wait_for_time(given[0] + given[1] / 20 + 0.1)  # nothing is pushed any more
    opened.tab.click("#hurry")
    *_, former, event, after = opened.read_events()  # one that is held up for long lets go
    assert (event["time"], event["act"]["number"]) == given
    begun = read_pushed(former) if former["kind"] == "push" else read_motion(former)
    motion = read_pushed(event)
    before = begun.at(find_time(former, event))
    opened.seek(after["time"] - 0.02)
    assert opened.say("why") == write("push", Pushed.of(motion, motion.pushes, before))
    reached = motion.at(find_time(event, after))
    assert after["orientation"] == reached.given_orientation.tolist()


def test_what_is_done_during_the_pushes_of_a_run_ends_them(open_page, tmp_path):
    opened = open_page()
    start = read_motion(opened.read_events()[0])
    before = start.at(ExactTimes(SECOND))
    pushed = Motion(start.top, before, pushes=Pushes(2.0**-14, 20.0, 20))
    run = [RunEvent("start", 0, start, {}), RunEvent("push", SECOND, pushed, ACT)]
    opened.drop(write_run(run, 3 * SECOND))
    opened.until(lambda: len(opened.read_events()) == 2)
    assert opened.read_run() == json.loads(json.dumps(write_run(run, 3 * SECOND)))
    opened.wait_for_time(2.9)
    opened.seek(1.33)
    opened.tab.click("text=Delay")
    path = tmp_path / "run.json"
    path.write_text(json.dumps(opened.read_run()))
    events, *_ = read_run(path)
    assert [each.kind for each in events] == ["start", "push", "kick"]
    assert events[1].act["number"] == 7
    assert to_json(events[:1]) == to_json(run[:1])
    reached = pushed.at(ExactTimes(330_000_000))
    assert np.array_equal(events[2].motion.start.orientation, reached.orientation)


@pytest.mark.parametrize(("number", "words"), [(1, "once:"), (2, "2 times in 0.05 s:")])
def test_pushes_are_counted_in_words(opened, number, words):
    start = read_motion(opened.read_events()[0])
    pushed = Motion(start.top, start.start, pushes=Pushes(2.0**-14, 20.0, number))
    act = {**ACT, "number": float(number)}
    run = [RunEvent("start", 0, start, {}), RunEvent("push", 0, pushed, act)]
    opened.drop(write_run(run, SECOND // 2))
    opened.until(lambda: opened.say("why").startswith(f"Pushed sideways {words}"))
    assert opened.say("why") == write("push", Pushed.of(pushed, pushed.pushes, start.start))


@pytest.mark.slow
def test_an_act_while_a_button_pushes_ends_the_pushes(opened):
    opened.open_tab("push")
    button = opened.tab.locator("[data-hold=press]")
    button.dispatch_event("pointerdown")
    opened.until(lambda: opened.read_events()[-1]["kind"] == "push")
    opened.press("h")
    kinds = ["start", "push", "kick"]
    opened.until(lambda: [event["kind"] for event in opened.read_events()] == kinds)
    opened.wait_for_time(opened.read_events()[-1]["time"] + 0.02)
    button.dispatch_event("pointerup")
    assert [event["kind"] for event in opened.read_events()] == kinds


# What the page calls a push: the main button, the two keys, and those of the tab.
PUSHES = {
    "the button": lambda page: page.tab.click("#hurry"),
    "key h": lambda page: page.press("h"),
    "key d": lambda page: page.press("d"),
    "along": lambda page: page.tab.click("[data-push=along]"),
    "back": lambda page: page.tab.click("[data-push=back]"),
}


@pytest.mark.slow
@pytest.mark.parametrize("scene", ["theta=0.5&psi_dot=200&precession=slow", "scene=perry_fails"])
def test_a_push_has_no_torque_about_the_axle_and_the_article_s_comparison_has(opened, scene):
    opened.follow(scene)
    opened.open_tab("push")
    for name, push in PUSHES.items():
        push(opened)
        before, after = opened.read_events()[-2:]
        # omega_z, and so p_psi = Iz omega_z, is the same double
        assert after["angular_velocity"][2] == before["angular_velocity"][2], name
    for act in ("hurry_held", "delay_held"):
        opened.tab.click(f"[data-act={act}]")
        before, after = opened.read_events()[-2:]
        assert after["angular_velocity"][2] != before["angular_velocity"][2]
        # psi' is a difference of rates of this size, each known to some EPS
        size = max(map(abs, after["angular_velocity"]))
        start = read_motion(before).at(find_time(before, after))
        assert opened.read_last().euler_rates.psi_dot == pytest.approx(
            start.euler_rates.psi_dot, abs=1e-14 * size
        )


@pytest.mark.slow
@pytest.mark.wording
def test_the_sizes_at_push_and_twist_are_those_of_the_change_of_angular_momentum(opened):
    opened.tab.click("#pause")
    opened.follow("theta=0.5&psi_dot=200&precession=slow")
    opened.open_tab("push")
    opened.tab.click("[data-act=hurry_held]")
    opened.wait_for_frames(3)
    said = [label.text_content() for label in opened.tab.locator(".label:visible").all()]
    first, kick = opened.read_events()[-2:]
    before, after = read_motion(first).at(find_time(first, kick)), read_state(kick)
    top = Top(*kick["top"])
    change = top.angular_momentum(after) - top.angular_momentum(before)
    axle = after.to_world(np.array([0.0, 0.0, 1.0]))
    along = float(change @ axle)
    across = float(np.linalg.norm(change - along * axle))
    for name, size in (("push", across), ("twist", abs(along))):
        (number,) = [text.split()[1] for text in said if text.startswith(f"{name} ")]
        assert number == f"{size:.2g}", (name, said)
        assert f"{name} {number} N m s" in said
