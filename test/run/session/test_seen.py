"""Starts from what is seen, asked of the service: solutions, refusals, events, their check."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from physics.tops import ARTICLE
from run.session.test_outputs import Program, advance, start
from run.simulation.runs import Run

from symtop_ros.physics import QUESTIONS, Motion, Top, solve_start
from symtop_ros.replay.main import main
from symtop_ros.run.check.run import check_run
from symtop_ros.run.check.starts import solve_again
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.changes.outcomes import Start
from symtop_ros.run.simulation.changes.seen import KNOWN, SEEN, find_starts
from symtop_ros.run.simulation.run_file import record_run

START = "set_initial_conditions"
# One of each question, by what a request must have so that it is one.
ASKED = [
    {"theta": 1.5, "precession_period": 1.5},
    {"theta": 0.5, "psi_dot": 200.0, "solution": 2},
    {"psi_dot": 200, "precession_period": 1.0},
    {"theta": 1.0, "dip": 0.125},
    {"theta": 0.5, "nutation_period": 0.15, "phi": 2.0, "psi": -1.0},
    {"energy": 1.21, "p_phi": 0.01004, "p_psi": 0.01144},
    {"alpha": 600.0, "a": 50.0, "b": 44.0, "solution": 1},
]


def ask(run, request):
    granted, answer = run.ask(START, request)
    assert granted, answer
    return answer


def test_the_questions_are_those_of_the_library():
    assert {frozenset(each.split()) for each in QUESTIONS} == {
        frozenset(name for name in request if name in KNOWN) for request in ASKED
    }
    assert {*SEEN} == {name for each in QUESTIONS for name in each.split()} - {"theta", "psi_dot"}


@pytest.mark.parametrize("request_", ASKED)
def test_each_question_starts_a_solution_and_lists_all_of_them(request_):
    run = Run("cusps", 0.1, initial__phi=0.25)
    answer = ask(run, request_)
    known = {name: request_[name] for name in request_ if name in KNOWN}
    expected = solve_start(ARTICLE, **known)
    taken = request_.get("solution", 1)
    motion = run.simulation.segment.motion
    chosen = expected[taken - 1]
    found = motion.start.euler_angles
    assert found.theta == pytest.approx(chosen.theta, rel=1e-14)
    assert found.phi == pytest.approx(request_.get("phi", 0.25), rel=1e-14)
    assert f"Solution {taken} of {len(expected)} for Ix = 0.000228 kg m^2, Iz = 5.72e-05" in answer
    for number, each in enumerate(expected, 1):
        # What is listed is read as a person would.
        listed = answer.split(f"({number}) ")[1].split("; ")[0]
        assert float(listed.split("theta = ")[1].split()[0]) == pytest.approx(each.theta, rel=1e-5)
        rates = (listed.split(f"{name} = ")[1].split()[0] for name in ("phi'", "psi'"))
        assert [*map(float, rates)] == pytest.approx([each.phi_dot, each.psi_dot], rel=1e-5)
    # The motion has what was asked for.
    seen = {
        "precession_period": motion.precession_period,
        "dip": np.ptp(motion.turning_angles),
        "nutation_period": motion.nutation_period,
        "energy": float(ARTICLE.energy(motion.start)),
        "p_psi": float(ARTICLE.axial_momentum(motion.start)),
        "p_phi": float(ARTICLE.vertical_momentum(motion.start)),
    }
    for name in known.keys() & seen.keys():
        assert seen[name] == pytest.approx(known[name], rel=1e-12), name


REFUSED = [
    ({"theta": 1.0, "dip": 0.1, "phi_dot": 3.0}, "phi_dot must be given without dip, got both"),
    ({"theta": 1.0, "precession_period": 2.0, "phi_dot": 0.0}, "phi_dot must be given without pre"),
    ({"dip": 0.1, "theta": 1.0, "precession": "slow"}, "precession must be given without dip, g"),
    ({"dip": 0.1, "orientation": [0, 0, 0, 1]}, "orientation must be given without dip, got both"),
    ({"theta": 1.0, "dip": 0.1, "solution": 3}, "solution must be 1 to 2, got 3"),
    (
        {"theta": 1.0, "dip": 0.1, "solution": 1.5},
        "solution must be a whole number up to 2, got 1.5",
    ),
    ({"theta": 1.0, "solution": 1}, "a start must have one of theta, precession_period / "),
    ({"dip": 0.1}, "a start must have one of theta, precession_period / "),
    ({"theta": 1.0, "dip": 3.0}, "dip must be > 0 and at most 2.14"),
    ({"theta": 1.0, "dip": "wide"}, "dip must be a finite number (rad), got 'wide'"),
    ({"theta": 1.0, "dip": math.nan}, "dip must be a finite number (rad), got nan"),
    ({"theta": 1.0, "dip": 0.1, "speed": 1.0}, "field name must be one of theta, phi, psi, "),
    ({"psi_dot": 1e300, "precession_period": 1.0}, "psi_dot must be at most 1e+100 rad/s in size"),
]


@pytest.mark.parametrize(("request_", "reason"), REFUSED)
def test_what_no_solution_is_or_may_stand_beside_one_is_refused_by_name(request_, reason):
    run = Run("cusps", 0.1)
    before = run.simulation.segment
    granted, answer = run.ask(START, request_)
    assert not granted
    assert answer.startswith(reason)
    assert run.simulation.segment is before


CAVEATS = [
    ({}, None, ""),
    ({"friction.axial": 1e-6}, "friction", "under gravity alone; friction acts too."),
    ({"steady_torque": [0.0, 0.0, 1e-4]}, "torque", "under gravity alone; a torque acts too."),
    ({"initial.clamped": True}, "held", "initial.clamped is true, so phi' is held."),
]


@pytest.mark.parametrize(("changes", "caveat", "words"), CAVEATS)
def test_it_is_said_for_which_motion_it_was_solved(changes, caveat, words):
    run = Run("cusps", 0.1)
    run.change(changes)
    answer = ask(run, {"theta": 1.0, "dip": 0.125})
    outcome = run.sink.events[-1].outcome()
    assert isinstance(outcome, Start)
    assert outcome.solved.caveat == caveat
    assert answer.endswith(words)
    assert ("The requested quantities" in answer) == bool(words)


def record(folder, *requests):
    """The log of a session with some starts."""
    host = Program()
    session, clock = start(host, record__enabled=True, record__directory=str(folder))
    for request in requests:
        advance(session, clock, 0.1)
        granted, answer = session.answer(START, lambda request=request: request)
        assert granted, answer
    advance(session, clock, 0.1)
    path, stamp = session.recording.path, session.simulation.last
    session.close()
    return path, stamp


def test_a_log_with_each_question_agrees_and_its_run_has_the_starts(tmp_path, capsys):
    path, stamp = record(tmp_path, *ASKED)
    log = TopLog(open_run([path]))
    found = check_run(log)
    assert (found.mismatches, found.samples_agree, log.catalog.problems) == ([], True, ())
    assert (found.starts.compared, found.starts.foreign) == (len(ASKED), 0)
    events, _ = record_run(log.catalog.events, stamp)
    assert [each.kind for each in events] == ["start"] * (1 + len(ASKED))
    assert main([str(path), "--check"]) == 0
    assert "solved starts" in capsys.readouterr().out


def change(event, **values):
    return replace(event, values={**event.values, **values})


def test_a_solution_of_another_question_is_found():
    run = Run("cusps", 0.1)
    ask(run, {"theta": 1.0, "dip": 0.125})
    event = run.sink.events[-1]
    assert solve_again([event]).mismatches == ()
    psi = "outcome.solved.found.0.psi_dot"
    spin = float(event.values[psi])
    wrong = [
        change(event, **{psi: repr(math.nextafter(spin, 0))}),
        change(event, **{"outcome.solved.taken": "2"}),
        change(event, **{"outcome.solved.taken": "7"}),
        change(event, **{"request.dip": "0.126"}),
        change(event, **{"request.dip": "deep"}),
        change(event, **{"outcome.solved.psi": "0.5"}),
    ]
    for each in wrong:
        assert len(solve_again([each]).mismatches) == 1
    older = solve_again([change(each, version="0.4.9") for each in wrong])
    assert (older.compared, older.foreign, older.mismatches) == (0, len(wrong), ())


def test_a_reset_and_a_plain_start_are_no_solutions():
    run = Run("cusps", 0.1)
    ask(run, {"theta": 1.0, "dip": 0.125})
    run.ask("reset")
    assert run.simulation.segment.motion.start == find_starts(
        ARTICLE, {"theta": 1.0, "dip": 0.125}
    )[0].start(0.0, 0.0)
    ask(run, {"theta": 0.5, "psi_dot": 200.0})
    assert solve_again(run.sink.events).compared == 1
    assert all(event.outcome().solved is None for event in run.sink.events[-2:])


def test_the_top_in_use_is_that_of_the_moment():
    run = Run("cusps", 0.1)
    run.change({"top.Mgl": 0.05})
    answer = ask(run, {"theta": 1.0, "dip": 0.125})
    assert "Mgl = 0.05 J: " in answer
    top = Top(ARTICLE.Ix, ARTICLE.Iz, 0.05)
    state = solve_start(top, theta=1.0, dip=0.125)[0].state
    assert Motion(top, state).start == run.simulation.segment.motion.start
    assert json.loads(run.ask("get_state")[1])["top"]["Mgl"] == 0.05
