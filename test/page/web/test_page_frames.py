"""What a frame is made of: passed time, states of the last seconds, and pictures for a lesson."""

import numpy as np
import pytest

# Frames of a top that runs or waits, on a browser whose frames and rests are noted.
FRAMES = """async ([isRunning, acts]) => {
  const { Frames } = await import("/run/frames.js");
  const own = [requestAnimationFrame, window.setTimeout, window.clearTimeout, performance.now];
  const said = [];
  const advance = (passed) => said.push(["advance", passed]);
  const frames = new Frames({ isRunning, advance });
  window.requestAnimationFrame = () => said.push(["frame"]);
  window.setTimeout = (_, time) => said.push(["rest", time]);
  window.clearTimeout = (timer) => said.push(["end of rest", timer]);
  try {
    for (const [act, time] of acts) {
      performance.now = () => time;
      if (act === "begin") frames.begin();
      if (act === "frame") frames.step(time);
      if (act === "key") dispatchEvent(new Event("keydown"));
    }
  } finally {
    [window.requestAnimationFrame, window.setTimeout, window.clearTimeout] = own;
    performance.now = own[3];
  }
  return said;
}"""


def test_a_top_that_runs_advances_by_the_time_between_frames(tab):
    times = [10, 26, 20, 5000]
    said = tab.evaluate(FRAMES, [True, [["begin", 10], *(["frame", each] for each in times)]])
    assert [given for name, *given in said if name == "advance"] == [[0], [16], [0], [4980]]
    assert sum(name == "frame" for name, *_ in said) == 5
    assert all(name in ("frame", "advance") for name, *_ in said)


def test_a_page_in_a_pause_rests_until_something_is_done(tab):
    acts = [["begin", 0], ["frame", 999], ["frame", 1000], ["key", 1200], ["frame", 1300]]
    said = tab.evaluate(FRAMES, [False, [*acts, ["frame", 1316], ["frame", 2200]]])
    assert said == [
        ["frame"],
        ["frame"],
        ["advance", 0],
        ["rest", 500],
        ["advance", 1],
        ["end of rest", 4],  # what the timer returned
        ["frame"],
        ["frame"],
        ["advance", 0],  # the time of a rest is none of the motion
        ["frame"],
        ["advance", 16],
        ["rest", 500],
        ["advance", 884],
    ]


TRACE = """async ([window, points, start, times]) => {
  const { Trace } = await import("/run/trace.js");
  const asked = [];
  const run = {
    findStart: () => start,
    at: (time) => {
      asked.push(time);
      return `state of ${time}`;
    },
  };
  const top = { run, time: 0, state: "now" };
  const trace = Object.assign(new Trace(top), { window, points });
  return times.map((time) => {
    top.time = time;
    asked.length = 0;
    const listed = trace.listTimes();
    return [listed, trace.findStates(listed), [...asked]];
  });
}"""


def test_a_trace_has_a_grid_of_times_and_asks_for_new_states_only(tab):
    # 1 s in 10 points, of a run that began at 0.25 s
    times = [int(each * 1e9) for each in (0.25, 0.55, 0.65, 2.0)]
    found = tab.evaluate(TRACE, [1, 10, times[0], times])
    grids = [[], [0.3, 0.4, 0.5], [0.3, 0.4, 0.5, 0.6], np.arange(10, 20) / 10]
    new = [[], [0.3, 0.4, 0.5], [0.6], np.arange(10, 20) / 10]
    for (listed, states, asked), time, grid, more in zip(found, times, grids, new, strict=True):
        right = [round(each * 1e9) for each in grid]
        assert listed == [*right, time]
        assert states == [*(f"state of {each}" for each in right), "now"]
        assert asked == [round(each * 1e9) for each in more]


BEGIN = """async ([top, starts]) => {
  const { Course } = await import("/physics/course.js");
  const { State } = await import("/physics/state.js");
  const { Trace } = await import("/run/trace.js");
  return starts.map(([theta, psi]) => {
    const trace = new Trace({});
    const course = new Course(kernel, top, State.fromEuler(kernel, { theta }, { psi }));
    trace.begin(course);
    return [trace.window, trace.points, course.motion.nutation_period];
  });
}"""


def test_a_trace_shows_a_turn_or_some_nutations_in_enough_points(tab):
    top = {"Ix": 0.000228, "Iz": 0.0000572, "Mgl": 0.068}
    found = tab.evaluate(BEGIN, [top, [[0.5, 200], [0.5, 3000], [3.0, 0]]])
    for window, points, period in found:
        assert 0.05 <= window <= 30
        assert points == pytest.approx(min(max(64 * window / period, 240), 960))


SMALL = """async ([width, height]) => {
  const { drawSmall } = await import("/scene/picture.js");
  const canvas = Object.assign(document.createElement("canvas"), { id: "picture", width, height });
  document.body.append(canvas);
  const context = canvas.getContext("2d");
  for (let x = 0; x < width; x += 1) {
    context.fillStyle = `rgb(${x % 256}, ${Math.floor(x / 256)}, 0)`;
    context.fillRect(x, 0, 1, height);
  }
  const picture = drawSmall();
  canvas.remove();
  const { data } = picture.getContext("2d").getImageData(0, 0, picture.width, 1);
  const read = (_, k) => data[4 * k] + 256 * data[4 * k + 1];
  const columns = Array.from({ length: picture.width }, read);
  return [picture.width, picture.height, columns];
}"""


@pytest.mark.parametrize(("width", "wide"), [(600, 260), (200, 200)])
def test_a_small_picture_is_the_middle_of_the_scene(tab, width, wide):
    found = tab.evaluate(SMALL, [width, 200])
    assert found[:2] == [wide, 200]
    first = (width - wide) // 2
    assert found[2] == [*range(first, first + wide)]
