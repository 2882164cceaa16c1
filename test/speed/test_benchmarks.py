from workshop.speed.benchmarks import (
    DrivenCase,
    Growth,
    HardCase,
    Results,
)
from workshop.speed.peers import CLOSED_FORM, TAYLOR
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
