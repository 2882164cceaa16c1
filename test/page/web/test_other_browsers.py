"""The page in Firefox and WebKit: the bits of Python's kernel, and one pass through the page."""

import base64
import contextlib
import io
import time

import numpy as np
import pytest
from films import draw_balls, write_film
from other_browsers import running_firefox, running_webkit, stumbling, until
from page.web.opened import find_time, read_motion
from page.web.page_words import write_as_page
from physics.kernel.motions import NAMES, encode, expect, list_samples, normalize
from physics.kernel.test_wasm import KERNEL, SCRIPT
from PIL import Image

from symtop_ros.physics import Motion, Top, hurry, kick_verdict
from workshop.kernel_wasm import MODULE
from workshop.lesson.steps import read_lesson

pytestmark = pytest.mark.long

FONT, SIZE = 40, 100  # px
# A symbol of the page, large and alone in the upper left corner.
SHOW = f"""
const symbol = document.querySelector(given[0]);
symbol.style.fontSize = "{FONT}px";
const box = document.createElement("div");
Object.assign(box.style, {{ position: "fixed", left: 0, top: 0, width: "{SIZE}px", zIndex: 9,
  height: "{SIZE}px", background: "white", color: "black", padding: "20px" }});
box.append(symbol);
document.body.append(box);
"""
# Widths of letters in the font of formulas, and in another one.
LETTERS = """
const letters = document.createElement("span");
letters.textContent = "\U0001d703\U0001d711\U0001d713";
letters.style.position = "fixed";
document.body.append(letters);
const widths = ["symbols, monospace", "monospace"].map((family) => {
  letters.style.fontFamily = family;
  return letters.getBoundingClientRect().width;
});
letters.remove();
return widths;
"""
BROWSERS = {"firefox": running_firefox, "webkit": running_webkit}


@pytest.fixture(scope="module", params=[*BROWSERS])
def driver(request):
    with BROWSERS[request.param]() as running:
        yield running


def to_text(data):
    return base64.b64encode(data).decode()


def test_two_thousand_motions_have_the_bits_of_python(driver, tmp_path):
    page = tmp_path / "kernel.html"
    page.write_text(
        f"<!doctype html><title>kernel</title><script type='module'>{KERNEL}\n"
        f"</script><script>{SCRIPT}\nwindow.print_motions = print_motions;"
        "window.decode = decode;</script>"
    )
    driver.open(page.as_uri())
    until(driver, "window.binding")
    samples = list_samples(range(210), range(34))
    found = driver.run(
        """const [names, module, samples] = given;
        return await print_motions(binding, names, module, samples);""",
        NAMES,
        to_text(MODULE.read_bytes()),
        to_text(encode(samples)),
    )
    assert normalize(np.frombuffer(base64.b64decode(found))) == expect(samples)


def list_gaps(picture):
    """Return the heights of the blank rows between parts of a symbol, from its highest part on."""
    rows = np.asarray(Image.open(io.BytesIO(picture)).convert("L"))[:SIZE, :SIZE].min(axis=1) < 128
    inked = np.flatnonzero(rows)
    return (np.diff(inked)[np.diff(inked) > 1] - 1).tolist()


@pytest.mark.parametrize("field", ["phi_dot", "psi_dot"])
def test_the_dot_of_a_rate_stands_close_to_its_letter(driver, path, field):
    driver.open(path.as_uri())
    until(driver, "document.querySelector('#headline')?.textContent")
    driver.run(SHOW, f"label[for=field-{field}] math")
    gaps = list_gaps(driver.take_picture())
    assert len(gaps) == 1  # the dot is seen
    assert gaps[0] <= 0.15 * FONT


def test_a_top_is_hurried_and_the_run_survives_a_reload(driver, path):
    driver.open(path.as_uri() + "#theta=0.5&psi_dot=200&precession=slow")
    until(driver, "document.querySelector('#headline')?.textContent")
    until(driver, "Number(document.querySelector('#timeline').max) > 0.01")
    why = driver.run(
        """document.querySelector("#hurry").click();
        return document.querySelector("#why").dataset.text;"""
    )
    run = driver.run("return window.symtop.run();")
    *_, start, kick = run["events"]
    before = read_motion(start).at(find_time(start, kick))
    after = hurry(before, 1.4, "spin_momentum")
    assert kick["orientation"] == after.given_orientation.tolist()
    assert kick["angular_velocity"] == after.angular_velocity.tolist()
    verdict = kick_verdict(Motion(Top(*kick["top"]), after), before, "spin_momentum")
    assert why == write_as_page("kick", verdict, "degrees")  # the page's unit at first
    picture = driver.run("return document.querySelector('#picture').toDataURL().length;")
    assert picture > 5000
    assert driver.run("return document.querySelectorAll('#charts svg path').length;") > 20
    driver.reload()
    until(driver, "document.querySelector('#headline')?.textContent")
    assert driver.run("return window.symtop.run();")["events"] == run["events"]
    assert driver.run("return document.querySelector('#refusal').textContent;") == ""


# A hand holds a button for eight frames, each of 350 ms or more.
HOLD = """
const [hold] = given;
const draw = window.requestAnimationFrame.bind(window);
window.requestAnimationFrame = (each) => draw((now) => {
  const end = performance.now() + 350;
  while (performance.now() < end);
  each(now);
});
const wait = async (frames) => {
  for (let k = 0; k < frames; k += 1) await new Promise(requestAnimationFrame);
};
const count = window.symtop.run().events.length;
const button = document.querySelector(`[data-hold=${hold}]`);
button.dispatchEvent(new PointerEvent("pointerdown"));
await wait(8);
button.dispatchEvent(new PointerEvent("pointerup"));
await wait(3);
return window.symtop.run().events.slice(count).map(({ kind }) => kind);
"""
HELD = {"press": ["push"], "grasp": ["clamp", "unclamp"], "torque": ["torque", "torque"]}


@pytest.mark.parametrize("hold", HELD)
def test_a_hold_is_one_act_where_frames_are_slow(driver, path, hold):
    driver.open(path.as_uri() + "#theta=0.5&psi_dot=200&precession=slow")
    until(driver, "document.querySelector('#headline')?.textContent")
    assert driver.run(HOLD, hold) == HELD[hold]


# A hand holds a button, or pulls the ball to the right, for some frames; a visitor answers.
PAUSE = """
const wait = async (frames) => {
  for (let k = 0; k < frames; k += 1) await new Promise(requestAnimationFrame);
};
const count = window.symtop.run().events.length;
const list = () => window.symtop.run().events.slice(count);
"""
HOLD_LONG = f"""{PAUSE}
const button = document.querySelector(`[data-hold=${{given[0]}}]`);
button.dispatchEvent(new PointerEvent("pointerdown"));
await wait(20);
button.dispatchEvent(new PointerEvent("pointerup"));
await wait(5);
return list().map(({{ kind }}) => kind);
"""
PULL = f"""{PAUSE}
const canvas = document.querySelector("#picture");
const {{ left, top, width, height }} = canvas.getBoundingClientRect();
canvas.setPointerCapture = () => {{}};
const send = (name, x, y) => canvas.dispatchEvent(new PointerEvent(name,
  {{ pointerId: 1, clientX: left + x, clientY: top + y, bubbles: true, cancelable: true }}));
const pull = async (x, y) => {{
  for (let k = 1; k <= 8; k += 1) {{
    send("pointermove", x + 5 * k, y);
    await wait(1);
  }}
  send("pointerup", x + 40, y);
}};
// The page keeps a press on the ball for itself; another one turns the camera.
let isTaken = false;
for (let y = 10; y < height && !isTaken; y += 20)
  for (let x = 10; x < width && !isTaken; x += 20) {{
    isTaken = !send("pointerdown", x, y);
    if (isTaken) await pull(x, y);
    else send("pointerup", x, y);
  }}
await wait(5);
return list().map(({{ kind, made_by: maker }}) => [kind, maker?.kind]);
"""
ANSWER = """
document.querySelector("[data-answer=rises]").click();
while (document.querySelector("#compared").hidden) await new Promise(requestAnimationFrame);
return [document.querySelector("#compared").textContent,
  window.symtop.run().events.map(({ kind }) => kind)];
"""


@pytest.mark.parametrize("hold", HELD)
def test_a_hold_is_one_act_in_a_browser_that_stumbles(driver, path, hold):
    driver.open(path.as_uri() + "#theta=0.5&psi_dot=200&precession=slow")
    until(driver, "document.querySelector('#headline')?.textContent")
    with stumbling(driver):
        assert driver.run(HOLD_LONG, hold) == HELD[hold]


def test_a_pull_is_one_push_in_a_browser_that_stumbles(driver, path):
    driver.open(path.as_uri() + "#theta=0.5&psi_dot=200&precession=slow")
    until(driver, "document.querySelector('#headline')?.textContent")
    with stumbling(driver):
        assert driver.run(PULL) == [["kick", "pull"]]


def test_the_question_is_answered_once_in_a_browser_that_stumbles(driver, path):
    driver.open(path.as_uri() + "#lang=en")
    until(driver, "document.querySelector('#headline')")
    driver.run("localStorage.clear();")
    driver.open("about:blank")
    driver.open(path.as_uri() + "#lang=en")
    until(driver, "document.body?.dataset.asked === 'ask'")
    with stumbling(driver):
        said, kinds = driver.run(ANSWER)
    assert said == "You were right: it rose."
    assert kinds == ["start", "kick"]


LEFT, ESCAPE, SPACE = "\ue012", "\ue00c", " "  # of WebDriver
FOCUS = """
const [selector] = given;
const [each, first] = [selector, "#pause"].map((one) => document.querySelector(one));
first.click();
each.closest("details")?.setAttribute("open", "");
each.focus();
"""
READ = "return ['value', 'max'].map((name) => Number(document.querySelector(given[0])[name]));"


@pytest.mark.parametrize("slider", ["#timeline", "#free-place"])
def test_an_arrow_key_moves_a_slider_by_a_hundredth(driver, path, slider):
    driver.open("about:blank")
    driver.open(path.as_uri() + "#theta=0.5&psi_dot=200&precession=slow")
    until(driver, "Number(document.querySelector('#timeline')?.max) > 0.1")
    driver.run(FOCUS, slider)
    before, end = driver.run(READ, slider)
    driver.press(LEFT)
    until(driver, f"Number(document.querySelector('{slider}').value) < {before}")
    after, _ = driver.run(READ, slider)
    assert (before - after) / end == pytest.approx(0.01, abs=1e-6)  # a time is one of whole ns


def test_space_holds_a_button_and_escape_closes_its_panel(driver, path):
    open_page(driver, path)
    driver.run("document.querySelector('#tab-push').click();")
    driver.run("document.querySelector('[data-hold=grasp]').focus();")
    driver.press(SPACE)
    kinds = driver.run("return window.symtop.run().events.slice(-2).map(({ kind }) => kind);")
    assert kinds == ["clamp", "unclamp"]
    driver.press(ESCAPE)
    assert driver.run("return document.querySelector('#push').hidden;")


def count_inked(picture, box):
    """Return the part of a place that is not of its ground, in each row and column."""
    left, top, width, height = (round(each) for each in box)
    pixels = np.asarray(Image.open(io.BytesIO(picture)).convert("L")).astype(int)
    place = pixels[top : top + height, left : left + width]
    inked = abs(place - place[0, 0]) > 60
    return inked.mean(axis=1), inked.mean(axis=0)


BOX = """
const { left, top, width, height } = document.querySelector(given[0]).getBoundingClientRect();
return [left, top, width, height];
"""


EDGE = "return getComputedStyle(document.querySelector(given[0])).borderTopColor;"
SLOWEST = 0.12  # s between two loads


def test_letters_of_formulas_are_there_after_loads_in_quick_succession_in_webkit(path):
    with running_webkit() as driver:
        for pause in (0.0, SLOWEST / 4, SLOWEST):
            driver.open(path.as_uri() + "#theta=0.5&psi_dot=200&precession=slow")
            for _ in range(3):
                with contextlib.suppress(AssertionError, OSError):  # the page is left meanwhile
                    driver.run("setTimeout(() => location.reload(), 1);")
                time.sleep(pause)
            until(driver, "document.querySelector('#headline')?.textContent")
            until(driver, "[...document.fonts].every(({ status }) => status === 'loaded')")
            own, other = driver.run(LETTERS)
            assert own != pytest.approx(other, abs=0.5)


def test_forced_colours_leave_sliders_and_formulas_whole_in_firefox(path):
    with running_firefox(**{"browser.display.document_color_use": 2}) as driver:
        open_page(driver, path)
        assert driver.run("return matchMedia('(forced-colors: active)').matches;")
        driver.run("document.querySelector('#pause').click();")
        for name in ("#pause", "#hurry", "#speed", "[data-push]"):
            edge = driver.run(EDGE, name)
            assert edge.startswith("rgb("), name  # one that is not seen is rgba(..., 0)
        driver.run("document.querySelector('#tab-start').click();")
        slider = driver.run(BOX, "[data-field=psi_dot] input[type=range]")
        rows, _ = count_inked(driver.take_picture(), slider)
        assert max(rows) > 0.9  # its track goes from one end to the other
        driver.run(SHOW, "label[for=field-phi_dot] math")
        picture = driver.take_picture()
        assert len(list_gaps(picture)) == 1  # the dot, and the letter below it in one piece


DISC = "#scene=perry_fails&theta=0.5&psi_dot=-25&precession=fast"
PRESS = """
const followed = new Promise((done) => addEventListener("hashchange", done, { once: true }));
location.hash = given.shift();
await followed;
for (const name of given) document.querySelector(`[data-act=${name}]`).click();
return window.symtop.run().events.slice(-2);
"""


def test_the_disc_is_pushed_one_way_and_hurried_at_its_spin_rate_the_other(driver, path):
    ends = {}
    driver.open(path.as_uri())
    until(driver, "document.querySelector('#headline')?.textContent")
    for act in ("hurry", "hurry_held"):
        before, after = driver.run(PRESS, f"{DISC}&psi={len(ends)}", act)
        held = after["angular_velocity"][2] == before["angular_velocity"][2]
        assert held == (act == "hurry")
        ends[act] = read_motion(after).turning_angles
    assert ends["hurry"][1] > 0.79  # a push lowers its axis, from 0.5 rad
    assert ends["hurry_held"][0] < 0.37  # psi' held, it rises


STEPS = """
const found = [];
for (let k = 1; k <= 14; k += 1) {
  const followed = new Promise((done) => addEventListener("hashchange", done, { once: true }));
  location.hash = `#lesson=${k}`;
  await followed;
  for (const button of document.querySelectorAll("#lesson-acts button")) {
    while (button.disabled) await new Promise(requestAnimationFrame);
    button.click();
    found.push(document.querySelector("#refusal").textContent);
  }
}
return found;
"""


def test_each_button_of_the_lesson_does_its_act(driver, path):
    driver.open(path.as_uri())
    until(driver, "document.querySelector('#headline')?.textContent")
    found = driver.run(STEPS)
    assert found == [""] * sum(len(step.acts) for step in read_lesson())


RATE = 30
TIMES = [k / RATE for k in range(40)]
BALLS = [(40 + 5 * k, 60 + 3 * k) for k in range(40)]
# A film is dropped, and frames are asked for: the ball of each is the middle of what is red.
STEP = """
const [data, name, frames] = given;
const wait = async (holds) => {
  for (let k = 0; k < 2400 && !holds(); k += 1) await new Promise((done) => setTimeout(done, 25));
};
const say = (id) => document.getElementById(id).textContent;
const bytes = Uint8Array.from(atob(data), (each) => each.charCodeAt(0));
const dataTransfer = new DataTransfer();
dataTransfer.items.add(new File([bytes], name));
document.dispatchEvent(new DragEvent("drop", { dataTransfer, cancelable: true }));
await wait(() => say("measured-name").includes(name + ":") || say("refusal"));
if (say("refusal")) return say("refusal");
const [line, picture] = ["film-line", "film-picture"].map((id) => document.getElementById(id));
const found = [];
for (const frame of frames) {
  line.value = frame;
  line.dispatchEvent(new Event("input"));
  await wait(() => say("film-clock").startsWith(`frame ${frame + 1} of`));
  const { width, height } = picture;
  const { data: pixels } = picture.getContext("2d").getImageData(0, 0, width, height);
  let [count, x, y] = [0, 0, 0];
  for (let k = 0; k < pixels.length; k += 4)
    if (pixels[k] > 180 && pixels[k + 1] < 130) {
      count += 1;
      x += ((k / 4) % width) + 0.5;
      y += Math.floor(k / 4 / width) + 0.5;
    }
  const scale = Math.min(width / 320, height / 240);
  found.push([
    say("film-clock"),
    160 + (x / count - width / 2) / scale,
    120 + (y / count - height / 2) / scale,
  ]);
}
return [say("measured-name"), found];
"""


def open_page(driver, path):
    driver.open(path.as_uri() + "#theta=0.5&psi_dot=200&precession=slow&lang=en")
    until(driver, "document.querySelector('#headline')?.textContent")


def test_each_frame_of_a_film_is_shown_with_its_time(driver, path, tmp_path):
    film = write_film(tmp_path / "a.webm", draw_balls(BALLS), TIMES)
    open_page(driver, path)
    frames = [0, 1, 2, 3, 20, 39, 38, 11, 12, 0]
    said, found = driver.run(STEP, to_text(film.read_bytes()), film.name, frames)
    assert said.endswith("320 x 240 pixels, 40 frames, 30.00 in a second")
    for frame, (clock, *ball) in zip(frames, found, strict=True):
        assert clock == f"frame {frame + 1} of 40, {TIMES[frame]:.3f} s"  # as WebM has it
        assert ball == pytest.approx(BALLS[frame], abs=0.5)  # px of the film


def test_a_film_that_cannot_be_played_is_refused_in_a_line(driver, path, tmp_path):
    film = write_film(tmp_path / "a.mp4", draw_balls(BALLS), TIMES, "hevc")
    open_page(driver, path)
    answer = driver.run(STEP, to_text(film.read_bytes()), film.name, [0])
    assert (
        answer
        == "this browser cannot play a.mp4: save it as MP4 (H.264) or WebM, and open it again"
    )
