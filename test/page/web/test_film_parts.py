"""Times of films from bytes that are written by the standards, and what becomes of clicks."""

import base64
import math
import struct

import pytest

READ = """async ([module, name, files]) => {
  const read = (await import(`/film/${module}.js`))[name];
  const decode = (text) => Uint8Array.from(atob(text), (each) => each.charCodeAt(0));
  return Promise.all(files.map((each) => read(new Blob([decode(each)]))));
}"""


def read_times(tab, module, name, files):
    """Return the times that the page finds in each file."""
    given = [base64.b64encode(each).decode() for each in files]
    return tab.evaluate(READ, [module, name, given])


# WebM: RFC 8794 (EBML) and RFC 9559 (Matroska).
SEGMENT, INFO, TRACKS, CLUSTER, GROUP, ENTRY = (
    bytes.fromhex(each) for each in ("18538067", "1549A966", "1654AE6B", "1F43B675", "A0", "AE")
)
HEAD, SCALE, NUMBER, TYPE, TIMESTAMP, SIMPLE, BLOCK = (
    bytes.fromhex(each) for each in ("1A45DFA3", "2AD7B1", "D7", "83", "E7", "A3", "A1")
)


def write_variable(value, length):
    """Return a number of variable length: a one, before which so many bytes have zeros."""
    return (value | 1 << 7 * length).to_bytes(length, "big")


def write_whole(value):
    return value.to_bytes(max((value.bit_length() + 7) // 8, 1), "big")


def write_webm(clusters, tracks=((1, 1),), scale=1_000_000, length=4, data=b"picture"):
    """Return a film: clusters of a time and blocks (track, time, whether in a group)."""

    def element(name, *content):
        whole = b"".join(content)
        return name + write_variable(len(whole), length) + whole

    def block(track, time, is_grouped):
        head = write_variable(track, 1 + (track > 126)) + struct.pack(">hB", time, 0x80)
        inner = element(BLOCK if is_grouped else SIMPLE, head, data)
        return element(GROUP, inner) if is_grouped else inner

    entries = [
        element(ENTRY, element(NUMBER, write_whole(number)), element(TYPE, write_whole(kind)))
        for number, kind in tracks
    ]
    parts = [
        element(CLUSTER, element(TIMESTAMP, write_whole(begin)), *(block(*each) for each in blocks))
        for begin, blocks in clusters
    ]
    info = element(INFO, element(SCALE, write_whole(scale)))
    whole = element(SEGMENT, info, element(TRACKS, *entries), *parts)
    return element(HEAD, b"webm") + whole


CLUSTERS = [(0, [(1, 0, False), (1, 33, True), (1, 70, False)]), (400, [(1, 20, False)])]
SECONDS = [0, 0.033, 0.07, 0.42]
LATE = [(400, [(1, 20, False), (1, -300, False)]), (0, [(1, 0, True)])]
SOUND, PICTURE = 2, 1


def test_a_webm_film_has_the_times_of_its_blocks(tab):
    of_200 = [(begin, [(200, *rest) for _, *rest in blocks]) for begin, blocks in CLUSTERS]
    mixed = [(0, [(2, 5, False), *CLUSTERS[0][1]]), (400, [(2, 1, True), (1, 20, False)])]
    cases = [
        (write_webm(CLUSTERS), SECONDS),
        *((write_webm(CLUSTERS, length=each), SECONDS) for each in (2, 3, 7, 8)),
        (write_webm(CLUSTERS, scale=500_000), [each / 2 for each in SECONDS]),
        (write_webm(of_200, tracks=((1, SOUND), (200, PICTURE))), SECONDS),
        (write_webm(mixed, tracks=((2, SOUND), (1, PICTURE))), SECONDS),
        (write_webm(mixed, tracks=((1, PICTURE), (2, PICTURE))), SECONDS),  # the first is shown
        (write_webm(LATE), [0, 0.1, 0.42]),
        (write_webm(CLUSTERS, data=bytes(200_000)), SECONDS),  # longer than is read at once
        (write_webm(CLUSTERS, tracks=((1, SOUND),)), []),
    ]
    found = read_times(tab, "webm", "readWebmTimes", [film for film, _ in cases])
    assert found == [pytest.approx(times, abs=1e-15) for _, times in cases]


def test_a_webm_film_that_is_cut_off_or_has_no_track_has_no_times(tab):
    film = write_webm(CLUSTERS)
    files = [film[: film.index(TRACKS) + 3], write_webm(CLUSTERS, tracks=()), b""]
    assert read_times(tab, "webm", "readWebmTimes", files) == [None] * len(files)


# MP4: ISO/IEC 14496-12. Lengths of 32 bits, or of 64 where a box is so large.
def box(name, *content, is_long=False):
    whole = b"".join(content)
    if is_long:
        return struct.pack(">I4sQ", 1, name.encode(), len(whole) + 16) + whole
    return struct.pack(">I4s", len(whole) + 8, name.encode()) + whole


def full(name, *content, version=0, flags=0):
    return box(name, struct.pack(">I", version << 24 | flags), *content)


def write_header(name, scale, version):
    """Return mvhd or mdhd: two dates, and the units in a second."""
    return full(name, struct.pack(">QQI" if version else ">III", 7, 9, scale), version=version)


def write_runs(name, runs):
    sign = "i" if name == "ctts" else "I"
    return full(name, struct.pack(">I", len(runs)), *(struct.pack(f">I{sign}", *r) for r in runs))


def write_index(steps, shifts=(), edits=(), version=0, kind=b"vide", usual=0, is_long=False):
    """Return moov of a film of 600 units in a second, and a track of 90 000."""
    dates = struct.pack(">QQI" if version else ">III", 1, 2, TRACK)
    form = ">QqI" if version else ">IiI"
    entries = [struct.pack(form, duration, begin, 1 << 16) for duration, begin in edits]
    list_ = full("elst", struct.pack(">I", len(edits)), *entries, version=version)
    tables = [write_runs("stts", steps), *([write_runs("ctts", shifts)] if shifts else [])]
    media = box(
        "mdia",
        write_header("mdhd", 90_000, version),
        full("hdlr", bytes(4), kind, bytes(12)),
        box("minf", box("stbl", *tables)),
    )
    edts = [box("edts", list_)] if edits else []
    track = box("trak", full("tkhd", dates, version=version), *edts, media)
    sound = box("trak", full("tkhd", bytes(12)), box("mdia", full("hdlr", bytes(4), b"soun")))
    extends = box("mvex", full("trex", struct.pack(">IIIII", TRACK, 1, usual, 0, 0)))
    return box("moov", write_header("mvhd", 600, version), sound, track, extends, is_long=is_long)


TRACK = 7
TYPE_BOX = box("ftyp", b"isom", bytes(4))
STEPS, SHIFTS = [(2, 3000), (2, 6000)], [(1, 3000), (2, 6000), (1, -3000)]
# decoded after 0, 3000, 6000 and 12 000 units of 90 000
PLAIN = [0, 3000 / 90_000, 6000 / 90_000, 12_000 / 90_000]


def test_an_mp4_film_has_the_times_of_its_tables(tab):
    shifted = sorted([3000, 9000, 12_000, 9000])
    whole = [each / 90_000 for each in shifted]
    cases = [
        (write_index(STEPS), PLAIN),
        (write_index(STEPS, version=1), PLAIN),
        (write_index(STEPS, is_long=True), PLAIN),
        (write_index(STEPS, SHIFTS), whole),
        # a track that begins half a second late, and one whose first frames are not shown
        (write_index(STEPS, edits=[(300, -1), (0, 0)]), [0.5 + each for each in PLAIN]),
        (write_index(STEPS, edits=[(300, -1), (0, 0)], version=1), [0.5 + each for each in PLAIN]),
        (
            write_index(STEPS, SHIFTS, edits=[(0, 3000)]),
            [(each - 3000) / 90_000 for each in shifted],
        ),
        (write_index(STEPS, edits=[(0, 4500)]), [0, 1500 / 90_000, 7500 / 90_000]),
        (write_index(STEPS, kind=b"soun"), []),
    ]
    files = [TYPE_BOX + film + box("mdat", bytes(20)) for film, _ in cases]
    found = read_times(tab, "mp4", "readMp4Times", files)
    assert found == [pytest.approx(times, abs=1e-15) for _, times in cases]


def test_a_file_without_an_index_has_no_times(tab):
    files = [TYPE_BOX, box("mdat", bytes(200)), TYPE_BOX + write_index(STEPS)[:40], b"no film"]
    found = read_times(tab, "mp4", "readMp4Times", files)
    assert found[:2] == [None, None]
    assert not any(found)


def write_piece(begin, rows, flags, step=None, number=TRACK, head=0, version=1):
    """Return moof: rows of a run have what its flags say, in the order of the standard."""
    more = bytes((8 if head & 1 else 0) + (4 if head & 2 else 0))
    if step is not None:
        head, more = head | 8, more + struct.pack(">I", step)
    first = bytes((4 if flags & 1 else 0) + (4 if flags & 4 else 0))
    runs = [struct.pack(f">{len(row)}i", *row) for row in rows]
    time = struct.pack(">Q" if version else ">I", begin)
    return box(
        "moof",
        full("mfhd", struct.pack(">I", 1)),
        box(
            "traf",
            full("tfhd", struct.pack(">I", number), more, flags=head),
            full("tfdt", time, version=version),
            full("trun", struct.pack(">I", len(rows)), first, *runs, flags=flags),
        ),
    )


def test_an_mp4_film_in_pieces_has_the_times_of_its_runs(tab):
    # durations; sizes and durations; shifts, too; nothing but the usual step
    pieces = [
        write_piece(0, [(3000,), (6000,)], 0x101),
        write_piece(9000, [(3000, 99), (1500, 98)], 0x305),
        write_piece(13_500, [(99, 5, 3000), (98, 5, -1500)], 0xE00, step=4500, head=3),
        write_piece(22_500, [(), ()], 0, version=0),
        write_piece(0, [(1,), (1,)], 0x100, number=8),  # of another track
    ]
    units = [0, 3000, 9000, 12_000, 16_500, 16_500, 22_500, 22_800]
    film = TYPE_BOX + write_index([], usual=300) + b"".join(pieces)
    (found,) = read_times(tab, "mp4", "readMp4Times", [film])
    assert found == pytest.approx([each / 90_000 for each in units], abs=1e-15)


CLICK = """async ([clicks, frame]) => {
  const { addClick, listMarks, History } = await import("/film/clicks.js");
  const history = new History();
  const write = ({ pivot, length, balls }) => ({ pivot, length, balls: [...balls] });
  const found = [history.isEmpty];
  for (const [aim, at, place] of clicks) history.take(addClick(history.now, aim, at, place));
  const marks = listMarks(history.now, frame);
  found.push(write(history.now), marks.map(({ aim, place }) => [aim, place]));
  found.push(marks.map(({ move }) => write(move([0.5, 0.25]))), history.isEmpty);
  history.undo();
  found.push(write(history.now));
  history.clear();
  history.undo();
  return [...found, history.isEmpty];
}"""


def test_clicks_are_kept_moved_and_taken_back(tab):
    length = [[[1, 1], [2, 2]], [[3, 3]]]
    clicks = [["ball", 4, [9, 8]], ["pivot", 0, [5, 6]]]
    clicks += [["length", 0, place] for place in (*length[0], *length[1])]
    clicks.append(["ball", 5, [7, 7]])
    before, kept, marks, moved, empty, undone, cleared = tab.evaluate(CLICK, [clicks, 5])
    assert (before, empty, cleared) == (True, False, True)
    assert kept == {"pivot": [5, 6], "length": length[1], "balls": [[4, [9, 8]], [5, [7, 7]]]}
    assert marks == [["pivot", [5, 6]], ["length", [3, 3]], ["ball", [7, 7]]]
    place = [0.5, 0.25]
    balls = [[4, [9, 8]], [5, place]]
    assert moved == [
        {**kept, "pivot": place},
        {**kept, "length": [place]},
        {**kept, "balls": balls},
    ]
    assert undone == {**kept, "balls": [[4, [9, 8]]]}


MEASURED = """async ([balls, pivot, length, times, lengths, perspective, name]) => {
  const { makeGiven, writeCommand, writeTable } = await import("/film/measured.js");
  const clicks = { pivot, length, balls: new Map(balls) };
  const given = makeGiven(clicks, { times, width: 320, height: 240 }, lengths, perspective);
  return [given, writeTable(given), writeCommand(name, given)];
}"""


def test_what_was_measured_is_a_record_a_table_and_a_command(tab):
    balls = [[2, [30.006, 40.5]], [0, [10, 20]]]
    times = [0.1, 0.2, 0.30000004]
    # 50 px are 20.0 cm, and the ball is 12 cm from the pivot
    lengths = {"length": {"value": 20.0, "half": 0.05}, "ball": {"value": 12, "half": 0.5}}
    ends = [[0, 0], [30, 40]]
    given, table, command = tab.evaluate(
        MEASURED, [balls, [160, 120.25], ends, times, lengths, True, "my film's.csv"]
    )
    assert (given["kind"], given["perspective"]) == ("pixels", True)
    assert given["times"] == [0.1, 0.3]
    assert given["values"] == [[10, 220], [30.01, 199.5]]  # v upwards
    scale = 50 / 20 * 12
    parts = math.sqrt(2) / 50, 0.05 / math.sqrt(3) / 20, 0.5 / math.sqrt(3) / 12
    deviation = math.hypot(*parts)
    assert given["known"]["u"] == [160, 1]
    assert given["known"]["v"] == [119.75, 1]
    assert given["known"]["log_scale"] == pytest.approx([math.log(scale), deviation], rel=1e-12)
    assert table == "t,u,v\n0.1,10,220\n0.3,30.01,199.5\n"
    spread = f"{scale * deviation:.2g}"
    assert command == (
        "top_fit 'my film'\\''s.csv' --kind pixels --pivot 160 119.75 --pivot-deviation 1 "
        f"--scale 30 --scale-deviation {spread} --perspective --centre 160 120"
    )


def test_without_a_pivot_and_lengths_nothing_is_known(tab):
    given, _, command = tab.evaluate(
        MEASURED, [[[0, [10, 20]]], None, [[1, 1]], [0], None, False, "run.csv"]
    )
    assert given["known"] == {}
    assert command == "top_fit run.csv --kind pixels"


PATH = """async ([times, end, camera]) => {
  const { isSame, tracePath } = await import("/film/motion.js");
  const asked = [];
  const at = (time) => ({ toWorld: () => { asked.push(time); return [0.5, 0, time / 1e9]; } });
  const top = { end, run: { at } };
  const points = { times, camera, values: [[1, 2]] };
  const path = tracePath(top, points, { width: 320, height: 240 });
  const others = [points, { ...points, values: [[1, 3]] }, { ...points, camera: null }, null];
  return [path, asked, others.map((each) => isSame(each, points))];
}"""


@pytest.mark.parametrize(("end", "last"), [(5e9, 2.0), (1e9, 1.0)])
def test_the_path_of_a_motion_goes_to_the_end_of_the_film_or_of_the_run(tab, end, last):
    level = {"u": 100, "v": 50, "log_scale": math.log(20), "elevation": 0, "roll": 0}
    path, asked, same = tab.evaluate(PATH, [[0, 1, 2], end, level])
    assert len(path) == 801
    assert (asked[0], asked[400], asked[-1]) == (0, last * 5e8, last * 1e9)
    assert path[-1] == pytest.approx([110, 240 - 50 - 20 * last])  # v of a film is upwards
    assert same == [True, False, False, False]
