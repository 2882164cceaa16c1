"""A run of the page as the log that a node would have written."""

from dataclasses import replace

import numpy as np
import pytest
from exact_log import read_messages, stamps_of
from simulation.page_runs import START, make_run

from symtop_ros.check.run import check_run
from symtop_ros.log.top_log import TopLog, open_run
from symtop_ros.physics import ExactTimes, Motion, State
from symtop_ros.session.run_log import write_run_log
from symtop_ros.simulation.run_file import RunEvent, record_run
from symtop_ros.simulation.topics import DIAGNOSTICS
from symtop_ros.simulation.validation import RefusedError

END = 4_000_000_000  # ns


def read(path):
    return TopLog(open_run([path]))


def test_it_has_the_diagnostics_of_a_node(tmp_path):
    path = tmp_path / "run.mcap"
    write_run_log(make_run(), END, path)
    topics = [topic for topic, *_ in read_messages(path)]
    assert topics.count(DIAGNOSTICS.ros_name) == 4  # once a second


def test_of_acts_at_one_time_only_the_last_has_a_sample_and_what_is_undone_is_no_change(tmp_path):
    (begin, kick, _), torque = make_run(), (0.0, 0.0, 1e-4)
    state = kick.motion.at(ExactTimes(1_000_000_000))
    free, pushed = Motion(START.top, state), Motion(START.top, state, torque=torque)
    run = [
        *(begin, replace(begin, kind="start"), kick),
        RunEvent("torque", kick.time + 1_000_000_000, pushed, {}),
        RunEvent("torque", kick.time + 1_000_000_000, free, {}),
    ]
    path = tmp_path / "run.mcap"
    write_run_log(run, END, path)
    assert (np.diff(stamps_of(path)) > 0).all()
    found = check_run(read(path))
    assert found.samples_agree
    assert (found.mismatches, found.missing) == ([], [])
    events, _ = record_run(read(path).events(), END)
    assert [event.kind for event in events] == ["start", "start", "kick", "torque"]


KICKED = make_run()[1]
_q, _omega = KICKED.motion.start.parts
NEARLY = Motion(START.top, State(_q, _omega * (1 + 1e-6)))
WILD = Motion(START.top, START.start, torque=(0.0, 0.0, 1e20))


@pytest.mark.parametrize(
    ("first", "others", "reason"),
    [
        (
            START,
            [replace(KICKED, motion=NEARLY)],
            r"events\[1\]: angular_velocity must be the state",
        ),
        # a kick that no node grants
        (START, [replace(KICKED, act={})], r"events\[1\]: a request must have one of"),
        (WILD, [], "the run cannot be followed: "),
    ],
)
def test_a_run_that_cannot_be_is_refused_and_leaves_no_file(first, others, reason, tmp_path):
    with pytest.raises(RefusedError, match=reason):
        write_run_log([RunEvent("start", 0, first, {}), *others], END, tmp_path / "run.mcap")
    assert not list(tmp_path.iterdir())
