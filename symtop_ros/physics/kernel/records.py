"""Enums, records and functions of symtop.h, for ctypes.

Written by `python -m workshop.twins`: change the header, and not this file.
"""

from ctypes import (
    POINTER,
    Structure,
    c_char_p,
    c_double,
    c_int,
    c_int64,
    c_size_t,
    c_uint,
    c_uint8,
    c_void_p,
)
from typing import Any, ClassVar, Literal, get_args

FrictionKind = Literal["axial", "transverse"]
FRICTION_KINDS: tuple[FrictionKind, ...] = get_args(FrictionKind)

# symtop_status
OK = 0
NO_MEMORY = 1
BAD_TOP = 2
BAD_ORIENTATION = 3
BAD_ANGULAR_VELOCITY = 4
BAD_FRICTION = 5
BAD_TORQUE = 6
BAD_TIME = 7
TOO_FAR = 8
TOO_FAST = 9
TOO_STIFF = 10
MORE_STEPS = 11
BAD_ARITHMETIC = 12
BAD_ANGLES = 13
BAD_KICK = 14
VERTICAL = 15
TOO_LONG = 16
BAD_POINTER = 17
BAD_COUNT = 18
BAD_HOLD = 19
BAD_KICK_KIND = 20
BAD_RATE = 21
BAD_STEPS = 22
BAD_DISC = 23
BAD_PUSHES = 24
BAD_CLAMP = 25
BAD_QUESTION = 26
BAD_PART = 27
BAD_TOLERANCE = 28

Kind = Literal[
    "regular",
    "unidirectional",
    "cusps",
    "looping",
    "through the pole",
    "asymptotic",
    "sleeping",
    "driven",
    "clamped",
]
KINDS: tuple[Kind, ...] = get_args(Kind)

Engine = Literal["closed form", "free", "taylor"]
ENGINES: tuple[Engine, ...] = get_args(Engine)

PartKind = Literal["point", "rod", "hoop", "disc", "ball"]
PART_KINDS: tuple[PartKind, ...] = get_args(PartKind)

Hold = Literal["spin_rate", "spin_momentum"]
HOLDS: tuple[Hold | None, ...] = ("spin_rate", "spin_momentum", None)

Question = Literal[
    "theta precession_period",
    "theta psi_dot",
    "psi_dot precession_period",
    "theta dip",
    "theta nutation_period",
    "energy p_phi p_psi",
    "alpha a b",
]
QUESTIONS: tuple[Question, ...] = get_args(Question)

Demand = Literal[
    "finite",
    "between",
    "positive",
    "least",
    "size",
    "regular",
    "unequal",
    "weight",
    "rates",
    "spin",
    "range",
]
DEMANDS: tuple[Demand | None, ...] = (
    None,
    "finite",
    "between",
    "positive",
    "least",
    "size",
    "regular",
    "unequal",
    "weight",
    "rates",
    "spin",
    "range",
)

KickKind = Literal["rate", "change", "factor", "impulse", "axle"]
KICK_KINDS: tuple[KickKind, ...] = get_args(KickKind)

Subject = Literal["top", "axis"]
SUBJECTS: tuple[Subject, ...] = get_args(Subject)

Direction = Literal["rises", "falls", "stays"]
DIRECTIONS: tuple[Direction, ...] = get_args(Direction)

Rule = Literal["holds", "fails"]
RULES: tuple[Rule | None, ...] = (None, "holds", "fails")

PlaceKind = Literal["none", "only", "above", "below", "slow", "fast", "between", "outside", "every"]
PLACE_KINDS: tuple[PlaceKind, ...] = get_args(PlaceKind)

ReasonKind = Literal[
    "hurried",
    "delayed",
    "if_hurried",
    "if_delayed",
    "angular_impulse",
    "no_precession",
    "unchanged",
    "reversed",
    "no_effect",
    "weightless",
    "undefined",
    "stable",
    "unstable",
]
REASON_KINDS: tuple[ReasonKind, ...] = get_args(ReasonKind)

Effect = Literal["up", "down"]
EFFECTS: tuple[Effect | None, ...] = (None, "up", "down")

Explanation = Literal[
    "fixed",
    "free",
    "upright",
    "steady",
    "plane",
    "no_spin",
    "about_momentum",
    "with_momentum",
    "circles",
    "swings",
]
EXPLANATIONS: tuple[Explanation | None, ...] = (
    None,
    "fixed",
    "free",
    "upright",
    "steady",
    "plane",
    "no_spin",
    "about_momentum",
    "with_momentum",
    "circles",
    "swings",
)

Turn = Literal["faster", "slower", "rests", "vertical", "against"]
TURNS: tuple[Turn | None, ...] = (None, "faster", "slower", "rests", "vertical", "against")

Pace = Literal["speeds", "slows"]
PACES: tuple[Pace | None, ...] = (None, "speeds", "slows")

Part = Literal["size", "direction", "tilt"]
PARTS: tuple[Part, ...] = get_args(Part)

LiftKind = Literal["unchanged", "higher", "lower"]
LIFT_KINDS: tuple[LiftKind, ...] = get_args(LiftKind)

Sense = Literal["along", "against"]
SENSES: tuple[Sense | None, ...] = (None, "along", "against")

HeldKind = Literal["falls", "swings", "rises", "turns", "rests"]
HELD_KINDS: tuple[HeldKind, ...] = get_args(HeldKind)

Going = Literal["falls", "rises", "turns_up", "turns_down"]
GOINGS: tuple[Going | None, ...] = (None, "falls", "rises", "turns_up", "turns_down")


class StartRecord(Structure):
    """`symtop_start`."""

    _fields_: ClassVar = [
        ("Ix", c_double),
        ("Iz", c_double),
        ("Mgl", c_double),
        ("orientation", c_double * 4),
        ("angular_velocity", c_double * 3),
        ("friction", c_double * 2),
        ("torque", c_double * 3),
    ]


class PushesRecord(Structure):
    """`symtop_pushes`."""

    _fields_: ClassVar = [("impulse", c_double), ("rate", c_double), ("number", c_double)]


class ClockRecord(Structure):
    """`symtop_clock`."""

    _fields_: ClassVar = [("factor", c_double), ("elapsed", c_double * 4)]


class PieceRecord(Structure):
    """`symtop_piece`."""

    _fields_: ClassVar = [("start", StartRecord), ("begin", c_double), ("number", c_double)]


class RatesRecord(Structure):
    """`symtop_rates`."""

    _fields_: ClassVar = [
        ("nutation_period", c_double),
        ("mean_precession_rate", c_double),
        ("mean_spin_rate", c_double),
        ("precession_per_nutation", c_double),
        ("mean_cosine", c_double),
        ("spin_reverses", c_int),
    ]


class ConstantsRecord(Structure):
    """`symtop_constants`."""

    _fields_: ClassVar = [
        ("kind", c_int),
        ("engine", c_int),
        ("turning_angles", c_double * 2),
        ("rates", RatesRecord),
    ]


class TopRecord(Structure):
    """`symtop_top`."""

    _fields_: ClassVar = [("Ix", c_double), ("Iz", c_double), ("Mgl", c_double)]


class PartOfBodyRecord(Structure):
    """`symtop_part_of_body`."""

    _fields_: ClassVar = [("mass", c_double), ("size", c_double), ("distance", c_double)]


class BodyRecord(Structure):
    """`symtop_body`."""

    _fields_: ClassVar = [("mass", c_double), ("arm", c_double), ("Ix", c_double), ("Iz", c_double)]


class SolutionRecord(Structure):
    """`symtop_solution`."""

    _fields_: ClassVar = [
        ("theta", c_double),
        ("theta_dot", c_double),
        ("phi_dot", c_double),
        ("psi_dot", c_double),
    ]


class SolutionsRecord(Structure):
    """`symtop_solutions`."""

    _fields_: ClassVar = [
        ("demand", c_int),
        ("which", c_double),
        ("least", c_double),
        ("most", c_double),
        ("number", c_double),
        ("each", SolutionRecord * 4),
    ]


class SpreadsRecord(Structure):
    """`symtop_spreads`."""

    _fields_: ClassVar = [("least", SolutionRecord * 4), ("most", SolutionRecord * 4)]


class PlaceRecord(Structure):
    """`symtop_place`."""

    _fields_: ClassVar = [("kind", c_int), ("rate", c_double), ("regular_rates", c_double * 2)]


class ReasonRecord(Structure):
    """`symtop_reason`."""

    _fields_: ClassVar = [
        ("kind", c_int),
        ("rule", c_int),
        ("before", c_double),
        ("after", c_double),
        ("theta_ddot_without", c_double),
        ("theta_ddot", c_double),
        ("effect", c_int),
        ("place", PlaceRecord),
    ]


class AverageRecord(Structure):
    """`symtop_average`."""

    _fields_: ClassVar = [
        ("rate", c_double),
        ("precession_period", c_double),
        ("turns", c_double),
        ("fast_top_rate", c_double),
        ("is_fast", c_int),
        ("spin_reverses", c_int),
    ]


class CauseRecord(Structure):
    """`symtop_cause`."""

    _fields_: ClassVar = [
        ("explanation", c_int),
        ("turn", c_int),
        ("pace", c_int),
        ("torque_share", c_double),
        ("rate_about_momentum", c_double),
        ("torque_from_perpendicular", c_double * 2),
        ("momentum_from_axle", c_double * 3),
        ("omega_from_axle", c_double * 3),
        ("momentum_from_vertical", c_double * 3),
        ("constant", c_uint),
    ]


class LiftRecord(Structure):
    """`symtop_lift`."""

    _fields_: ClassVar = [("kind", c_int), ("amount", c_double)]


class MeansRecord(Structure):
    """`symtop_means`."""

    _fields_: ClassVar = [
        ("sense", c_int),
        ("height", c_int),
        ("rates", c_double * 2),
        ("cosines", c_double * 2),
    ]


class VerdictRecord(Structure):
    """`symtop_verdict`."""

    _fields_: ClassVar = [
        ("subject", c_int),
        ("direction", c_int),
        ("turning_angles", c_double * 2),
        ("motion", c_int),
        ("reason", ReasonRecord),
        ("average", AverageRecord),
        ("cause", CauseRecord),
        ("factor", c_double),
        ("means", MeansRecord),
        ("disturbed_to", c_double),
        ("highest", LiftRecord),
        ("lowest", LiftRecord),
    ]


class HeldRecord(Structure):
    """`symtop_held`."""

    _fields_: ClassVar = [
        ("kind", c_int),
        ("subject", c_int),
        ("theta", c_double),
        ("rate", c_double),
        ("lowest_in", c_double),
        ("angles_without", c_double * 2),
    ]


class PresentRecord(Structure):
    """`symtop_present`."""

    _fields_: ClassVar = [("going", c_int), ("turn", c_int), ("torque_share", c_double)]


class EnergiesRecord(Structure):
    """`symtop_energies`."""

    _fields_: ClassVar = [
        ("weight", c_double),
        ("precession", c_double),
        ("nutation", c_double),
        ("spin", c_double),
    ]


class ExchangeRecord(Structure):
    """`symtop_exchange`."""

    _fields_: ClassVar = [
        ("gained", EnergiesRecord),
        ("first", EnergiesRecord),
        ("last", EnergiesRecord),
        ("sizes", EnergiesRecord),
        ("momentum_size", c_double),
        ("height", c_double),
        ("mean_along", c_double),
        ("last_sine", c_double),
    ]


RECORDS: tuple[type[Structure], ...] = (
    StartRecord,
    PushesRecord,
    ClockRecord,
    PieceRecord,
    RatesRecord,
    ConstantsRecord,
    TopRecord,
    PartOfBodyRecord,
    BodyRecord,
    SolutionRecord,
    SolutionsRecord,
    SpreadsRecord,
    PlaceRecord,
    ReasonRecord,
    AverageRecord,
    CauseRecord,
    LiftRecord,
    MeansRecord,
    VerdictRecord,
    HeldRecord,
    PresentRecord,
    EnergiesRecord,
    ExchangeRecord,
)

# The result and the arguments of each; an array that is read is given as bytes.
FUNCTIONS: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "version": (c_char_p, ()),
    "describe_status": (c_char_p, (c_int,)),
    "new": (c_int, (c_char_p, POINTER(c_void_p))),
    "new_pushed": (c_int, (c_char_p, c_char_p, POINTER(c_void_p))),
    "new_clamped": (c_int, (c_char_p, POINTER(c_void_p))),
    "new_coarse": (c_int, (c_char_p, c_double, POINTER(c_void_p))),
    "free": (None, (c_void_p,)),
    "continue": (c_int, (c_void_p, c_double, c_char_p, POINTER(c_void_p))),
    "state": (c_int, (c_void_p, c_double, POINTER(c_double), POINTER(c_double))),
    "states": (
        c_int,
        (
            c_void_p,
            c_char_p,
            c_size_t,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_size_t),
        ),
    ),
    "states_of_clock": (
        c_int,
        (
            c_void_p,
            c_char_p,
            c_char_p,
            c_size_t,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_size_t),
        ),
    ),
    "find_piece": (c_int, (c_void_p, c_char_p, c_int64, c_double, POINTER(PieceRecord))),
    "reach": (c_int, (c_void_p, c_double, c_double, POINTER(c_double))),
    "find_kind": (c_int, (c_void_p,)),
    "find_turning_angles": (c_int, (c_void_p, POINTER(c_double))),
    "find_rates": (c_int, (c_void_p, POINTER(RatesRecord))),
    "find_farthest_time": (c_int, (c_void_p, POINTER(c_double))),
    "find_nutation_rate": (c_int, (c_void_p, POINTER(c_double))),
    "find_engine": (c_int, (c_void_p,)),
    "states_of_many": (
        c_int,
        (
            c_char_p,
            c_size_t,
            c_char_p,
            c_size_t,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_uint8),
        ),
    ),
    "describe_many": (c_int, (c_char_p, c_size_t, POINTER(ConstantsRecord), POINTER(c_size_t))),
    "normalize": (c_int, (c_char_p, c_char_p, c_size_t, POINTER(c_double), POINTER(c_double))),
    "from_angles": (
        c_int,
        (c_char_p, c_char_p, c_size_t, POINTER(c_double), POINTER(c_double), POINTER(c_size_t)),
    ),
    "find_angles": (c_int, (c_char_p, c_size_t, POINTER(c_double))),
    "find_angle_rates": (c_int, (c_char_p, c_char_p, c_size_t, POINTER(c_double))),
    "find_body": (c_int, (c_char_p, c_char_p, c_size_t, POINTER(BodyRecord), POINTER(c_size_t))),
    "find_body_top": (c_int, (c_char_p, c_double, POINTER(TopRecord))),
    "find_disc": (c_int, (c_char_p, c_double, POINTER(c_double))),
    "find_regular_rates": (
        c_int,
        (c_char_p, c_char_p, c_char_p, c_size_t, c_int, POINTER(c_double)),
    ),
    "find_tilt_torques": (
        c_int,
        (c_char_p, c_char_p, c_char_p, c_char_p, c_size_t, POINTER(c_double)),
    ),
    "find_tilt_accelerations": (c_int, (c_char_p, c_int, c_char_p, c_size_t, POINTER(c_double))),
    "solve_start": (c_int, (c_char_p, c_int, c_char_p, POINTER(SolutionsRecord))),
    "find_spreads": (c_int, (c_char_p, c_int, c_char_p, c_char_p, POINTER(SpreadsRecord))),
    "kick": (
        c_int,
        (
            c_char_p,
            c_char_p,
            c_char_p,
            c_int,
            c_int,
            c_char_p,
            c_size_t,
            POINTER(c_double),
            POINTER(c_size_t),
        ),
    ),
    "judge": (
        c_int,
        (c_char_p, c_char_p, c_size_t, c_int, POINTER(VerdictRecord), POINTER(c_size_t)),
    ),
    "compare_hurried": (
        c_int,
        (
            c_char_p,
            c_char_p,
            c_char_p,
            c_char_p,
            c_size_t,
            c_double,
            c_int,
            POINTER(c_double),
            POINTER(c_uint8),
        ),
    ),
    "judge_kick": (c_int, (c_char_p, c_char_p, c_int, POINTER(VerdictRecord))),
    "judge_clamp": (c_int, (c_char_p, POINTER(HeldRecord))),
    "explain_present": (c_int, (c_char_p, POINTER(PresentRecord))),
    "find_doubt": (c_int, (c_char_p, POINTER(c_double))),
    "find_exchange": (c_int, (c_char_p, c_char_p, c_char_p, POINTER(ExchangeRecord))),
    "make": (c_void_p, (c_char_p,)),
    "read": (c_int, (c_void_p, POINTER(c_double))),
    "check_arithmetic": (c_int, ()),
}
