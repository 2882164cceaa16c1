"""Questions of textbooks that top_ctl solves, typed, and their published answers."""

import itertools
import json
import math
import re
import subprocess

import pytest
from programs import PATIENT, running_node

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import Top, solve_start
from symtop_ros.ros.client.body import make_body
from symtop_ros.ros.client.main import main
from workshop.load.domains import share_domain

DOMAIN = share_domain()

pytestmark = pytest.mark.usefixtures("signals_as_before")


@pytest.fixture
def ctl(capsys, monkeypatch):
    """A function that runs a command of top_ctl in this process."""
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))

    def call(words):
        given = words.split()
        return subprocess.CompletedProcess(given, main([*PATIENT, *given]), *capsys.readouterr())

    return call


@pytest.fixture(scope="module", autouse=True)
def node():
    with running_node(DOMAIN, "scene:=cusps"):
        yield


def read(ctl):
    return json.loads(ctl("state --json").stdout)


# What is typed, and the time of one turn in s that follows, with the digits that are published.
TURNS = [
    ("body disc:170g,5.5cm,10.5cm", "start theta=90deg psi_dot=45rev/s precession=slow", 2.61),
    ("body disc:170g,11cm,21cm", "start theta=90deg psi_dot=45rev/s precession=slow", 5.22),
    ("body bicycle_wheel", "start theta=90deg psi_dot=418rpm precession=slow", 57.6),
    ("body balanced_gyroscope", "start theta=90deg psi_dot=200rpm precession=slow", 15.3),
    ("body balanced_gyroscope", "start theta=90deg psi_dot=320rpm precession=slow", 24.5),
]


@pytest.mark.parametrize(("body", "start", "turn"), TURNS)
def test_a_class_asks_for_the_time_of_a_turn(ctl, body, start, turn):
    assert ctl(body).returncode == 0
    assert ctl(start).returncode == 0
    assert read(ctl)["precession_period"] == pytest.approx(turn, rel=3e-3)


@pytest.mark.slow
def test_a_class_asks_for_the_spin(ctl):
    answer = ctl("body point:165g,4cm Ix=4e-4 Iz=1.2e-4 gravity=9.80")
    assert "weight 1.617 N\n" in answer.stdout
    answer = ctl("start theta=90deg precession_period=2.20s")
    assert "psi' = 188.726 rad/s (1802.2 rpm)" in answer.stdout
    assert read(ctl)["seen_from_above"] == "counterclockwise"
    assert ctl("start theta=90deg precession_period=2.20s solution=2").returncode == 0
    assert read(ctl)["seen_from_above"] == "clockwise"


def test_an_answer_says_how_far_the_start_moves_for_the_last_digits_that_were_typed(ctl):
    assert ctl("body bicycle_wheel").returncode == 0
    wheel = Top(**read(ctl)["top"])
    answer = ctl("start theta=90.0deg precession_period=57.6s").stdout
    found = re.search(
        r"Within the rounding of the typed digits: .*psi' (\S+) to (\S+) rad/s\. \[event \d+\]\n$",
        answer,
    )
    tilts = (math.pi / 180 * each for each in (89.95, 90.05))
    corners = [
        solve_start(wheel, theta=theta, precession_period=period)[0].psi_dot
        for theta, period in itertools.product(tilts, (57.55, 57.65))
    ]
    low, high = map(float, found.groups())
    width = max(corners) - min(corners)
    assert min(corners) - width / 10 <= low <= min(corners)
    assert max(corners) <= high <= max(corners) + width / 10


@pytest.mark.slow
def test_what_has_no_last_digit_is_not_said_to_move(ctl):
    assert "last digits" not in ctl("start theta=0.5 psi_dot=200").stdout  # no question
    assert ctl("body point:165g,4cm Ix=4e-4 Iz=1.2e-4").returncode == 0
    top = Top(**read(ctl)["top"])
    least = 2 * math.sqrt((top.Ix - top.Iz) * math.cos(0.5) * top.Mgl) / top.Iz
    typed = math.ceil(10 * least) / 10  # half a unit of its last digit below there is no start
    answer = ctl(f"start theta=0.5 psi_dot={typed:.1f} solution=1").stdout
    assert re.search(r"there may be more or fewer such starts\. \[event \d+\]\n$", answer)


def test_the_mass_and_the_gravity_of_a_body_are_kept(ctl):
    assert ctl("body disc:1.7kg,12.7cm,14.1cm point:0.9kg,-25.3cm gravity=9.80").returncode == 0
    found = read(ctl)
    assert (found["pivot_force_of_mass"], found["mass_is_assumed"]) == (1.7 + 0.9, False)
    assert found["gravity"] == 9.80
    # Little but the weight of a balanced body acts on its pivot.
    assert found["pivot_force"][2] == pytest.approx(2.6 * 9.80, rel=0.1)


def test_all_solutions_are_listed_and_one_is_started(ctl):
    answer = ctl("start theta=90deg dip=0.1rad phi=1 solution=2")
    assert "Solution 2 of 2 for Ix = 0.0" in answer.stdout
    assert answer.stdout.index("(1) theta = ") < answer.stdout.index("(2) theta = ")
    assert ctl("pause").returncode == 0
    state = read(ctl)
    assert state["constants"]["L_z"] < 0
    low, high = state["turning_angles"]
    assert high - low == pytest.approx(0.1, rel=1e-12)
    assert ctl("resume").returncode == 0


@pytest.mark.parametrize(
    ("words", "refusal"),
    [
        ("start theta=90deg dip=0.1 solution=3", "solution must be 1 to 2, got 3"),
        ("start theta=90deg dip=3", "dip must be > 0 and at most 1.57079632679489"),
        ("start dip=3", "a start must have one of theta, precession_period / theta, psi_dot / "),
        (
            "start theta=60deg dip=5deg phi_dot=3",
            "phi_dot must be given without dip, got both",
        ),
        (
            "start theta=0.5 precession_period=2s phi_dot=0",
            "phi_dot must be given without precession_period, got both",
        ),
        (
            "start theta=0.5 dip=0.1 precession=slow",
            "precession must be given without dip, got both",
        ),
        ("start theta=9rpm", "theta must be a number in rad, °, deg or degrees, got '9rpm'"),
        ("body wheel", "part must be KIND:MASS,SIZE,DISTANCE (KIND: rod, hoop, disc, ball), "),
        ("body disk:170g,5cm,9cm", "part must be KIND:MASS,SIZE,DISTANCE (KIND: rod, "),
        ("body disc:1kg,0,1m", "radius must be > 0 m, got 0"),
        ("body point:1kg,1m", "Ix must be > 0 kg m^2, got 0"),
        (
            "body hoop gravity=9.8 gravity=9.7",
            "gravity must be given once, got 2 values",
        ),
        ("body hoop mass=3", "name must be one of gravity, Ix, Iz, got 'mass'"),
    ],
)
def test_what_has_no_answer_is_refused_in_one_line_and_the_top_goes_on(ctl, words, refusal):
    before = read(ctl)["top"]
    result = ctl(words)
    assert result.returncode == 1
    assert result.stderr.startswith(f"top_ctl: {refusal}")
    assert result.stderr.count("\n") == 1
    assert read(ctl)["top"] == before


def test_parts_are_added_and_measured_moments_replace_theirs():
    both = make_body(["disc:1kg,20cm,0.5m", "point:500g,-1m"])
    assert (both.mass, both.arm) == (1.5, 0.0)
    assert both.top.Ix == pytest.approx(0.25 * 0.04 + 0.25 + 0.5, rel=1e-15)
    assert make_body(["point:1kg,10cm", "Ix=3", "Iz=2", "gravity=10"]).top.moments == (3, 2, 1)
    with pytest.raises(RefusedError, match="parts must be at least one, got none"):
        make_body(["gravity=9.8"])
