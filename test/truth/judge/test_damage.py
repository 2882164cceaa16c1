"""Judgements of damaged, cut, doubled and mixed logs, compared with the messages that were left.

Criteria are those of the lists of messages and of errors that were made: a judged error is that of
an estimate which is there, all estimates are counted, and what is said to be lost or doubled was.
"""

import re
from collections import Counter
from dataclasses import dataclass, replace
from functools import cache
from random import Random

import numpy as np
import pytest
from drawn import Numbers, normalize
from mcap.records import Channel, Message, Schema
from run.log.damaged import SECOND, Log, Recorded, zero_chunk
from run.log.ways import FILTER, OF_BYTES, OF_MESSAGES, OWN, RUNS, TF, write_damaged
from trials import seeds

from symtop_ros.base.arrays import compose, find_rotation_vectors, invert
from symtop_ros.base.refusals import RefusedError
from symtop_ros.replay.main import main as replay
from symtop_ros.run.log.reader import LogError, McapFile
from symtop_ros.run.wire.messages import QUATERNION
from symtop_ros.truth.judge.judgement import judge
from symtop_ros.truth.judge.main import main, make_parser
from symtop_ros.truth.judge.runs import read_run, read_sources, report_faults
from symtop_ros.truth.topics.estimates import decode_estimates

NOISE = 1e-3  # rad
BACK = 101_510_000_000, 100_600_000_000  # ns, between which the clock jumps


@dataclass(frozen=True)
class Made:
    """Files of a run with estimates, and the errors (rad) of these by their bytes."""

    logs: tuple[Log, ...]
    errors: dict[bytes, tuple[int, float]]  # with the stamps


@pytest.fixture(scope="module")
def make(tmp_path_factory):
    """Return the function that records a run once."""

    @cache
    def record(name):
        scene, script = RUNS[name]
        recorded = Recorded(tmp_path_factory.mktemp("run"), scene=scene)
        script(recorded)
        errors = {}
        logs = [add_estimates(Log.read(path), errors) for path in recorded.close()]
        return Made(tuple(logs), errors)

    return record


def add_estimates(log, errors):
    """The log with an estimate behind each of the node's attitudes, with noise."""
    places = log.places(OWN)
    own = [bytes(log.messages[k].data) for k in places]
    stamps = np.array([log.messages[k].log_time for k in places])
    # Each alone: together they are sorted by their stamps, which a clock may repeat.
    exact = np.concatenate([decode_estimates(QUATERNION.type, [each]).orientations for each in own])
    halves = NOISE / 2 * Numbers(len(own)).normals(len(own), 3)
    turned = compose(normalize(np.column_stack((np.ones(len(own)), halves))), exact)
    angles = np.linalg.norm(find_rotation_vectors(compose(turned, invert(exact))), axis=1)
    numbers = turned[:, [1, 2, 3, 0]]
    data = [bytes(each) for each in QUATERNION.layout("world").encode_many(stamps, numbers)]
    for each, true, stamp, angle in zip(data, own, stamps.tolist(), angles.tolist(), strict=True):
        errors[each], errors[true] = (stamp, angle), (stamp, 0.0)
    number, schema = max(log.channels) + 1, max(log.schemas) + 1
    mine = dict(zip(places, data, strict=True))
    messages = []
    for k, message in enumerate(log.messages):
        messages.append(message)
        if k in mine:
            time = message.log_time
            messages.append(Message(number, time, mine[k], time, 0))
    return replace(
        log,
        messages=messages,
        channels={**log.channels, number: Channel(number, FILTER, "cdr", {}, schema)},
        schemas={**log.schemas, schema: Schema(schema, b"", "ros2msg", QUATERNION.type)},
    )


def repair(paths):
    """Return the paths of repaired files."""
    found = [path.with_suffix(".repaired.mcap") for path in paths]
    for path, target in zip(paths, found, strict=True):
        assert replay([str(path), "--repair", str(target)]) == 0
    return found


def read_messages(paths, topic):
    files = [McapFile(path) for path in paths]
    return [
        bytes(each.data)
        for file in files
        for run in file.chunks()
        for each in run
        if each.channel_id in file.channels and file.channels[each.channel_id].topic == topic
    ]


def judge_logs(paths, topic, capsys):
    """Return the judgement and what is said of the estimates before."""
    words = [*map(str, paths), "--topic", topic, *(["--frame", "top"] if topic == TF else [])]
    options = make_parser().parse_args(words)
    run = read_run(options)
    (source,) = read_sources(options, run)
    capsys.readouterr()
    status = report_faults(run, [source])
    said = [
        line.removeprefix(f"top_judge: {topic}: ") for line in capsys.readouterr().err.splitlines()
    ]
    return judge(source.estimates, run.truth, topic, (), "none"), status, said


NUMBER = re.compile(r"(at least )?(\d+) estimates? (?:is|are) (missing|repeated)")


@pytest.mark.parametrize("seed", seeds(2, 300))
def test_what_is_judged_is_right_and_what_is_counted_is_there(seed, make, tmp_path, capsys):
    rng = Random(seed)
    for number in range(10):
        folder = tmp_path / f"{number}"
        folder.mkdir()
        # each run of the tests takes two runs of the top only: to record them takes a while
        made = make(rng.choice(list(RUNS) if seed > 1 else ["kicked", "back"]))
        way = rng.choice((*OF_MESSAGES, *OF_BYTES))
        paths = write_damaged(made.logs, way, rng, folder)
        if rng.random() < 0.2 and way in OF_BYTES:
            paths = repair(paths)
        topic = rng.choice((FILTER, OWN, TF))
        whole = [bytes(m.data) for log in made.logs for m in log.messages if log.topic(m) == topic]
        try:
            left = read_messages(paths, topic)
            found, _, said = judge_logs(paths, topic, capsys)
        except (RefusedError, LogError):
            continue  # one sentence, which other tests have
        assert_right(found, left, made.errors if topic != TF else None)
        differs = {
            "missing": (Counter(whole) - Counter(left)).total(),
            "repeated": (Counter(left) - Counter(whole)).total(),
        }
        for line in said:
            if numbers := NUMBER.fullmatch(line):
                least, count, kind = numbers.groups()
                assert int(count) <= differs[kind], (way, line)
                assert least or int(count) == differs[kind], (way, line)


def assert_right(found, left, errors):
    """Compare a judgement with the errors of the estimates that are left."""
    facts = found.facts()
    names = ["estimates", "unknown", "not_judged", "before_the_run", "after_the_run", "left_out"]
    assert sum(facts[name] for name in names) == len(left)
    if errors is None:  # exact ones
        assert found.errors.total.max() < 1e-6
        return
    expected: dict[int, list[float]] = {}
    for each in left:
        stamp, angle = errors[each]
        expected.setdefault(stamp, []).append(angle)
    for stamp, angle in zip(found.errors.stamps.tolist(), found.errors.total.tolist(), strict=True):
        nearest = min(expected[stamp], key=lambda each: abs(each - angle))
        assert nearest == pytest.approx(angle, abs=1e-7)
        expected[stamp].remove(nearest)


def test_a_clock_that_goes_back_leaves_out_what_two_motions_may_hold_at(make, tmp_path, capsys):
    made = make("back")
    found, status, said = judge_logs([made.logs[0].write(tmp_path / "a.mcap")], FILTER, capsys)
    stamps = [
        stamp for stamp, _ in map(made.errors.get, read_messages([tmp_path / "a.mcap"], FILTER))
    ]
    twice = sum(BACK[1] <= each < BACK[0] for each in stamps)
    assert twice == 182
    assert said == [
        f"{twice} estimates cannot be judged: more than one motion may hold there, as the clock "
        "went back"
    ]
    assert status == 1
    assert len(found.errors.total) == len(stamps) - twice
    assert found.errors.total.max() < 6 * NOISE


@pytest.mark.parametrize("lost", [1, 3, 20])
def test_samples_of_a_topic_lost_right_before_a_jump_back_are_missing(lost, make, tmp_path, capsys):
    (log,) = make("back").logs
    jump = next(
        k
        for k, each in enumerate(log.messages)
        if k and each.log_time < log.messages[k - 1].log_time
    )
    places = [k for k in log.places(OWN) if k < jump][-lost:]
    path = log.without(places).write(tmp_path / "a.mcap")
    _, _, said = judge_logs([path], OWN, capsys)
    are = "estimate is" if lost == 1 else "estimates are"
    assert f"at least {lost} {are} missing" in said


def test_without_the_event_of_a_jump_the_samples_of_before_are_not_compared(make, tmp_path, capsys):
    """Events 2 to 4 are lost, and two of them set the clock."""
    (log,) = make("back").logs
    path = log.without(log.places("/top/events")[1:]).write(tmp_path / "a.mcap")
    assert replay([str(path), "--check"]) == 1
    out, err = capsys.readouterr()
    assert "DO NOT agree" not in out
    assert "samples have the stamps of others: repeated, or an event that set the clock is" in err


def test_without_the_events_before_a_jump_forth_nothing_is_said_to_be_missing(
    make, tmp_path, capsys
):
    (log,) = make("forth").logs
    path = log.without(log.places("/top/events")[:2]).write(tmp_path / "a.mcap")
    _, _, said = judge_logs([path], OWN, capsys)
    assert not [line for line in said if "missing" in line]


def test_between_two_recordings_nothing_is_missing_although_no_event_says_so(
    make, tmp_path, capsys
):
    first, second = make("off").logs
    second = second.without(second.places("/top/events"))
    paths = [log.write(tmp_path / f"{n}.mcap") for n, log in enumerate((first, second))]
    _, _, said = judge_logs(paths, OWN, capsys)
    assert not [line for line in said if "missing" in line]


def test_between_two_runs_of_the_node_no_motion_is_known(tmp_path, capsys):
    """A filter that goes on while the node is started again."""
    paths = []
    errors: dict[bytes, tuple[int, float]] = {}
    for name, begin in (("a", 0.0), ("b", 5.0)):
        recorded = Recorded(tmp_path / name)
        recorded.jump(begin)
        recorded.run(1.0)
        (path,) = recorded.close()
        paths.append(add_estimates(Log.read(path), errors).write(tmp_path / f"{name}.mcap"))
    log = Log.read(paths[0])
    (template,) = [log.messages[log.places(FILTER)[-1]]]
    stamps = [SECOND + k * SECOND // 10 for k in range(2, 12)]
    zeros = np.tile([0.0, 0.0, 0.0, 1.0], (len(stamps), 1))
    data = QUATERNION.layout("world").encode_many(np.array(stamps), zeros)
    more = [
        replace(template, log_time=stamp, data=bytes(each))
        for stamp, each in zip(stamps, data, strict=True)
    ]
    paths[0].unlink()
    replace(log, messages=[*log.messages, *more]).write(paths[0])
    found, status, said = judge_logs(paths, FILTER, capsys)
    assert said == ["10 estimates cannot be judged: the motion is not known there"]
    assert status == 1
    assert found.errors.total.max() < 6 * NOISE


def test_a_frame_of_another_node_on_tf_has_not_lost_what_the_top_has(make, tmp_path, capsys):
    (log,) = make("kicked").logs
    places = log.places(TF)
    schema = next(n for n, each in log.schemas.items() if each.name.endswith("TFMessage"))
    number = next(n for n, each in log.channels.items() if each.topic == TF)
    assert log.channels[number].schema_id == schema
    others = [
        replace(
            log.messages[k],
            data=bytes(log.messages[k].data).replace(b"\4\0\0\0top\0", b"\4\0\0\0cam\0"),
        )
        for k in places
    ]
    lost = set(places[100:110])
    messages = [each for k, each in enumerate(log.messages) if k not in lost]
    path = replace(log, messages=[*messages, *others]).write(tmp_path / "a.mcap")
    words = [str(path), "--topic", TF, "--aligned", "none", "--frame"]
    assert main([*words, "top"]) == 1
    assert "/tf: 10 estimates are missing" in capsys.readouterr().err
    assert main([*words, "cam"]) == 0
    assert "/tf: " not in capsys.readouterr().err


@pytest.mark.parametrize(("lose", "is_late"), [(zero_chunk, False), (None, True)])
def test_only_if_its_end_is_lost_estimates_are_after_what_is_left(
    lose, is_late, make, tmp_path, capsys
):
    (log,) = make("kicked").logs
    half = [k for k, each in enumerate(log.messages) if each.log_time > 2 * SECOND]
    path = log.without(half).write(tmp_path / "a.mcap")
    if lose:
        lose(path, SECOND // 2)
    else:
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    other = log.write(tmp_path / "b.mcap")
    words = [str(path), "--estimates", str(other), "--topic", FILTER, "--aligned", "none"]
    assert main(words) == int(is_late)
    out, err = capsys.readouterr()
    assert ("cannot be judged: they are after the part of the log that is left" in err) == is_late
    assert " estimates after what is known of the run" in out
