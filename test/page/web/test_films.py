"""Films on the page: each frame with its own time, and what is no film or cannot be played."""

import base64

import numpy as np
import pytest
from films import TICKS, draw_balls, write_film

PIXEL = 0.3  # px; the codec's noise at the edge of the ball moves its middle less
STEADY = [k / 30 for k in range(40)]
FAST = [k / 120 for k in range(60)]
# Frames of a phone in dim light: late, early, and one that was lost.
UNEVEN = [0, 0.03, 0.07, 0.1, 0.2, 0.21, 0.3, 0.333, 0.5, 0.533, 0.6, 0.625, 0.7]


def place_balls(count):
    """A ball that is somewhere else in each frame, and moves down as it moves right."""
    return [(20 + 2 * k, 30 + 2.5 * k) for k in range(count)]


def encode(path):
    return base64.b64encode(path.read_bytes()).decode()


def read(films, path, frames, rate=None):
    return films.evaluate("readFilm", [encode(path), path.name, frames, rate])


def list_walks(count):
    """Frames one by one, back, and by jumps: a seek may begin anywhere."""
    return [*range(count), *range(count - 1, -1, -3), *[(17 * k) % count for k in range(30)]]


@pytest.mark.slow
@pytest.mark.parametrize("times", [STEADY, FAST, UNEVEN], ids=["30", "120", "uneven"])
@pytest.mark.parametrize(("suffix", "codec"), [("webm", "vp8"), ("webm", "vp9"), ("mp4", "h264")])
def test_each_frame_is_the_one_with_its_time(films, suffix, codec, times, tmp_path):
    balls = place_balls(len(times))
    path = write_film(tmp_path / f"a.{suffix}", draw_balls(balls), times, codec)
    walk = list_walks(len(times))
    film = read(films, path, walk)
    assert film["isReal"]
    assert (film["width"], film["height"]) == (320, 240)
    tick = 0.5 / TICKS[path.suffix]
    assert film["times"] == pytest.approx(times, abs=1.01 * tick)
    places, seen, x, y = np.transpose(np.array(film["found"], dtype=float))
    assert places.tolist() == walk
    assert np.abs(np.transpose([x, y]) - np.array(balls)[walk]).max() < PIXEL
    # Chromium says the time of a frame that it presents anew, to the microsecond.
    known = ~np.isnan(seen)
    assert known.sum() > len(times) / 2
    assert seen[known] == pytest.approx(np.array(film["times"])[walk][known], abs=1.1e-6)
    assert (film["rates"] is None) == (times is not UNEVEN)


@pytest.mark.parametrize("turn", [90, 180, 270])
def test_a_film_that_a_phone_has_turned_is_upright(films, turn, tmp_path):
    balls = place_balls(20)
    path = write_film(tmp_path / "a.mp4", draw_balls(balls), STEADY[:20], turn=turn)
    film = read(films, path, [3, 11])
    # clockwise, from the upper left corner of a picture of 320 x 240
    ways = {
        90: lambda x, y: (240 - y, x),
        180: lambda x, y: (320 - x, 240 - y),
        270: lambda x, y: (y, 320 - x),
    }
    assert (film["width"], film["height"]) == ((320, 240) if turn == 180 else (240, 320))
    for (_, _, *found), ball in zip(film["found"], (balls[3], balls[11]), strict=True):
        assert found == pytest.approx(ways[turn](*ball), abs=PIXEL)


def test_a_rate_that_is_typed_gives_slow_motion_its_own_times(films, tmp_path):
    path = write_film(tmp_path / "a.mp4", draw_balls(place_balls(40)), STEADY)
    film = read(films, path, [0, 39], 240)
    assert film["times"] == pytest.approx([k / 240 for k in range(40)])
    assert film["rate"] == pytest.approx(240)
    assert [place for place, *_ in film["found"]] == [0, 39]


def write_pieces(path, source):
    """The same film in pieces, without an index at its beginning, as browsers record it."""
    av = pytest.importorskip("av")
    options = {"movflags": "frag_keyframe+empty_moov"}
    with av.open(str(source)) as film, av.open(str(path), "w", options=options) as pieces:
        stream = pieces.add_stream_from_template(film.streams.video[0])
        for packet in film.demux(video=0):
            if packet.dts is not None:
                packet.stream = stream
                pieces.mux(packet)
    return path


@pytest.mark.parametrize("times", [STEADY, UNEVEN], ids=["30", "uneven"])
def test_a_film_in_pieces_has_its_own_times(films, times, tmp_path):
    balls = place_balls(len(times))
    source = write_film(tmp_path / "a.mp4", draw_balls(balls), times)
    film = read(films, write_pieces(tmp_path / "b.mp4", source), [7, 3, len(times) - 1])
    assert film["isReal"]
    assert film["times"] == pytest.approx(times, abs=1e-5)
    for place, seen, *found in film["found"]:
        assert found == pytest.approx(balls[place], abs=PIXEL)
        assert seen == pytest.approx(times[place], abs=1e-5)


def test_a_film_whose_times_cannot_be_read_has_those_of_the_rate_that_is_typed(films, tmp_path):
    balls = place_balls(40)
    path = write_film(tmp_path / "a.mp4", draw_balls(balls), STEADY)
    # as of a file of another kind, whose index the page does not know
    data, sort = encode(path), "film"
    assert films.evaluate("readFilm", [data, "a.ogv", [], None, sort])["times"] == [0]
    film = films.evaluate("readFilm", [data, "a.ogv", [30, 7, 39], 30, sort])
    assert not film["isReal"]
    assert film["times"] == pytest.approx(STEADY, abs=1e-6)
    for (_, _, *found), k in zip(film["found"], (30, 7, 39), strict=True):
        assert found == pytest.approx(balls[k], abs=PIXEL)


def write_sound(path):
    """A file with a sound and no picture."""
    av = pytest.importorskip("av")
    with av.open(str(path), "w") as film:
        stream = film.add_stream("libopus" if path.suffix == ".webm" else "aac", rate=48_000)
        stream.layout = "mono"
        for k in range(20):
            frame = av.AudioFrame.from_ndarray(
                np.zeros((1, 960), dtype=np.float32), format="fltp", layout="mono"
            )
            frame.sample_rate, frame.pts = 48_000, 960 * k
            film.mux(stream.encode(frame))
        film.mux(stream.encode())
    return path


def write_bytes(path, content):
    path.write_bytes(content)
    return path


def write_picture(path):
    from PIL import Image

    Image.new("RGB", (20, 20)).save(path)
    return path


BALLS = place_balls(30)
HOSTILE = {
    "notes.mp4": (lambda path: write_bytes(path, b"t and u and v\n"), "table", None),
    "empty.webm": (lambda path: write_bytes(path, b""), "empty", None),
    "zeros.mp4": (lambda path: write_bytes(path, bytes(5000)), "bytes", None),
    "photo.png": (write_picture, "picture", None),
    "photo.jpg": (write_picture, "picture", None),
    "photo.webp": (write_picture, "picture", None),
    "sound.webm": (write_sound, "webm", "sound.webm has no pictures"),
    "sound.mp4": (write_sound, "mp4", "sound.mp4 has no pictures"),
    "one.webm": (
        lambda path: write_film(path, draw_balls(BALLS[:1]), [0]),
        "webm",
        "one.webm must have at least 2 frames, got 1",
    ),
    "new.mp4": (
        lambda path: write_film(path, draw_balls(BALLS), STEADY[:30], "hevc"),
        "mp4",
        "this browser cannot play new.mp4: save it as MP4 (H.264) or WebM, and open it again",
    ),
    "cut.mp4": (
        lambda path: write_bytes(
            path, write_film(path, draw_balls(BALLS), STEADY[:30]).read_bytes()[:900]
        ),
        "mp4",
        "this browser cannot play cut.mp4: save it as MP4 (H.264) or WebM, and open it again",
    ),
    "cut.webm": (
        lambda path: write_bytes(
            path, write_film(path, draw_balls(BALLS), STEADY[:30]).read_bytes()[:60]
        ),
        "webm",
        "this browser cannot play cut.webm: save it as MP4 (H.264) or WebM, and open it again",
    ),
    "film.avi": (
        lambda path: write_bytes(path, b"RIFF\x00\x10\x00\x00AVI LIST" + bytes(300)),
        "film",
        "this browser cannot play film.avi: save it as MP4 (H.264) or WebM, and open it again",
    ),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_what_is_no_film_is_known_by_its_bytes_and_refused_in_a_line(films, name, tmp_path):
    make, sort, refusal = HOSTILE[name]
    path = make(tmp_path / name)
    found, answer = (
        films.evaluate("refuseFilm", [encode(path), name])
        if refusal
        else (films.evaluate(SORT, [encode(path), name]), None)
    )
    assert found == sort
    if refusal:
        assert refusal in answer


SORT = """async ([data, name]) => {
    const { findSort } = await import("/film/sorts.js");
    return await findSort(makeFile(data, name));
}"""


LOSE = """async ([data, name]) => {
    const { Film } = await import("/film/film.js");
    const film = await Film.open(makeFile(data, name), "mp4");
    film.video.src = "blob:nothing";
    try {
        await film.show(5);
    } catch (error) {
        return [error.message, film.place];
    }
}"""


def test_a_film_that_vanishes_is_said_and_the_frame_stays(films, tmp_path):
    path = write_film(tmp_path / "a.mp4", draw_balls(BALLS), STEADY[:30])
    said, place = films.evaluate(LOSE, [encode(path), path.name])
    assert said == "a.mp4 cannot be read any more: open it again, the clicks are kept"
    assert place == 0
