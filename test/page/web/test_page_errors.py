"""The page keeps working: in a frame, without WebGL, after errors, refused acts and random ones."""

import numpy as np
import pytest
from page.web import random_acts
from page.web.opened import FEW_FRAMES, UNDRAWN, USUAL, Opened
from trials import trials

from symtop_ros.physics import Motion, State, Top


def test_frames_with_old_stamps_do_not_run_the_time_backwards(open_page):
    opened = open_page(script="patches.ageStamps();" + UNDRAWN)
    opened.tab.click("#hurry")
    opened.wait_for_time(0.01)
    start, kick = opened.read_events()
    assert (start["kind"], start["time"], kick["kind"]) == ("start", 0, "kick")
    assert kick["time"] >= 0


@pytest.mark.slow
def test_an_error_in_a_part_is_shown_once_and_costs_only_this_part(open_page):
    broken = "WebGL2RenderingContext.prototype.drawArrays = () => { throw new Error('no card'); };"
    opened = open_page(script=FEW_FRAMES + broken)
    opened.until(lambda: opened.say("refusal"))
    failed = "scene: this failed because of a bug in the page: no card"
    assert opened.say("refusal").startswith(failed)
    opened.press("h")
    opened.wait_for_time(0.05)
    assert opened.say("refusal") == ""
    assert "higher" in opened.say("headline")
    assert [each.splitlines()[0] for each in opened.problems] == ["Error: no card"]
    opened.problems.clear()


def test_a_stored_choice_of_another_version_is_dropped(open_page):
    store = "localStorage.setItem"
    stored = f"{store}('symtop.free-x', 'speed'); {store}('symtop.unit', '');"
    opened = open_page(script=stored + USUAL)
    assert opened.tab.input_value("#free-x") == "theta"
    assert opened.tab.input_value("#unit") == "deg"
    opened.wait_for_time(0.02)


@pytest.mark.slow
def test_a_spin_beyond_what_can_be_computed_waits_and_says_so(opened):
    for rate in ("1e20", "-1e99"):
        opened.enter("psi_dot", rate)
        opened.until(lambda: opened.say("refusal"))
        assert opened.say("refusal") == "times must be within 1e15 turns of the start"
        assert opened.say("pause") == "Run"
        opened.enter("psi_dot", "200")
        opened.press("Space")
        opened.wait_for_time(opened.read_events()[-1]["time"] + 0.01)
        assert opened.say("refusal") == ""


@pytest.mark.slow
@pytest.mark.parametrize("count", trials(4, 3000))
def test_no_act_stops_the_page_and_python_reads_its_run(browser, count):
    acts = random_acts.run(browser, 49, count)
    print(f"{acts.total()} acts: {dict(acts)}")
    assert acts.total() == count


@pytest.mark.slow
def test_a_frame_of_another_site_shows_the_top_and_says_that_it_may_not_save(browser, path):
    tab = browser.new_context(offline=True).new_page()
    tab.add_init_script(USUAL)
    tab.set_content("<iframe sandbox='allow-scripts' style='width: 900px; height: 700px'></iframe>")
    tab.evaluate("(page) => { document.querySelector('iframe').srcdoc = page; }", path.read_text())
    frame = tab.frame_locator("iframe")
    frame.locator("[data-answer=rises]").click()
    frame.locator("#compared").wait_for()
    assert "higher" in frame.locator("#headline").text_content()
    frame.locator("#tab-save").click()
    frame.locator("#save-run").click()
    said = frame.locator("#refusal").text_content()
    assert said.startswith("a frame must allow downloads: if no run.json was saved, open the page")
    tab.context.close()


@pytest.mark.slow
def test_a_page_that_does_not_start_is_a_failure_that_says_why_and_not_a_wait(browser, path):
    opened = Opened(browser, "WebAssembly.instantiate = () => { throw new Error('forbidden'); };")
    with pytest.raises(AssertionError, match=r"the page does not start: .*forbidden"):
        opened.open(path)
    opened.context.close()


def test_scripts_find_the_motions_of_python(opened):
    top = {"Ix": 0.000228, "Iz": 0.0000572, "Mgl": 0.068}
    angular_velocity = [1.0, 2.0, 200.0]
    start = {**top, "orientation": [0.8, 0.6, 0, 0], "angular_velocity": angular_velocity}
    found = opened.tab.evaluate(
        """(start) => {
            const motion = window.symtop.motion(start);
            return [motion.at(3.7), motion.kind, motion.turning_angles, motion.nutation_period];
        }""",
        start,
    )
    motion = Motion(Top(**top), State(start["orientation"], angular_velocity))
    state = np.concatenate(motion.at(3.7)._parts).tolist()
    assert found == [state, motion.kind, list(motion.turning_angles), motion.nutation_period]
