"""Axes, curves and points of a chart: each value stands where the axes say, and nothing beyond."""

import math
import re
from decimal import Decimal

import pytest

LEFT, RIGHT, UPPER = 44, 282, 21  # units of the drawing, in which a chart is 300 wide
LOWER = 28  # units below the axes
HEIGHT = 119

# A frame, and what its functions give.
FRAME = """async ([given, calls]) => {
  const { Frame } = await import("/charts/plot.js");
  const frame = new Frame(...given);
  const found = calls.map(([name, ...values]) => frame[name](...values));
  return [frame.axes, found];
}"""
TICK = re.compile(r'<text class="tick" x="(\S+)" y="(\S+)" text-anchor="(\w+)">(\S+)</text>')


def draw(tab, horizontal, vertical, calls=(), marks=4):
    given = [HEIGHT, list(horizontal), list(vertical), marks]
    return tab.evaluate(FRAME, [given, [*map(list, calls)]])


def read_ticks(axes):
    """Return the numbers at an axis with the heights at which they stand."""
    found = TICK.findall(axes)
    return [(float(text.replace("\u2212", "-")), float(y)) for _, y, _, text in found]


def find_ticks(low, high, count):
    """Return multiples of the smallest of 1, 2, 5 times a power of ten that is no finer."""
    rough = (Decimal(high) - Decimal(low)) / count
    steps = [Decimal(k).scaleb(n) for n in range(-12, 12) for k in (1, 2, 5)]
    step = next(each for each in steps if each >= rough * Decimal("0.999"))
    first = math.ceil(Decimal(low) / step)
    return [float(k * step) for k in range(first, first + 100) if k * step <= Decimal(high)]


@pytest.mark.parametrize(
    ("low", "high", "count"),
    [(0, 1, 4), (-3, 7, 4), (-0.5, 0.25, 3), (0.125, 0.1875, 4), (1000, 1010, 4), (-1e5, 3e5, 3)],
)
def test_round_values_stand_at_their_heights(tab, low, high, count):
    axes, _ = draw(tab, (0, 1), (low, high), marks=count)
    ticks = read_ticks(axes)
    assert [value for value, _ in ticks] == pytest.approx(find_ticks(low, high, count), rel=1e-4)
    bottom = HEIGHT - LOWER
    for value, y in ticks:
        height = bottom - (value - low) / (high - low) * (bottom - UPPER)
        assert y == pytest.approx(height + 3, abs=0.1)  # the middle of a letter; one decimal
        assert f"M44 {y - 3:.1f}H282" in axes


def test_a_chart_may_have_its_large_values_below(tab):
    axes, found = draw(tab, (0, 1), (2, 1), [("y", 2), ("y", 1)])
    assert found == [HEIGHT - LOWER, UPPER]
    assert [value for value, _ in read_ticks(axes)] == [1, 1.5, 2]


def test_values_far_larger_than_their_span_have_no_number_twice(tab):
    axes, _ = draw(tab, (0, 1), (1e9, 1e9 + 0.5))
    values = [value for value, _ in read_ticks(axes)]
    assert len(values) == len(set(values)) <= 6


def test_places_are_linear_and_stay_near_the_drawing(tab):
    values = [-2, -1.5, 0, 1e30, -1e30]
    _, found = draw(tab, (-2, 0), (10, 20), [("x", each) for each in values])
    assert found == pytest.approx([LEFT, LEFT + (RIGHT - LEFT) / 4, RIGHT, 1e4, -1e4])
    _, found = draw(tab, (-2, 0), (10, 20), [("y", each) for each in (10, 15, 20, 1e30)])
    assert found == pytest.approx([91, 56, 21, -1e4])


CURVE = """async () => {
  const { Frame } = await import("/charts/plot.js");
  const frame = new Frame(119, [0, 10], [0, 10]);
  return frame.curve([[0, 0], [1, 10], [2, NaN], [3, 5], [4, Infinity]], 'class="a"');
}"""


def test_a_curve_has_gaps_where_it_has_no_height(tab):
    path = '<path d="M44.0 91.0L67.8 21.0M115.4 56.0L139.2 -10000.0" fill="none" class="a"/>'
    assert tab.evaluate(CURVE) == path


def test_lines_bands_dots_and_names_stand_at_their_values(tab):
    calls = [
        ("level", 5, "s"),
        ("upright", 5, "s"),
        ("band", [2, 4], "s"),
        ("band", [2, 2], "s"),
        ("dot", [10, 0], "s"),
        ("dots", [[0, 0], [10, 10]], "s"),
        ("nameVertical", "a < b"),
        ("nameLevel", 10, "top"),
        ("writeBelow", [0, 2.5]),
        ("clip", "inner"),
    ]
    _, (level, upright, band, least, dot, dots, name, level_name, below, clip) = draw(
        tab, (0, 10), (0, 10), calls
    )
    assert level == '<path d="M44 56.0H282" s/>'
    assert upright == '<path d="M163.0 21V91" s/>'
    assert band == '<rect x="91.6" y="21" width="47.6" height="70" s/>'
    assert 'width="1.0"' in least  # it is seen
    assert dot == '<circle cx="282.0" cy="91.0" r="5" s/>'
    assert 'd="M44.0 91.0h0M282.0 21.0h0"' in dots
    assert name == '<text x="4" y="11">a &lt; b</text>'
    assert level_name == '<text x="285" y="25.0">top</text>'
    assert [(x, y, text) for x, y, _, text in TICK.findall(below)] == [
        ("44.0", "103", "0"),
        ("103.5", "103", "2.5"),
    ]
    box = 'x="44" y="21" width="238" height="70" viewBox="44 21 238 70"'
    assert clip == f"<svg {box}>inner</svg>"


def test_a_span_has_room_and_shows_no_rounding(tab):
    cases = {
        ((1, 3, 2), 0.1): (1 - 0.12, 3 + 0.12),
        ((5, 5), 1): (4.5, 5.5),
        ((-1, 1), 10): (-5, 5),
        ((), 1): (0, 1),
        ((2,), 0): (2 - 1e-9, 2 + 1e-9),
    }
    calls = [["findSpan", [*numbers], least] for numbers, least in cases]
    found = tab.evaluate("callAll", ["charts/plot", calls])
    assert found == [pytest.approx(list(span), abs=1e-15) for span in cases.values()]


MARKS = """async ([marks, wanted, pointed]) => {
  const { Frame } = await import("/charts/plot.js");
  const { drawMarks, placeMarks } = await import("/charts/seen_points.js");
  const frame = new Frame(119, [0, 10], [0, 10]);
  const kept = [];
  const all = { pointed, keep: (...given) => kept.push(given) };
  const placed = placeMarks(marks, wanted, ({ at }) => at);
  return [drawMarks("theta", frame, all, placed), kept];
}"""
SEEN = [
    {"place": 3, "shows": ["theta", "phi"], "at": [0, 0]},
    {"place": 5, "shows": ["theta"], "at": [5, 5]},
    {"place": 9, "shows": ["phi_dot"], "at": [10, 10]},
]


@pytest.mark.parametrize(("pointed", "ring"), [(None, None), (5, "163.0"), (3, "44.0"), (9, None)])
def test_a_chart_has_the_points_that_show_its_quantity_and_a_ring_at_one(tab, pointed, ring):
    drawing, kept = tab.evaluate(MARKS, [SEEN, ["time", "theta"], pointed])
    assert kept == [["theta", [[44, 91, 3], [163, 56, 5]], 300]]
    assert 'd="M44.0 91.0h0M163.0 56.0h0"' in drawing
    rings = re.findall(r'<circle cx="(\S+)".*class="pointed"', drawing)
    assert rings == ([ring] if ring else [])


def test_without_points_nothing_is_drawn_and_none_is_found_by_the_pointer(tab):
    assert tab.evaluate(MARKS, [SEEN, ["theta", "phi_dot"], 3]) == ["", [["theta", [], 300]]]


SERIES = """async ([id, samples, facts]) => {
  const { drawOneSeries } = await import("/charts/series_charts.js");
  const place = document.createElement("div");
  place.id = id;
  place.innerHTML = "<svg></svg><select id='unit'><option>rad</option></select>";
  document.body.append(place);
  const states = samples.map(([time, value, ghost]) => ({
    time: 1e9 * time,
    state: { angles: { theta: value }, rates: { phi: value, psi: -value } },
    ghost: ghost === null ? null : { angles: { theta: ghost } },
  }));
  drawOneSeries(id, states, facts, [], { pointed: null, keep: () => {} });
  place.remove();
  return place.innerHTML;
}"""
BODY = {"Ix": 0.000228, "Iz": 0.0000572, "Mgl": 0.068}
PATH = re.compile(r'<path d="(\S[^"]*)" fill="none" (.*?)>')


def read_curves(drawing):
    """Return the points of each curve by its style."""
    found = {}
    for path, style in PATH.findall(drawing):
        numbers = [float(each) for each in re.findall(r"-?\d+\.\d", path)]
        found[style] = [*zip(numbers[::2], numbers[1::2], strict=True)]
    return found


@pytest.mark.parametrize("window", [100.0, 4.0, 2.0])
def test_a_series_goes_from_the_first_sample_or_the_window_to_now(tab, window):
    samples = [[10 + k, 0.5 + 0.1 * k, 0.5 if k < 3 else None] for k in range(5)]
    facts = {"window": window, "marks": [9.0, 11.0, 13.0, 14.5], "body": BODY}
    drawing = tab.evaluate(SERIES, ["theta", samples, facts])
    begin = max(14 - window, 10)
    end = max(14, begin + window / 20)  # a first moment does not fill the chart

    def place(time):
        return LEFT + (RIGHT - LEFT) * (time - begin) / (end - begin)

    curves = read_curves(drawing)
    own = next(points for style, points in curves.items() if "var(--theta)" in style)
    ghost = next(points for style, points in curves.items() if "ghost" in style)
    assert [x for x, _ in own] == pytest.approx([place(t) for t, *_ in samples], abs=0.06)
    assert [x for x, _ in ghost] == pytest.approx([place(t) for t in (10, 11, 12)], abs=0.06)
    heights = [y for _, y in own]
    assert heights == sorted(heights)  # a small tilt is high
    assert {y for _, y in ghost} == {heights[0]}
    kicks = [float(x) for x in re.findall(r'd="M(\S+) 21V91" class="kick"', drawing)]
    assert kicks == pytest.approx([place(t) for t in (11, 13) if t >= begin], abs=0.06)
    assert f'<circle cx="{place(14):.1f}" cy="{heights[-1]:.1f}"' in drawing


def test_a_rate_is_high_where_it_is_large_and_spans_a_part_of_itself(tab):
    samples = [[0, 100.0, None], [1, 100.001, None]]
    facts = {"window": 10.0, "marks": [], "body": BODY}
    for id_, sign in (("phi_dot", 1), ("psi_dot", -1)):
        drawing = tab.evaluate(SERIES, [id_, samples, facts])
        values = [value for value, _ in read_ticks(drawing)]
        # a fiftieth of the rate is spanned at least, and its 0.001 is not seen
        assert min(values) < sign * 100 - 0.4
        assert max(values) > sign * 100 + 0.4
        (own,) = (points for style, points in read_curves(drawing).items() if "--" in style)
        assert own[0][1] == pytest.approx(own[1][1], abs=0.11)
