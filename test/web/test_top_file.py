"""The page as one file: opened from a disk without a network, saved and opened again."""

import numpy as np
import pytest
from web.opened import USUAL

from symtop_ros.physics import Motion, State, Top


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


@pytest.mark.parametrize(
    ("missing", "said"),
    [
        ("HTMLCanvasElement.prototype.getContext = () => null", "has no WebGL 2"),
        ("WebAssembly.instantiate = () => Promise.reject(new Error('forbidden'))", "forbidden"),
    ],
)
def test_a_browser_that_cannot_show_it_says_so(browser, path, missing, said):
    tab = browser.new_context(offline=True).new_page()
    tab.add_init_script(missing)
    tab.goto(path.as_uri())
    tab.wait_for_selector("#refusal:not([hidden])")
    assert said in tab.text_content("#refusal")
    tab.context.close()


def test_scripts_find_the_motions_of_python(opened):
    top, angular_velocity = {"Ix": 0.000228, "Iz": 0.0000572, "Mgl": 0.068}, [1.0, 2.0, 200.0]
    start = {**top, "orientation": [0.8, 0.6, 0, 0], "angular_velocity": angular_velocity}
    found = opened.tab.evaluate(
        """(start) => {
            const motion = window.symtop.motion(start);
            return [motion.at(3.7), motion.kind, motion.turning_angles, motion.nutation_period];
        }""",
        start,
    )
    motion = Motion(Top(**top), State(start["orientation"], angular_velocity))
    state = np.concatenate(motion.at(3.7).parts).tolist()
    assert found == [state, motion.kind, list(motion.turning_angles), motion.nutation_period]
