"""Measured points on the page: drawn where they were seen, told by the pointer, and kept."""

import json
import re

import numpy as np
import pytest
from page.web.modules import load_kernel
from page.web.opened import KNOWN
from page.web.test_page_charts import read_axis
from page.web.test_page_poor import NO_PICTURE, read_circles, read_place
from run.simulation.page_points import (
    CAMERA,
    TIMES,
    list_hostile_points,
    make_kicked,
    make_measured,
    make_points,
    see,
)
from run.simulation.page_runs import START, find_refusal

from symtop_ros.page.web.join import LANGUAGES, read_texts
from symtop_ros.run.simulation.fields import TABLE
from symtop_ros.run.simulation.points import SEEN

TENTH = 0.051  # units: coordinates of a drawing are written in tenths
RING = "circle.pointed"


@pytest.fixture(name="measured")
def _measured(opened):
    """The page with a run of points of the axis."""
    drop(opened, make_measured())
    return opened


def drop(page, content):
    content = json.loads(json.dumps(content))
    page.drop(content)
    page.until(lambda: page.read_run().get("points") == content["points"] or page.say("refusal"))
    assert page.say("refusal") == ""
    page.wait_for_frames()


def read_dots(page, name):
    """The dots of a chart, in units of its drawing (n, 2)."""
    page.until(lambda: page.tab.locator(f"#{name} path.seen").count())
    path = page.tab.locator(f"#{name} path.seen").get_attribute("d")
    return np.array([(float(x), float(y)) for x, y in re.findall(r"M([-\d.]+) ([-\d.]+)h0", path)])


def read_times(page, name, dots):
    """The times of dots by the ticks below a chart."""
    ticks = page.tab.locator(f"#{name} text.tick[text-anchor=middle]").evaluate_all(
        "all => all.map(e => [Number(e.getAttribute('x')), Number(e.textContent)])"
    )
    (x, first), (other, last) = ticks[0], ticks[-2]  # the last one may be moved into the drawing
    return first + (dots[:, 0] - x) * (last - first) / (other - x)


def read_heights(page, name, dots):
    first, lowest, scale = read_axis(page, name)
    return first + scale * (dots[:, 1] - lowest), abs(scale)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["axis", "theta", "pixels", "attitude", "angles"])
def test_the_chart_of_the_tilt_has_each_point_where_it_was_seen(opened, kind):
    drop(opened, make_measured(kind))
    opened.until(lambda: len(read_dots(opened, "theta")) == len(TIMES))
    dots = read_dots(opened, "theta")
    points, states = make_points(kind), START.at(TIMES)
    heights, scale = read_heights(opened, "theta", dots)
    tilts = {
        "axis": lambda: np.arctan2(np.hypot(*points.values.T[:2]), points.values[:, 2]),
        "theta": lambda: points.values[:, 0],
        "angles": lambda: points.values[:, 0],
    }
    if kind in tilts:
        # a tick stands within half a tenth of its place, twice
        assert np.abs(heights - tilts[kind]()).max() < 3 * TENTH * scale
    # of noise of 2^-9, also where a picture makes it larger
    assert np.abs(heights - states.euler_angles.theta).max() < 8 * 2.0**-9 + 3 * TENTH * scale
    assert np.abs(read_times(opened, "theta", dots) - TIMES).max() < 0.01


@pytest.mark.slow
def test_rates_that_were_seen_are_in_the_charts_of_rates(opened):
    drop(opened, make_measured("rates"))
    assert opened.tab.locator("#theta path.seen").count() == 0
    states = START.at(TIMES)
    opened.open_charts("phi_dot", "psi_dot")
    rates = START.euler_rates(states)
    for name, exact in (("phi_dot", rates.phi_dot), ("psi_dot", rates.psi_dot)):
        opened.tab.locator(f"#{name}").scroll_into_view_if_needed()
        opened.until(lambda name=name: opened.tab.locator(f"#{name} path.seen").count())
        heights, scale = read_heights(opened, name, read_dots(opened, name))
        # noise of 2^-9 over sin(theta) > 0.4
        assert np.abs(heights - exact).max() < 20 * 2.0**-9 + 3 * TENTH * scale


def read_residuals(text):
    """The time and the residuals of the sentence under the chart of the tilt."""
    time, left = re.search(r"At ([\d.]+) s, measured minus computed: (.*)\.$", text).groups()
    numbers = [each.split()[1].replace("\u2212", "-") for each in left.split(", ")]
    return float(time), [float(each) for each in numbers]


def point_at(page, name, dot):
    box = page.tab.locator(f"#{name} > svg").bounding_box()
    unit = box["width"] / 300
    page.tab.mouse.move(box["x"] + dot[0] * unit, box["y"] + dot[1] * unit)
    page.until(lambda: page.tab.locator(f"#{name} {RING}").count())


@pytest.mark.slow
@pytest.mark.parametrize("place", [5, 23, 40])
def test_the_pointer_tells_the_time_and_the_residual(measured, place):
    point_at(measured, "theta", read_dots(measured, "theta")[place])
    # the ring is drawn with its chart, the sentence is written a frame or more later
    measured.until(lambda: f"At {TIMES[place]:.4f} s" in measured.say("points"))
    text = measured.say("points")
    assert text.startswith("48 measured points: the axis. At ")
    time, left = read_residuals(text)
    assert time == pytest.approx(TIMES[place], abs=5e-5)
    exact = make_points("axis").values[place] - see("axis")[place]
    # two digits of each
    assert left == pytest.approx(exact.tolist(), rel=0.051)
    measured.tab.mouse.move(0, 0)
    measured.until(lambda: not measured.tab.locator(f"#theta {RING}").count())
    measured.until(lambda: f"At {TIMES[-1]:.4f} s" in measured.say("points"))


@pytest.mark.slow
def test_without_a_pointer_the_slider_of_the_run_tells_each_point(measured):
    measured.tab.evaluate("acts.change", ["timeline", str(TIMES[10] + 0.001)])
    measured.until(lambda: f"At {TIMES[10]:.4f} s" in measured.say("points"))
    # the later ones come with the time
    measured.until(lambda: len(read_dots(measured, "theta")) == 11)


@pytest.mark.slow
def test_an_angle_that_is_left_is_in_the_unit_of_the_page(opened):
    drop(opened, make_measured("theta"))
    last = make_points("theta").residuals[-1, 0]
    for unit, size, sign in (("rad", 1.0, "rad"), ("deg", 180 / np.pi, "°")):
        opened.choose_unit(unit)
        opened.until(lambda sign=sign: f" {sign}." in opened.say("points"))
        (left,) = read_residuals(opened.say("points"))[1]
        assert left == pytest.approx(last * size, rel=0.051)


@pytest.mark.slow
def test_points_that_were_thinned_are_said_to_be(opened):
    drop(opened, make_measured("theta", rows=100_000))
    assert opened.say("points").startswith("48 measured points of 100000 rows: tilts. ")


@pytest.mark.slow
def test_an_act_ends_what_was_seen_of_the_motion_and_a_refusal_does_not(measured):
    content = measured.read_run()
    measured.drop({**content, "points": {**content["points"], "kind": "none"}})
    measured.until(lambda: measured.say("refusal"))
    assert measured.read_run() == content
    measured.press("Escape")
    measured.tab.evaluate("acts.change", ["timeline", str(TIMES[20] + 0.001)])
    measured.press("h")
    measured.until(lambda: len(measured.read_events()) == 2)
    kept = measured.read_run()
    assert kept["points"]["times"] == TIMES[:21].tolist()
    assert kept["points"]["values"] == content["points"]["values"][:21]
    assert kept["points"]["residuals"] == content["points"]["residuals"][:21]
    assert kept["format"] == 5
    measured.start_scene("looping")
    measured.until(lambda: measured.say("refusal") == "")
    drop(measured, content)
    measured.tab.evaluate("acts.change", ["timeline", "0"])
    measured.press("h")
    assert measured.read_run()["points"]["times"] == [0.0]


def test_a_run_without_points_has_the_format_of_before(measured):
    content = measured.read_run()
    del content["points"]
    measured.drop({**content, "format": 2})
    measured.until(lambda: "points" not in measured.read_run())
    assert measured.read_run()["format"] == 2
    measured.until(lambda: measured.say("points") == "")
    measured.until(lambda: not measured.tab.locator("#theta path.seen").count())


@pytest.mark.slow
def test_a_reload_and_a_saved_page_keep_the_points(open_page, tmp_path):
    page = open_page()
    drop(page, make_kicked())
    run = page.read_run()
    page.reload()
    assert page.read_run() == run
    other = open_page(file=page.save("This run as a page", tmp_path))
    assert other.read_run() == run
    assert len(run["events"]) == 3


@pytest.mark.slow
@pytest.mark.parametrize("step", [4, pytest.param(1, marks=pytest.mark.long)])
def test_damaged_points_are_refused_as_by_python(opened, step):
    runs = [content for _, content in list_hostile_points()[::step]]
    answers = opened.tab.evaluate("acts.refuse", [json.dumps(run) for run in runs])
    assert {(is_same, added) for _, is_same, added in answers} == {(True, 1)}
    found = [refusal.split(", got ")[0] for refusal, *_ in answers]
    assert found == [find_refusal(run).split(", got ")[0] for run in runs]


TWIN = """async ([points, kinds, start]) => {
  const { Marks } = await import("/run/marks.js");
  const { Run } = await import("/run/run.js");
  const run = new Run(kernel);
  run.load([start]);
  const held = { run, points, time: 1e9, content: { run_fields: { points: { kinds } } } };
  const marks = new Marks(held).list(0, 1e9);
  return marks.map(({ place, state, shows }) => {
    const { angles, rates } = state;
    return [place, shows, state.toWorld([0, 0, 1]), angles.theta, rates.phi, rates.psi];
  });
}"""


@pytest.mark.parametrize("kind", SEEN)
def test_marks_are_the_axes_and_rates_of_python(tab, kind):
    load_kernel(tab)
    content = json.loads(json.dumps(make_measured(kind)))
    kinds = TABLE["points"]["kinds"]
    (start,) = content["events"]
    marks = tab.evaluate(TWIN, [content["points"], kinds, start])
    assert [mark[0] for mark in marks] == [*range(len(TIMES))]
    points, states = make_points(kind), START.at(TIMES)
    axes, (phi_dot, psi_dot) = points.find_axes(states), points.find_rates(states)
    shows = {"phi", "theta"} & {*marks[0][1]}
    # roundings of a dozen operations; rates of 200 rad/s, over sin(theta)
    if "phi" in shows:
        assert np.abs(np.array([mark[2] for mark in marks]) - axes).max() < 1e-12
    assert bool(shows) == (kind not in ("rates", "inertial"))
    if "theta" in shows:
        tilts = [mark[3] for mark in marks]
        assert np.abs(tilts - points.find_tilts(states)).max() < 1e-12
    else:
        assert np.abs(np.array([mark[4] for mark in marks]) - phi_dot).max() < 1e-9
        assert np.abs(np.array([mark[5] for mark in marks]) - psi_dot).max() < 1e-9


def test_a_point_beside_the_sphere_is_not_drawn(opened):
    content = json.loads(json.dumps(make_measured("pixels")))
    content["points"]["values"][5] = [CAMERA["u"] + 10_000.0, CAMERA["v"]]
    drop(opened, content)
    opened.until(lambda: len(read_dots(opened, "theta")) == len(TIMES) - 1)


@pytest.mark.slow
def test_the_scene_tells_the_point_that_is_pointed_at(measured):
    """That of the chart has its label at its cross, and the pointer there tells the same."""
    label = measured.tab.locator("#labels .label[data-text^='At ']")
    assert label.count() == 0
    point_at(measured, "theta", read_dots(measured, "theta")[40])
    measured.until(lambda: label.count() and label.is_visible())
    told = label.get_attribute("data-text")
    measured.until(lambda: told in measured.say("points"))
    box, scene = label.bounding_box(), measured.tab.locator("#picture").bounding_box()
    measured.tab.mouse.move(scene["x"] + 5, scene["y"] + 5)
    measured.until(lambda: not label.is_visible())
    # the label stands some 40 px from its cross, away from the pivot: the cross is below
    middle = box["x"] + box["width"] / 2
    times = set()
    for y in np.arange(box["y"] + box["height"], box["y"] + box["height"] + 70, 10):
        for x in np.arange(middle - 100, middle + 100, 20):
            measured.tab.mouse.move(x, y)
        measured.wait_for_frames()
        times.add(read_residuals(measured.say("points"))[0])
    assert len(times) > 1  # not the last one alone, which is told without a pointer
    assert times <= {round(time, 4) for time in TIMES.tolist()}


def test_without_a_picture_the_points_are_around_the_way_of_the_axle(open_page):
    page = open_page(script=NO_PICTURE, known=KNOWN)
    drop(page, make_measured())
    dots = read_dots(page, "plain")
    radii, tilts = read_circles(page)
    places = [read_place(x, y, tilts[-1] / radii[-1]) for x, y in dots]
    x, y, z = make_points("axis").values.T
    # a unit has one decimal, and the tilts at the circles have three
    assert np.abs([place[0] for place in places] - np.arctan2(np.hypot(x, y), z)).max() < 0.004
    assert np.abs([place[1] for place in places] - np.arctan2(y, x)).max() < 0.01


def test_a_run_that_is_dropped_ends_the_question_of_a_first_visit(open_page):
    page = open_page(known="")
    asked = page.tab.locator("body[data-asked]")
    assert asked.count() == 1
    drop(page, make_measured())
    assert asked.count() == 0
    assert page.tab.is_visible("#hurry")


@pytest.mark.slow
def test_more_points_than_a_picture_shows_are_drawn_in_part(opened):
    times = np.arange(2000) / 4096
    drop(opened, make_measured("theta", times=times))
    opened.until(lambda: 300 <= len(read_dots(opened, "theta")) <= 600)
    dots = read_dots(opened, "theta")
    heights, scale = read_heights(opened, "theta", dots)
    exact = make_points("theta", times=times).values[:: 2000 // len(dots), 0][: len(dots)]
    assert np.abs(heights - exact).max() < 3 * TENTH * scale


@pytest.mark.parametrize("language", LANGUAGES)
def test_each_kind_has_its_words(language):
    texts = read_texts(language)
    assert {key.removeprefix("seen_as.") for key in texts if key.startswith("seen_as.")} == {*SEEN}
