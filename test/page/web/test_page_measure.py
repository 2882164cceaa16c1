"""Measure on the page: a film is dropped and clicked, and its clicks are a table of top_fit."""

import base64
import json
import math
import shlex
import struct

import numpy as np
import pytest
from drawn import Numbers
from films import draw_balls, write_film
from page.web.opened import WINDOW, Opened
from run.simulation.page_points import look, make_measured

from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.fit.camera import rectify
from symtop_ros.truth.fit.files import read_rows
from symtop_ros.truth.fit.main import make_parser

WIDTH, HEIGHT = 320, 240
PIVOT = (160.0, 200.0)
RATE = 30
COUNT = 40
# A hand is right to a pixel of the screen, which is less than one of the film here.
CLICK, FOUND = 0.6, 0.3  # px of the film


def swing(time):
    """Where the ball is: a precession with a nutation on it."""
    x = 160 + 90 * math.cos(2 * time) + 9 * math.cos(14 * time)
    return x, 90 + 30 * math.sin(2 * time) + 9 * math.sin(14 * time)


TIMES = [k / RATE for k in range(COUNT)]
BALLS = [swing(time) for time in TIMES]


@pytest.fixture(scope="session", name="film")
def _film(tmp_path_factory):
    return write_film(tmp_path_factory.mktemp("films") / "swing.mp4", draw_balls(BALLS), TIMES)


@pytest.fixture
def measuring(opened, film):
    """The page with a film."""
    open_file(opened, film)
    return opened


def open_file(page, path):
    page.open_tab("measure")
    page.tab.set_input_files("#measured-file", str(path))
    page.until(lambda: path.name in page.say("measured-name") and not is_opening(page))


def is_opening(page):
    return "is being opened" in page.say("measured-name")


def drop(page, name, content, kind=""):
    """Drop a file of these bytes."""
    page.tab.evaluate(
        """([name, data, type]) => {
            const bytes = Uint8Array.from(atob(data), (each) => each.charCodeAt(0));
            const dataTransfer = new DataTransfer();
            dataTransfer.items.add(new File([bytes], name, { type }));
            document.dispatchEvent(new DragEvent("drop", { dataTransfer, cancelable: true }));
        }""",
        [name, base64.b64encode(content).decode(), kind],
    )


def place(page, point, size=(WIDTH, HEIGHT)):
    """Return where a pixel of the film is on the screen, if the whole film is shown."""
    box = page.tab.locator("#film-picture").bounding_box()
    scale = min(box["width"] / size[0], box["height"] / size[1])
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    return [m + (p - s / 2) * scale for m, p, s in zip(middle, point, size, strict=True)]


def click(page, point):
    page.tab.mouse.click(*place(page, point))


def read_frame(page):
    return int(page.tab.input_value("#film-line"))


def click_balls(page, frames):
    """Click the ball in some of the frames that follow each other."""
    for frame in frames:
        page.until(lambda frame=frame: read_frame(page) == frame)
        click(page, BALLS[frame])


def read_command(page):
    """Return the command for a terminal as top_fit reads it."""
    program, *words = shlex.split(page.tab.input_value("#fit-command"))
    assert program == "top_fit"
    return make_parser().parse_args(words)


def save(page, folder):
    """Return the table that the page saves, as Python reads it."""
    with page.tab.expect_download() as download:
        page.tab.click("#save-measured")
    path = folder / download.value.suggested_filename
    download.value.save_as(path)
    return read_rows(path, None)


def expect_rows(frames):
    """What the rows of some frames are: u to the right and v upwards."""
    return [(BALLS[k][0], HEIGHT - BALLS[k][1]) for k in frames]


@pytest.mark.slow
def test_a_film_is_clicked_and_saved_as_a_table_of_top_fit(measuring, tmp_path):
    assert measuring.say("measured-name") == (
        "swing.mp4: 320 x 240 pixels, 40 frames, 30.00 in a second"
    )
    click(measuring, PIVOT)
    assert "Click the middle of the ball" in measuring.say("click-next")
    click_balls(measuring, range(5))
    rows = save(measuring, tmp_path)
    assert rows.kind == "pixels"
    assert rows.times == pytest.approx(TIMES[:5], abs=1e-7)
    assert rows.values == pytest.approx(np.array(expect_rows(range(5))), abs=CLICK)
    options = read_command(measuring)
    assert (str(options.record), options.kind) == ("measured.csv", "pixels")
    assert options.pivot == pytest.approx([PIVOT[0], HEIGHT - PIVOT[1]], abs=CLICK)
    assert options.pivot_deviation == 1  # px
    assert options.perspective
    measuring.tab.uncheck("#near-camera")
    assert not read_command(measuring).perspective


@pytest.mark.slow
def test_the_ring_is_where_the_ball_is_and_is_taken_when_it_is_asked_for(measuring, tmp_path):
    click(measuring, PIVOT)
    click_balls(measuring, range(3))
    measuring.until(lambda: "dashed ring" in measuring.say("ball-found"))
    assert "3 of 40 frames" in measuring.say("plan")  # a suggestion is no click
    measuring.tab.click("#take-ball")
    measuring.until(lambda: "4 of 40 frames" in measuring.say("plan"))
    measuring.tab.click("#follow-ball")
    measuring.until(lambda: f"{COUNT} of 40 frames" in measuring.say("plan"))
    rows = save(measuring, tmp_path)
    assert rows.times == pytest.approx(TIMES, abs=1e-7)
    assert rows.values[3:] == pytest.approx(np.array(expect_rows(range(3, COUNT))), abs=FOUND)


@pytest.mark.slow
def test_a_click_is_moved_and_undone(measuring, tmp_path):
    click(measuring, PIVOT)
    click_balls(measuring, range(2))
    measuring.until(lambda: read_frame(measuring) == 2)
    measuring.tab.click("#frame-back")
    measuring.until(lambda: read_frame(measuring) == 1)
    x, y = place(measuring, BALLS[1])
    a, b = place(measuring, (BALLS[1][0] + 20, BALLS[1][1] + 10))
    measuring.drag(x, y, a - x, b - y)
    measuring.tab.mouse.up()
    moved = save(measuring, tmp_path).values[1]
    u, v = expect_rows([1])[0]
    assert moved == pytest.approx([u + 20, v - 10], abs=CLICK)
    measuring.tab.focus("#film-picture")
    measuring.tab.keyboard.press("ArrowRight")
    measuring.tab.keyboard.press("ArrowUp")
    assert save(measuring, tmp_path).values[1] == pytest.approx(moved + 1, abs=1e-9)
    for _ in range(3):
        measuring.tab.keyboard.press("Control+z")
    assert save(measuring, tmp_path).values[1] == pytest.approx([u, v], abs=CLICK)
    measuring.tab.click("#undo-click")
    assert len(save(measuring, tmp_path).times) == 1
    assert "--pivot" in measuring.tab.input_value("#fit-command")
    for _ in range(2):
        measuring.tab.click("#undo-click")
    assert measuring.tab.is_hidden("#fit-parts")
    assert measuring.tab.is_disabled("#undo-click")


@pytest.mark.slow
def test_a_film_is_clicked_with_the_keyboard_alone(measuring, tmp_path):
    measuring.tab.focus("#film-picture")
    measuring.tab.keyboard.press("ArrowDown")  # the pivot begins in the middle of the picture
    command = measuring.tab.input_value("#fit-command")
    assert command == ""  # without a ball there is no record
    measuring.tab.click("[data-aim=ball]")
    measuring.tab.focus("#film-picture")
    for _ in range(2):
        measuring.tab.keyboard.press("ArrowLeft")
    measuring.tab.keyboard.press("PageDown")
    measuring.until(lambda: read_frame(measuring) == 1)
    measuring.tab.keyboard.press("ArrowUp")
    rows = save(measuring, tmp_path)
    assert rows.values.tolist() == [[158, 120], [158, 121]]
    assert "--pivot 160 119" in measuring.tab.input_value("#fit-command")
    measuring.tab.focus("#film-picture")
    measuring.tab.keyboard.press("Delete")
    assert len(save(measuring, tmp_path).times) == 1
    assert len(measuring.read_events()) == 1  # no key has pushed the top


@pytest.mark.slow
def test_a_length_gives_the_scale(measuring):
    measuring.tab.click("[data-aim=length]")
    click(measuring, (100, 50))
    assert "other end" in measuring.say("click-next")
    click(measuring, (180, 110))  # 100 px
    click_balls(measuring, [0])
    assert "--scale" not in measuring.tab.input_value("#fit-command")
    measuring.tab.fill("#length-value", "0.25")
    measuring.tab.fill("#ball-value", "0,5")
    options = read_command(measuring)
    # two ends, each a pixel of the screen from where they were meant
    assert options.scale == pytest.approx(200, abs=2 * CLICK * 2)
    # two clicks of a pixel, and the last digits of what was typed: 0.005 and 0.05 at most
    parts = [math.sqrt(2) / 100, 0.005 / math.sqrt(3) / 0.25, 0.05 / math.sqrt(3) / 0.5]
    expected = options.scale * math.hypot(*parts)
    assert options.scale_deviation == pytest.approx(expected, rel=0.05)  # two digits


def test_a_click_outside_of_the_picture_is_refused_and_nothing_is_lost(measuring):
    click(measuring, PIVOT)
    click_balls(measuring, range(2))
    click(measuring, (WIDTH / 2, -3))
    assert measuring.say("refusal") == "a click must be inside the picture"
    assert "2 of 40 frames" in measuring.say("plan")


def test_every_second_frame_is_proposed_if_half_of_them_are_wanted(measuring):
    measuring.tab.fill("#wanted-frames", "20")
    plan = "0 of 20 frames are clicked, from 0.00 s to 1.27 s; step in frames: 2"
    assert plan in measuring.say("plan")
    measuring.tab.evaluate("acts.change", ["film-line", 10])
    measuring.until(lambda: "frame 11 of 40" in measuring.tab.text_content("#film-clock"))
    measuring.tab.click("#begin-here")
    assert "from 0.33 s" in measuring.say("plan")
    measuring.tab.fill("#wanted-frames", "5")
    assert measuring.say("refusal") == "frames to click must be 20 to 200, got 5"


@pytest.mark.slow
@pytest.mark.parametrize("answer", ["keep", "replace"])
def test_another_film_asks_before_clicks_are_lost(measuring, film, answer, tmp_path):
    click(measuring, PIVOT)
    click_balls(measuring, range(2))
    measuring.tab.evaluate("acts.change", ["film-line", "30"])  # the other film has no such frame
    measuring.until(lambda: "frame 31 of" in measuring.say("film-clock"))
    click(measuring, BALLS[30])
    other = write_film(tmp_path / "other.webm", draw_balls(BALLS[:10]), TIMES[:10])
    measuring.tab.set_input_files("#measured-file", str(other))
    measuring.tab.wait_for_selector("#replace:not([hidden])")
    assert "other.webm" in measuring.say("replace-text")
    measuring.tab.click(f"#{answer}-film")
    assert measuring.tab.is_hidden("#replace")
    if answer == "keep":
        assert "3 of 40 frames" in measuring.say("plan")
        assert "swing.mp4" in measuring.say("measured-name")
        open_file(measuring, film)  # the same file takes nothing away
        assert "3 of 40 frames" in measuring.say("plan")
    else:
        measuring.until(lambda: "other.webm: 320 x 240" in measuring.say("measured-name"))
        assert "0 of 10 frames" in measuring.say("plan")


def test_a_table_is_dropped_and_its_command_is_that_of_its_kind(opened):
    rows = "\n".join(f"{k / 10},{math.cos(k / 10)},{math.sin(k / 10)},1" for k in range(20))
    drop(opened, "my points.txt", f"t,x,y,z\n{rows}\n2,,1,1\n".encode())
    opened.until(lambda: "my points.txt" in opened.say("measured-name"))
    assert opened.say("measured-name") == (
        "my points.txt: 20 rows, points of the axis (1 with an empty cell left out)"
    )
    assert opened.tab.input_value("#fit-command") == "top_fit 'my points.txt' --kind axis"
    assert opened.tab.is_visible("#measure")


def test_a_run_is_still_opened_by_dropping_it_and_a_film_by_its_bytes(opened, film):
    opened.drop(json.loads(json.dumps(make_measured())))
    opened.until(lambda: "points" in opened.read_run())
    drop(opened, "notes.txt", film.read_bytes(), "text/plain")
    opened.until(lambda: "notes.txt: 320 x 240" in opened.say("measured-name"))
    assert "points" in opened.read_run()


REFUSED = {
    "photo.png": (
        b"\x89PNG\r\n\x1a\n" + bytes(50),
        "photo.png must be a film or a table, got a si",
    ),
    "empty.mp4": (b"", "empty.mp4 must be a film or a table, got an empty file"),
    "data.bin": (bytes(range(256)), "data.bin must be a film or a table, got other data"),
    "film.mp4": (b"a text\n", "film.mp4 must have the columns t,x,y,z or t,u,v, got a text"),
    "rates.csv": (
        b"t,wx,wy,wz\n0,1,2,3\n",
        "the page fits points of the axis only; for this table type: top_fit rates.csv",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_another_file_is_refused_in_a_line_and_the_clicks_stay(measuring, name):
    click(measuring, PIVOT)
    click_balls(measuring, range(2))
    content, refusal = REFUSED[name]
    drop(measuring, name, content)
    measuring.until(lambda: measuring.say("refusal"))
    assert measuring.say("refusal").startswith(refusal)
    assert "2 of 40 frames" in measuring.say("plan")
    assert "swing.mp4" in measuring.say("measured-name")
    assert measuring.tab.is_visible("#film")


CAMERA = {
    "u": 160.0,
    "v": 90.0,
    "log_scale": math.log(90.0),
    "elevation": 0.5,
    "roll": 0.03125,
    "nearness": 0.125,
}
NUTATIONS = [k / 120 for k in range(72)]


def see_ball(times):
    """Where the ball of a top is in the picture of a camera: x, y from the upper left corner."""
    start = State.from_euler(theta=0.5, phi=0.75, phi_dot=2.0, psi_dot=150.0)
    axes = Motion(Top(0.000228, 5.72e-05, 0.068), start).at(np.array(times))
    seen = look(axes.to_world([0.0, 0.0, 1.0]), CAMERA)
    return np.stack([seen[:, 0], HEIGHT - seen[:, 1]], axis=1)


@pytest.fixture(scope="module", name="fitted")
def _fitted(_shared, path, tmp_path_factory):
    """The page after the fit of a film, and where the ball was in its frames."""
    balls = see_ball(NUTATIONS)
    film = write_film(tmp_path_factory.mktemp("fit") / "top.mp4", draw_balls(balls), NUTATIONS)
    page = _shared.open(path)
    open_file(page, film)
    page.tab.fill("#wanted-frames", "72")
    click(page, (CAMERA["u"], HEIGHT - CAMERA["v"]))
    for frame in range(3):
        page.until(lambda frame=frame: read_frame(page) == frame)
        click(page, balls[frame])
    page.tab.click("#follow-ball")
    page.until(lambda: "72 of 72" in page.say("plan"))
    page.tab.click("#fit-record")
    page.until(lambda: is_beside(page))
    return page, balls


def is_beside(page):
    assert page.say("refusal") == ""
    return page.tab.evaluate("document.body.dataset.film") == "beside"


@pytest.mark.slow
def test_the_run_of_a_fit_leaves_what_a_codec_leaves(fitted):
    page, balls = fitted
    points = page.read_run()["points"]
    assert points["kind"] == "pixels"
    assert len(points["times"]) == len(balls)
    assert np.abs(np.array(points["residuals"])[3:]).max() < FOUND
    # the points of a run are those of a camera that looks at the pivot; the film's does not
    centre = {"centre_u": WIDTH / 2, "centre_v": HEIGHT / 2}
    seen = rectify(np.array([(x, HEIGHT - y) for x, y in balls]), points["camera"] | centre)
    assert np.array(points["values"])[3:] == pytest.approx(seen[3:], abs=FOUND)


@pytest.mark.slow
def test_the_film_and_the_run_share_one_time(fitted):
    page, _ = fitted
    page.seek(0.25)
    page.until(lambda: read_frame(page) == 30)
    page.tab.evaluate("acts.change", ["film-line", 45])
    page.until(lambda: float(page.tab.input_value("#timeline")) == pytest.approx(0.375, abs=1e-6))
    assert read_frame(page) == 45
    page.tab.click("#pause")
    page.until(lambda: read_frame(page) > 46)
    page.tab.click("#pause")


BLUE = """() => {
    const canvas = document.getElementById("film-picture");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const found = [];
    for (let k = 0; k < data.length; k += 4)
        if (data[k] < 170 && data[k + 2] > 230 && data[k + 2] - data[k] > 80)
            found.push([(k / 4) % canvas.width, Math.floor(k / 4 / canvas.width)]);
    return [found, canvas.width, canvas.height];
}"""


@pytest.mark.slow
def test_the_path_of_the_fitted_axis_goes_through_the_balls_of_the_film(fitted):
    page, balls = fitted
    page.tab.set_viewport_size({"width": 2600, "height": 1800})  # dots do not cover the path
    page.tab.click("#tab-measure")
    page.seek(0)
    page.until(lambda: read_frame(page) == 0)
    page.wait_for_frames()
    blue, width, height = page.tab.evaluate(BLUE)
    scale = min(width / WIDTH, height / HEIGHT)
    places = (np.array(blue) + 0.5 - [width / 2, height / 2]) / scale + [WIDTH / 2, HEIGHT / 2]
    page.tab.set_viewport_size(WINDOW)
    # A piece of it is seen between two clicks that are farther apart than their dots are wide.
    middles = see_ball([time + 1 / 240 for time in NUTATIONS[5:-1]])
    apart = np.linalg.norm(middles[:, None] - balls[None], axis=2).min(axis=1)
    middles = middles[apart > 4.0 / scale]
    assert len(middles) > 20
    far = np.linalg.norm(middles[:, None] - places[None], axis=2)
    assert far.min(axis=1).max() < 2.0 / scale + FOUND
    way = see_ball(np.linspace(0, NUTATIONS[-1], 2000))
    astray = np.linalg.norm(way[:, None] - places[None], axis=2).min(axis=0)
    assert astray.max() < 8.0 / scale  # the ring of the motion, and nothing blue elsewhere


@pytest.mark.slow
def test_another_run_goes_on_without_the_film(fitted):
    page, _ = fitted
    page.start_scene("looping")
    page.wait_for_texts()
    frame = read_frame(page)
    page.wait_for_texts()
    assert read_frame(page) == frame
    page.tab.click("#close-film")
    assert page.tab.is_hidden("#film")
    page.open_tab("measure")
    page.tab.click("#open-film")
    assert page.tab.is_visible("#film")
    assert "72 of 72" in page.say("plan")


@pytest.mark.slow
def test_a_fit_is_stopped_and_a_record_of_too_few_rows_is_refused(measuring):
    click(measuring, PIVOT)
    click_balls(measuring, range(3))
    measuring.tab.click("#fit-record")
    measuring.until(lambda: measuring.say("refusal"))
    assert measuring.say("refusal") == "a record must have at least 12 rows, got 3"
    assert measuring.tab.is_enabled("#fit-record")
    measuring.tab.click("#follow-ball")
    measuring.until(lambda: "40 of 40" in measuring.say("plan"))
    measuring.tab.click("#fit-record")
    measuring.tab.click("#stop-fit")
    assert measuring.tab.is_enabled("#fit-record")
    assert measuring.tab.is_hidden("#fit-progress")
    assert "40 of 40" in measuring.say("plan")


def test_a_fit_of_what_is_measured_no_more_is_stopped(opened):
    """Its result would be that of another record than the one that is named."""
    rows = "".join(f"{k / 32},{k % 7},{k % 5}\n" for k in range(40))
    drop(opened, "first.csv", b"t,u,v\n" + rows.encode())
    opened.until(lambda: "first.csv" in opened.say("measured-name"))
    opened.tab.click("#fit-record")
    assert opened.tab.is_visible("#fit-progress")
    drop(opened, "second.csv", b"t,u,v\n" + rows.encode())
    opened.until(lambda: "second.csv" in opened.say("measured-name"))
    assert opened.tab.is_hidden("#fit-progress")
    assert opened.tab.is_enabled("#fit-record")


HUGE = 4_200_000_000  # bytes, more than 32 bits count


@pytest.mark.slow
def test_a_film_of_four_gigabytes_is_not_read_into_memory(opened, film, tmp_path):
    path = tmp_path / "huge.mp4"
    data = film.read_bytes()
    # What a film does not need may follow it: a free box, of a length that has 64 bits. The disk
    # holds nothing of it.
    with path.open("wb") as file:
        file.write(data + struct.pack(">I4sQ", 1, b"free", HUGE - len(data)))
        file.truncate(HUGE)
    before = opened.tab.evaluate("performance.memory.usedJSHeapSize")
    open_file(opened, path)
    assert opened.say("measured-name").startswith("huge.mp4: 320 x 240 pixels, 40 frames")
    click(opened, PIVOT)
    click_balls(opened, range(4))
    assert "4 of 40 frames" in opened.say("plan")
    assert opened.tab.evaluate("performance.memory.usedJSHeapSize") < before + 100_000_000


@pytest.mark.slow
def test_a_film_that_vanishes_leaves_its_clicks_and_is_opened_again(opened, film, tmp_path):
    path = tmp_path / "swing.mp4"
    path.write_bytes(film.read_bytes())
    open_file(opened, path)
    click(opened, PIVOT)
    click_balls(opened, range(2))
    opened.until(lambda: read_frame(opened) == 2)
    opened.tab.evaluate(VANISH)
    opened.tab.evaluate("acts.change", ["film-line", 30])
    opened.until(lambda: "cannot be read any more" in opened.say("refusal"))
    assert "2 of 40 frames" in opened.say("plan")
    open_file(opened, path)
    opened.until(lambda: "frame 1 of 40" in opened.tab.text_content("#film-clock"))
    assert "2 of 40 frames" in opened.say("plan")
    opened.tab.evaluate("acts.change", ["film-line", 30])
    opened.until(lambda: "frame 31 of 40" in opened.tab.text_content("#film-clock"))
    assert opened.say("refusal") == ""
    opened.problems.clear()  # the address that is none


# A browser may hold a short film as a whole, so that its file cannot be taken away: a seek fails.
VANISH = """() => {
    const { set } = Object.getOwnPropertyDescriptor(HTMLMediaElement.prototype, "currentTime");
    Object.defineProperty(HTMLMediaElement.prototype, "currentTime", {
        configurable: true,
        set(time) {
            const own = { set, configurable: true };
            Object.defineProperty(HTMLMediaElement.prototype, "currentTime", own);
            this.src = "blob:nothing";
        },
    });
}"""


def test_a_finger_clicks_where_it_is_let_go(browser, path, film):
    page = Opened(browser, locale="en-US")
    page.open(path)
    open_file(page, film)
    session = page.context.new_cdp_session(page.tab)

    def touch(kind, *points):
        places = [dict(zip("xy", place(page, point), strict=True)) for point in points]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": places})

    touch("touchStart", (100, 100))
    touch("touchMove", (150, 180))
    assert page.tab.is_visible("#film-loupe")  # a finger hides what is under it
    touch("touchMove", PIVOT)
    touch("touchEnd")
    page.until(lambda: "middle of the ball" in page.say("click-next"))
    click_balls(page, [0])
    pivot = read_command(page).pivot
    assert pivot == pytest.approx([PIVOT[0], HEIGHT - PIVOT[1]], abs=CLICK)
    page.close()


@pytest.mark.slow
def test_the_wheel_zooms_around_the_pointer_so_that_clicks_are_finer(measuring, tmp_path):
    click(measuring, PIVOT)
    x, y = map(round, place(measuring, BALLS[0]))
    measuring.tab.mouse.click(x, y)
    whole = save(measuring, tmp_path).values[0]
    measuring.tab.click("#undo-click")
    measuring.tab.click("#frame-back")
    measuring.until(lambda: read_frame(measuring) == 0)
    measuring.tab.mouse.move(x, y)
    for _ in range(10):
        measuring.tab.mouse.wheel(0, -100)
    measuring.wait_for_frames()
    measuring.tab.mouse.click(x, y)
    near = save(measuring, tmp_path).values[0]
    assert near == pytest.approx(whole, abs=0.02)  # two roundings to hundredths of a pixel
    measuring.tab.click("#undo-click")
    measuring.tab.click("#frame-back")
    measuring.until(lambda: read_frame(measuring) == 0)
    measuring.tab.mouse.click(x + 1, y)
    right = save(measuring, tmp_path).values[0] - near
    assert 0.02 < right[0] < 0.3  # px of the film, of one of the screen
    assert right[1] == 0
    for _ in range(11):
        measuring.tab.click("#film-farther")
    measuring.until(lambda: read_frame(measuring) == 1)
    click(measuring, BALLS[1])
    assert save(measuring, tmp_path).values[1] == pytest.approx(expect_rows([1])[0], abs=CLICK)


@pytest.mark.slow
def test_a_table_of_the_axis_is_fitted_without_a_film(opened):
    start = State.from_euler(theta=0.5, phi=0.75, phi_dot=2.0, psi_dot=150.0)
    motion = Motion(Top(0.000228, 5.72e-05, 0.068), start)
    axes = motion.at(np.array(NUTATIONS)).to_world([0.0, 0.0, 1.0])
    errors = 2.0**-9 * Numbers(3).normals(*axes.shape)
    lines = [
        f"{time:.9f};{x:.6f};{y:.6f};{z:.6f}".replace(".", ",")
        for time, (x, y, z) in zip(NUTATIONS, axes + errors, strict=True)
    ]
    drop(opened, "axis.csv", "\n".join(["t;x;y;z", *lines]).encode())
    opened.until(lambda: "72 rows" in opened.say("measured-name"))
    assert opened.tab.is_hidden("#near")
    opened.tab.click("#fit-record")
    opened.until(lambda: "points" in opened.read_run() or opened.say("refusal"))
    points = opened.read_run()["points"]
    assert points["kind"] == "axis"
    left = np.array(points["residuals"])
    assert np.sqrt(np.mean(left**2)) == pytest.approx(2.0**-9, rel=0.2)  # 216 numbers: 5 %
    assert opened.tab.is_hidden("#film")
    opened.until(lambda: opened.tab.inner_text("#fitted"))


@pytest.mark.parametrize("size", [(1280, 800), (390, 844)])
def test_while_a_film_is_clicked_nothing_is_asked_and_fit_and_save_are_in_reach(
    open_page, film, size
):
    page = open_page(known="", viewport={"width": size[0], "height": size[1]})
    open_file(page, film)
    for name in ("#question", "#answers", "#hurry", "#timeline"):
        assert not page.tab.is_visible(name)
    click(page, PIVOT)
    click_balls(page, range(2))
    page.until(lambda: page.tab.is_visible("#fit-record"))
    page.tab.mouse.move(0, 0)
    panel = page.tab.locator("#controls").bounding_box()
    end = page.tab.locator("#save-measured").bounding_box()
    if size[0] > 1000:  # without scrolling
        assert end["y"] + end["height"] <= panel["y"] + panel["height"]
    page.tab.locator("#save-measured").scroll_into_view_if_needed()
    assert page.tab.is_visible("#save-measured")
    page.tab.click("#close-film")
    assert page.tab.is_visible("#answers")  # it is still to be answered
