from workshop.speed.benchmarks import (
    FIRST,
    FULL,
    QUICK,
    SMALL,
    DrivenCase,
    Growth,
    HardCase,
    Results,
    _lengthen,
    list_steps,
)
from workshop.speed.peers import CLOSED_FORM, TAYLOR
from workshop.speed.peers.peer import Peer, Solution
from workshop.speed.reference import EPS, Reference
from workshop.speed.sweep import Curve, Measurement

CUSPS = Reference.read().article[0]


def curve(peer, motion, error):
    return Curve(peer, motion, 10.0, (Measurement(0.0, error, error, 9, 1e-3, 0.0),), "finest")


def test_errors_that_are_too_large_are_listed_one_by_one():
    results = Results(
        checks={"a peer": 0.5, "a good peer": 1e-5},
        curves=[curve(CLOSED_FORM, "cusps", 1e-10), curve(TAYLOR, "cusps with friction", 1e-9)],
        growth=[Growth(CLOSED_FORM, 0.0, (10.0, 1e5), (1e-16, 1.0), (1e-4, 1e-4))],
        hard=[HardCase("tilt", 0.1, EPS, 20 * EPS, {}), HardCase("spin", 1.0, EPS, 10 * EPS, {})],
        driven=[DrivenCase("rods", {TAYLOR: 1e-9}, {TAYLOR: 1e-3})],
    )
    assert results.list_failures() == [
        "a peer: the model is a different top",
        f"tilt, 0.1: error {20 * EPS:.1e}",
        "cusps at 10 s: error 1.0e-10",
        "cusps at 100000 s: error 1.0e+00",
        "cusps at 1e+06 s: error inf",
        "symtop_ros, Taylor series: error 1.0e-09",
        "rods: error 1.0e-09",
    ]


def test_a_peer_that_fails_on_a_longer_motion_keeps_the_shorter_ones():
    def solve(t):
        if t > 10.0:
            raise RuntimeError("too many steps")
        return CUSPS.task.start.orientation

    peer = Peer("a peer", (1.0,), lambda *_: Solution(solve, None))
    results = Results(curves=[curve("a peer", "cusps", 1e-3)])
    _lengthen(peer, CUSPS, SMALL, results)
    assert [each.times for each in results.growth] == [(10.0,)]


def test_models_are_built_when_a_step_runs_and_not_when_it_is_listed():
    def fail(*_):
        raise AssertionError

    peer = Peer("a peer", (1.0,), fail, "also", fail, quick="every motion")
    names = [name for name, _ in list_steps(SMALL, [peer], Results())]
    works = ("model", "cusps", "cusps with friction", "long times", "arrays")
    assert names[:6] == ["footprint", *(f"a peer: {work}" for work in works)]


def test_a_quick_report_leaves_out_peers_that_take_too_long():
    peers = [Peer(quick, (1.0,), None, quick=quick) for quick in ("no", FIRST, "every motion")]
    names = [name for name, _ in list_steps(QUICK, peers, Results())]
    motions = [problem.name for problem in Reference.read().article[:9]]
    for peer, swept in zip(peers, ([], motions[:1], motions), strict=True):
        assert [name for name in motions if f"{peer.name}: {name}" in names] == swept
    full = {name for name, _ in list_steps(FULL, peers, Results())}
    assert {f"no: {name}" for name in motions} <= full
