"""Arguments that are refused, each in the words that say what must be given."""

import math
from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from physics.refusals import FINITE_ARRAY, NOT_TOO_LATE, refused
from physics.tops import ARTICLE, CUSPS

from symtop_ros.physics import (
    Body,
    EffectivePotential,
    ExactTimes,
    Friction,
    Motion,
    Motions,
    State,
    Top,
    apply_impulse,
    balance,
    compare_hurried,
    hurry,
    kick_verdict,
    perrys_rule,
    precessing_frame_torques,
    precession_rate,
    push_axle,
    regular_precession_rates,
    set_precession_rate,
    theta_acceleration,
    theta_torque,
)
from symtop_ros.physics.reference import exact_state

START = State.from_euler(theta=0.5, phi=0.3, psi=1.2, theta_dot=2.0, phi_dot=6.5, psi_dot=200.0)
MOTION = Motion(ARTICLE, CUSPS)
POTENTIAL = EffectivePotential.from_state(ARTICLE, CUSPS)
MANY = Motions(Top([1.0, 2.0], 1.0, 1.0), CUSPS)
DISC = {"mass": 1.0, "radius": 0.5, "distance": 0.25, "gravity": 9.81}
BODY = {"mass": 1.0, "arm": 0.1, "Ix": 1.0, "Iz": 1.0, "gravity": 9.81}
FINITE_NUMBER = "a finite number"
VECTOR = "3 finite numbers"
HOLD = "'spin_rate' or 'spin_momentum'"
TILTED = "tilted (phi' is undefined on the vertical; an angular impulse works there)"
NOT_TOO_FAST = "s of the start (the motion then becomes too fast)"
FIT = "of shapes that fit together"
EULER = "theta", "phi", "psi", "theta_dot", "phi_dot", "psi_dot"
SMALL = "so small that rates stay within 1e+100 rad/s"
ONE_MOTION = "one motion", "motions of shape (2,)"
ONE_STATE = "one state", "states of shape (2,)"
STAMP = "an int or an array (n,) of ints, of at most 63 bits (ns)"
ELAPSED = "a Fraction with a power of two as denominator (ns)"
ROTATION = "a rotation (orthogonal within 0.001, determinant 1)"
UNIT = (1, 0, 0, 0)
REST = (0, 0, 0)
NAN = math.nan
INF = math.inf
UPRIGHT = State(UNIT, (0, 0, 200.0))
HANGING = State((0, 1, 0, 0), (0, 0, 200.0))
BOTH = State([UNIT, (0, 1, 0, 0)], [REST] * 2)
TILTED_BY = partial(State.from_euler, theta=0.5)
TOO_LONG = "within ten million steps of integration (up to a minute) of what is reached"
LATE_DERIVATIVES = "s of the start for derivatives with friction or a torque"
RESOLVED = "a time at which double precision resolves the derivatives"
TOO_LATE = 1e17, -1e20, [1.0, 1e17], ExactTimes(2**63 - 1, 1e40)
THROWN_UP = State([0.5] * 4, (-2, 0, 0))
UNSTABLE = State(UNIT, (0, 0, 30))
OF_RATES = theta_torque, theta_acceleration, precessing_frame_torques
PUSHED = partial(Motion, ARTICLE, CUSPS)
RISING = Motion(Top(1, 1e-21, 0.0), CUSPS, torque=(1, 1, 1))  # turns too fast for all digits
DRAG = Friction(2e-6, 1e-5)
WEAK = Friction(1e-6)
TOO_FINE = [
    ExactTimes(np.array([10**8, 2 * 10**8]), elapsed=each)
    for each in (sum(Fraction(1, 2**n) for n in range(0, 400, 80)), Fraction(1, 2**400))
]
RATE_KICKS = hurry, precession_rate, partial(set_precession_rate, phi_dot=1.0)
NO_TURNS = [1.0, 1.0, -1.0], [2.0, 2.0, 2.0]
ODD = (NAN, INF, -INF)
NO_RATES = (1e200, NAN, [1.0, INF])
OF_ONE_TOP = (
    partial(MANY.top.sleeping_is_stable, CUSPS),
    partial(EffectivePotential.from_state, MANY.top, CUSPS),
    partial(Body.from_top, MANY.top),
)
NO_NUMBERS = "a", None, [1.0, NAN], True
NO_TIMES = "1", None, True, 1j, np.timedelta64(100, "ms"), 10**400
NO_HOLDS = None, "breath", "", 1
NO_STAMPS = 1.0, "1", True, None, 2**63, -(2**63), [0.5], [[1]], np.timedelta64(1, "ns"), [2**63]
NO_ELAPSED = 0.5, "1", True, Fraction(1, 3), None

TOPS = [
    *((partial(Top, x, 1.0, 1.0), "Ix", "> 0 kg m^2", f"{x:g}") for x in (0.0, -1.0)),
    *((partial(Top, 1.0, x, 1.0), "Iz", "> 0 and <= 2 Ix = 2 kg", f"{x:g}") for x in (0.0, 2.1)),
    (partial(Top, 1.0, 1.0, NAN), "Mgl", f"{FINITE_NUMBER} (J)", "nan"),
    (partial(Top, 10**400, 1.0, 1.0), "Ix", f"{FINITE_NUMBER} (kg m^2)", "1000000"),
    (partial(Top, 1.0, "1", 1.0), "Iz", f"{FINITE_NUMBER} (kg m^2)", "'1'"),
    (partial(Top, True, 1.0, 1.0), "Ix", f"{FINITE_NUMBER} (kg m^2)", "True"),
    (partial(Top, 1.0, 1.0, 1j), "Mgl", f"{FINITE_NUMBER} (J)", "1j"),
    (partial(Top, 1e101, 1e101, 1.0), "Ix", "1e-100 to 1e+100 kg m^2", "1e+101"),
    (partial(Top, 1.0, 1e-101, 1.0), "Iz", "1e-100 to 1e+100 kg m^2", "1e-101"),
    (partial(Top, 1.0, 1.0, -1e101), "Mgl", "at most 1e+100 J in size", "-1e+101"),
    (partial(Top, [1.0, -1.0], 1.0, 1.0), "Ix", "> 0 kg m^2"),
    (partial(Top, 1.0, [1.0, 3.0], 1.0), "Iz", "> 0 and <= 2 Ix = 2 kg m^2"),
    (partial(Top, [1.0, 2.0], [1.0] * 3, 1.0), "Ix and Iz", FIT),
    (partial(Top, 1.0, 1.0, [1.0, NAN]), "Mgl", f"{FINITE_ARRAY} (J)"),
    (partial(Top(1.0, 1.0, REST).energy, MANY.at(REST)), "top and state", "one of each for each"),
    *((call, "top", "one top", "tops of shape (2,)") for call in OF_ONE_TOP),
    (partial(Friction, -1), "friction.axial", ">= 0 N m s", "-1"),
    (partial(Friction, 0.0, NAN), "friction.transverse", f"{FINITE_NUMBER} (N m s)", "nan"),
    (partial(Friction, "1"), "friction.axial", f"{FINITE_NUMBER} (N m s)", "'1'"),
    (partial(Friction, 0.0, True), "friction.transverse", f"{FINITE_NUMBER} (N m s)", "True"),
]
BODIES = [
    (
        partial(Body.from_top, Top(1.0, 2.0, -0.5)),
        "Iz",
        "< 2 Ix = 2 kg m^2 for a body with Mgl = -0.5",
    ),
    (partial(Body.from_top, ARTICLE, 0.0), "gravity", "> 0 m/s^2", "0"),
    (partial(Body.from_top, ARTICLE, NAN), "gravity", FINITE_NUMBER),
    (partial(Body.from_top, Top(1.0, 1.0, 5e-324)), "Mgl", "of a size for which the mass"),
    (partial(Body, **{**BODY, "mass": -1.0}), "mass", "> 0 kg"),
    (partial(Body, **{**BODY, "arm": NAN}), "arm", "a finite number (m)"),
    (partial(Body, **{**BODY, "Iz": 2.5}), "Iz", "<= 2 Ix = 2 kg m^2"),
    (partial(Body, **{**BODY, "gravity": 0.0}), "gravity", "> 0 m/s^2"),
    (partial(Body.from_pivot_moments, 15.0, 1.0, 15.0, 0.5), "Ix", "> mass arm^2 = 15 kg m^2"),
    (partial(Body.from_pivot_moments, 1.0, 1e200, 1.0, 1.0), "Ix", "> mass arm^2 = inf kg m^2"),
    *(
        (partial(Body.from_disc, **{**DISC, n: 0.0}), n, "> 0")
        for n in ("mass", "radius", "gravity")
    ),
    (partial(Body(**BODY).pivot_force, MOTION, CUSPS), "motion.top", ", that of the body", "Top"),
]
STATES = [
    (partial(State, (1, 0, 0, 0, 0), REST), "orientation", "of shape (..., 4)", "shape (5,)"),
    (partial(State, UNIT, (0, 0)), "angular_velocity", "of shape (..., 3)", "shape (2,)"),
    (partial(State, (1, 0, 0, NAN), REST), "orientation", FINITE_ARRAY, "nan at [3]"),
    (partial(State, UNIT, (0, INF, 0)), "angular_velocity", FINITE_ARRAY, "inf at [1]"),
    (partial(State, (1, 0, 0, 0.1), REST), "orientation", "norm 1 within 0.001", "a norm of 1.00"),
    (partial(State, ("a", 0, 0, 0), REST), "orientation", FINITE_ARRAY, "('a', 0, 0, 0)"),
    (partial(State, UNIT, (0, 0, 1e200)), "angular_velocity", "at most 1e+100 rad/s", "1e+200"),
    (partial(State, [UNIT], REST), "angular_velocity", "of shape (1, 3) to match", "shape (3,)"),
    *((partial(TILTED_BY, **{n: NAN}), n, FINITE_NUMBER, "nan") for n in EULER[1:]),
    (partial(State.from_euler, theta=NAN), "theta", FINITE_NUMBER, "nan"),
    (partial(State.from_euler, theta=[0.4, 0.5], phi=[1, 2, 3]), "phi and theta", FIT),
    *((partial(State.from_matrix, np.diag(x), REST), "matrix", ROTATION) for x in NO_TURNS),
    (partial(State.from_matrix, (1.0, 0.0, 0.0), REST), "matrix", "of shape (..., 3, 3)"),
]
MOTIONS = [
    (partial(Motion, ARTICLE.moments, CUSPS), "top", "a Top"),
    (partial(Motion, ARTICLE, CUSPS._parts), "start", "a State"),
    (partial(Motion, ARTICLE, CUSPS, 2e-6), "friction", "a Friction"),
    *((partial(PUSHED, torque=each), "torque", VECTOR) for each in ([1, 2], "abc", [0, 0, INF])),
    (partial(Motions, MANY.top, MANY.at(REST)), "top, start, friction and torque", FIT),
    *((partial(MOTION.at, t), "t", f"{FINITE_ARRAY} (s)") for t in (NAN, INF, -INF, [0.0, NAN])),
    *((partial(MOTION.at, t), "t", f"{FINITE_ARRAY} (s)", repr(t)[:40]) for t in NO_TIMES),
    *((partial(MOTION._reach, t, 10), "t", "number") for t in (NAN, INF, "1")),
    (partial(MOTION._reach, 1.0, NAN), "steps", ">= 0", "nan"),
    (partial(MOTION.restart, MANY.at(0.0)), "start", *ONE_STATE),
    (partial(MOTION.restart, 3), "start", "one state", "3"),
    *((partial(PUSHED(torque=(0, 0, x)).at, 1.0), "t", NOT_TOO_FAST, "1") for x in (1e300, 1e308)),
    (partial(MOTION.jacobian, NAN), "t", FINITE_ARRAY),
    *((partial(MOTION.at, t), "t", NOT_TOO_LATE) for t in TOO_LATE),
    (partial(MANY.at, [0.1, 1e17]), "t", NOT_TOO_LATE),
    *((partial(PUSHED(DRAG).at, each), "elapsed", "a sum of four doubles") for each in TOO_FINE),
    (partial(RISING.at, [1e-3, 1.0]), "t", NOT_TOO_FAST),
    (partial(PUSHED(DRAG).jacobian, 1e5), "t", LATE_DERIVATIVES, "100000"),
    (partial(PUSHED(DRAG).jacobian, [1.0, -1e6]), "t", LATE_DERIVATIVES, "-1000000"),
    *((partial(PUSHED(WEAK).at, t), "t", TOO_LONG, f"{t:.0f}") for t in (-1e6, 1e6)),
    (partial(PUSHED(WEAK).at, ExactTimes(-(10**15))), "t", TOO_LONG, "-1000000"),
    (partial(PUSHED(WEAK).at, [1.0, -1e6]), "t", TOO_LONG, "-1000000"),
    (partial(Motion(Top(1.0, 0.5, 2.0), THROWN_UP).jacobian, 1e9), "t", RESOLVED),
    (partial(Motion(ARTICLE, UNSTABLE).jacobian, 1e5), "t", RESOLVED),
    *((partial(balance, MOTION, 2.0, wrong), "longest", "> 0 s") for wrong in (0.0, -1.0)),
    (partial(balance, MANY, 1.0, 1.0), "motion", *ONE_MOTION),
    *((partial(POTENTIAL.at, each), "theta", FINITE_ARRAY) for each in NO_NUMBERS),
    *((partial(POTENTIAL.cubic, each), "u", FINITE_ARRAY) for each in NO_NUMBERS),
]
KICKS = [
    (partial(hurry, START, NAN), "factor", FINITE_NUMBER, "nan"),
    (partial(set_precession_rate, START, INF), "phi_dot", FINITE_NUMBER, "inf"),
    (partial(apply_impulse, ARTICLE, START, [1.0, 2.0]), "impulse", VECTOR, "[1.0, 2.0]"),
    (partial(apply_impulse, ARTICLE, CUSPS, (1e305, 0.0, 0.0)), "impulse", SMALL, "1e+305"),
    (partial(push_axle, ARTICLE, START, 1e305), "impulse", SMALL, "1e+305"),
    (partial(push_axle, ARTICLE, UPRIGHT, 1.0), "axis", TILTED, "theta = "),
    *((partial(f, x), "axis", TILTED, "theta = ") for f in RATE_KICKS for x in (UPRIGHT, HANGING)),
    (partial(hurry, BOTH[::-1]), "axis", TILTED, "theta = 3.14159 rad"),
    (partial(hurry, MANY.at(0.0), (1, 2, 3)), "state and kick", FIT, "(2,) and (3,)"),
    (partial(push_axle, MANY.top, CUSPS, [1, 2, 3]), "state and kick", FIT, "(2,) and (3,)"),
    *((partial(hurry, START, hold=each), "hold", HOLD) for each in NO_HOLDS),
    *((partial(set_precession_rate, START, 9.0, each), "hold", HOLD) for each in NO_HOLDS),
    *((partial(perrys_rule, ARTICLE, START, 1.4, each), "hold", HOLD) for each in NO_HOLDS),
    *((partial(compare_hurried, ARTICLE, 1, 6, 90, 2, each), "hold", HOLD) for each in NO_HOLDS),
    *((partial(kick_verdict, MOTION, START, each), "hold", HOLD) for each in NO_HOLDS[1:]),
    (partial(kick_verdict, MANY, CUSPS, "spin_rate"), "motion", *ONE_MOTION),
    (partial(kick_verdict, MOTION, MANY.at(0.0), "spin_rate"), "before", *ONE_STATE),
    *((partial(perrys_rule, ARTICLE, START, x), "factor", FINITE_NUMBER, str(x)) for x in ODD),
    (partial(perrys_rule, ARTICLE, START, 1e200), "factor", "phi' stays within 1e+100", "1e+200"),
    *((partial(f, ARTICLE, 0.5, x, 200.0), "phi_dot", "") for f in OF_RATES for x in NO_RATES),
    (partial(compare_hurried, ARTICLE, 0.5, 1e200, 1.0), "phi_dot", "at most 1e+100", "1e+200"),
    (partial(perrys_rule, MANY.top, CUSPS, (1, 2, 3)), "top, state and factor", FIT),
    *((partial(regular_precession_rates, ARTICLE, x, 1), "theta", FINITE_NUMBER) for x in ODD),
    *((partial(regular_precession_rates, ARTICLE, 0.5, x), "psi_dot", FINITE_NUMBER) for x in ODD),
]
TIMES = [
    *((partial(ExactTimes, wrong), "nanoseconds", STAMP) for wrong in NO_STAMPS),
    *((partial(ExactTimes, 0, 1.0, each), "elapsed", ELAPSED) for each in NO_ELAPSED),
    *((partial(ExactTimes, 0, x), "factor", "1e-100 to 1e+100", f"{x:g}") for x in (0.0, -1.0)),
    (partial(ExactTimes, 0, NAN), "factor", FINITE_NUMBER),
    (partial(ExactTimes, 0, "1"), "factor", FINITE_NUMBER),
    (partial(exact_state, ARTICLE, CUSPS, NAN), "t", "a finite number", "nan s"),
    (partial(exact_state, ARTICLE, CUSPS, 1.0, 0), "digits", "1 or more", "0"),
    (partial(exact_state, MANY.top, CUSPS, 1.0), "top and start", "those of one motion"),
]


@pytest.mark.parametrize("refusal", [*TOPS, *BODIES, *STATES, *MOTIONS, *KICKS, *TIMES])
def test_what_cannot_be_is_refused_in_words(refusal):
    call, *words = refusal
    with refused(*words):
        call()
