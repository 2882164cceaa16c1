"""Every public call with one and with many of each argument: an answer of that shape, or a refusal.

A refusal is a ValueError that names the argument. Which arguments may be many is said here once,
for each call.
"""

import inspect
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import numpy as np
import pytest
from physics.tops import ARTICLE

from symtop_ros import physics
from symtop_ros.physics import (
    Body,
    EffectivePotential,
    ExactTimes,
    Friction,
    Ledger,
    Motion,
    Motions,
    Part,
    Pushes,
    State,
    Top,
)

COUNT = 3
TOPS = Top(*ARTICLE.moments[:2], [0.05, 0.068, 0.08])
STATES = State.from_euler(theta=[0.4, 0.5, 0.6], phi_dot=3.0, psi_dot=200.0)
STATE = STATES[1]
UPRIGHT = State((1, 0, 0, 0), (0, 0, 200.0))
UPRIGHTS = State([(1, 0, 0, 0)] * COUNT, [(0, 0, 200.0)] * COUNT)
MOTION, MOTIONS = Motion(ARTICLE, STATE), Motions(TOPS, STATE)
PUSHED = Motion(ARTICLE, STATE, pushes=Pushes(5e-5, 20.0, 3))
POTENTIAL = EffectivePotential.from_state(ARTICLE, STATE)
BODY = Body.from_top(ARTICLE)
FRICTIONS = Friction(axial=[1e-6, 2e-6, 3e-6])


@dataclass(frozen=True)
class Given:
    """An argument: one, many, and whether the call takes many."""

    one: Any
    many: Any
    takes_many: bool
    refused_as: str = ""  # the name in the message, if it is another


def takes(one: Any, many: Any = None) -> Given:
    return Given(one, repeat(one) if many is None else many, True)


def refuses(one: Any, many: Any = None, refused_as: str = "") -> Given:
    return Given(one, repeat(one) if many is None else many, False, refused_as)


def repeat(one: Any) -> Any:
    return np.array([one] * COUNT)


TOP, ONE_TOP = takes(ARTICLE, TOPS), refuses(ARTICLE, TOPS)
OF_STATES, ONE_STATE = takes(STATE, STATES), refuses(STATE, STATES)
ONE_MOTION = refuses(MOTION, MOTIONS)
TILT, RATE, SPIN, FACTOR = takes(0.5), takes(9.0), takes(200.0), takes(1.4)
RATES = {"theta": TILT, "phi_dot": RATE, "psi_dot": SPIN}
VECTOR, ONE_VECTOR = takes((0.0, 0.0, 1e-4)), refuses((0.0, 0.0, 1e-4))
TIME = takes(0.25)
KG, METRE, MOMENT, WEIGHT, GRAVITY = (refuses(x) for x in (0.5, 0.1, 1e-2, 9.81, 9.81))

# Each call, and its arguments.
CALLS: dict[str, tuple[Callable[..., Any], dict[str, Given]]] = {
    "angular_acceleration": (
        physics.angular_acceleration,
        {"motion": ONE_MOTION, "state": OF_STATES},
    ),
    "apply_impulse": (physics.apply_impulse, {"top": TOP, "state": OF_STATES, "impulse": VECTOR}),
    "balance": (
        physics.balance,
        {"motion": ONE_MOTION, "end": refuses(1.0), "longest": refuses(0.5)},
    ),
    "clamp_verdict": (physics.clamp_verdict, {"top": ONE_TOP, "before": ONE_STATE}),
    "compare_hurried": (physics.compare_hurried, {"top": TOP, **RATES, "factor": refuses(1.4)}),
    "find_period": (physics.find_period, {"rate": RATE}),
    "gimbal_shares": (physics.gimbal_shares, {"torque": VECTOR}),
    "hurry": (physics.hurry, {"state": OF_STATES, "factor": FACTOR}),
    "kick_verdict": (
        physics.kick_verdict,
        {"motion": ONE_MOTION, "before": ONE_STATE, "hold": refuses("spin_rate")},
    ),
    "perrys_rule": (physics.perrys_rule, {"top": TOP, "state": OF_STATES, "factor": FACTOR}),
    "point_acceleration": (
        physics.point_acceleration,
        {"motion": ONE_MOTION, "state": OF_STATES, "position": ONE_VECTOR},
    ),
    "precessing_frame_torques": (physics.precessing_frame_torques, {"top": TOP, **RATES}),
    "precession_rate": (physics.precession_rate, {"state": OF_STATES}),
    "push_axle": (physics.push_axle, {"top": TOP, "state": OF_STATES, "impulse": takes(1e-5)}),
    "regular_precession_rates": (
        physics.regular_precession_rates,
        {"top": TOP, "theta": TILT, "psi_dot": SPIN},
    ),
    "set_precession_rate": (physics.set_precession_rate, {"state": OF_STATES, "phi_dot": RATE}),
    "solve_start": (
        physics.solve_start,
        {"top": ONE_TOP, "theta": refuses(0.5), "precession_period": refuses(1.0)},
    ),
    "specific_force": (
        physics.specific_force,
        {
            "motion": ONE_MOTION,
            "state": OF_STATES,
            "position": ONE_VECTOR,
            "gravity": GRAVITY,
        },
    ),
    "theta_acceleration": (physics.theta_acceleration, {"top": TOP, **RATES}),
    "theta_torque": (physics.theta_torque, {"top": TOP, **RATES}),
    "validate_hold": (physics.validate_hold, {"hold": refuses("spin_rate")}),
    "Top": (Top, {"Ix": takes(2e-4), "Iz": takes(1e-4), "Mgl": takes(0.05)}),
    "Top.sleeping_is_stable": (
        lambda top, state: top.sleeping_is_stable(state),
        {"top": ONE_TOP, "state": refuses(UPRIGHT, UPRIGHTS)},
    ),
    "Friction": (Friction, {"axial": takes(1e-6), "transverse": takes(1e-6)}),
    "State": (
        State,
        {
            "orientation": refuses((1.0, 0, 0, 0), refused_as="angular_velocity"),
            "angular_velocity": refuses((0.0, 0, 9.0)),
        },
    ),
    "State.from_euler": (State.from_euler, {**RATES, "phi": RATE, "psi": RATE, "theta_dot": RATE}),
    "State.from_matrix": (
        State.from_matrix,
        {
            "matrix": refuses(np.eye(3), refused_as="angular_velocity"),
            "angular_velocity": refuses((0.0, 0, 9.0)),
        },
    ),
    "State.to_world": (STATE.to_world, {"vector": VECTOR}),
    "State.to_body": (STATE.to_body, {"vector": VECTOR}),
    "State.table": (STATES.table, {"times": refuses([0.0, 1.0, 2.0], np.zeros((2, 3)))}),
    "Motion": (
        Motion,
        {
            "top": ONE_TOP,
            "start": ONE_STATE,
            "friction": refuses(Friction(), FRICTIONS),
            "torque": ONE_VECTOR,
        },
    ),
    "Motion.at": (MOTION.at, {"t": TIME}),
    "Motion.jacobian": (MOTION.jacobian, {"t": TIME}),
    "Motion.certify": (MOTION.certify, {"t": TIME}),
    "Motion.restart": (MOTION.restart, {"start": ONE_STATE}),
    "Motion.piece_at": (PUSHED.piece_at, {"t": refuses(0.25)}),
    "Motion.piece_at without pushes": (MOTION.piece_at, {"t": refuses(0.25)}),
    "Motion.end_pushes": (PUSHED.end_pushes, {"number": refuses(2)}),
    "Motion.total_torque": (MOTION.total_torque, {"state": OF_STATES}),
    "Motion.added_torque": (MOTION.added_torque, {"state": OF_STATES}),
    "Motion.clamp_torque": (MOTION.clamp_torque, {"state": OF_STATES}),
    "Motion.euler_rates": (MOTION.euler_rates, {"state": OF_STATES}),
    "Motions": (
        Motions,
        {
            "top": TOP,
            "start": OF_STATES,
            "friction": takes(Friction(), FRICTIONS),
            "torque": VECTOR,
        },
    ),
    "Motions.at": (MOTIONS.at, {"t": TIME}),
    "Motions.jacobian": (MOTIONS.jacobian, {"t": TIME}),
    "Motions.certify": (MOTIONS.certify, {"t": TIME}),
    "Motions.at_each": (MOTIONS.at_each, {"times": takes([0.0, 1.0, 2.0], np.zeros((COUNT, 2)))}),
    "Motions.table": (MOTIONS.table, {"times": refuses([0.0, 1.0], np.zeros((2, 3)))}),
    **{
        f"Motions.{name}": (getattr(MOTIONS, name), {"states": takes(STATES, MOTIONS.at([0, 1]))})
        for name in (
            "energy",
            "axial_momentum",
            "vertical_momentum",
            "angular_momentum",
            "gravity_torque",
            "total_torque",
            "added_torque",
            "euler_rates",
        )
    },
    **{
        f"Motions.{name} of one state": (getattr(MOTIONS, name), {"states": refuses(STATES, STATE)})
        for name in ("energy", "total_torque", "added_torque", "euler_rates")
    },
    **{
        f"Top.{name}": (getattr(ARTICLE, name), {"state": OF_STATES})
        for name in (
            "energy",
            "axial_momentum",
            "vertical_momentum",
            "angular_momentum",
            "body_angular_momentum",
            "gravity_torque",
        )
    },
    "Friction.torque": (Friction(1e-6).torque, {"state": OF_STATES}),
    "Body": (Body, {"mass": KG, "arm": METRE, "Ix": MOMENT, "Iz": MOMENT, "gravity": GRAVITY}),
    "Body.from_top": (Body.from_top, {"top": ONE_TOP, "gravity": GRAVITY, "mass": KG}),
    "Body.from_pivot_moments": (
        Body.from_pivot_moments,
        {"mass": KG, "arm": METRE, "Ix": MOMENT, "Iz": refuses(1e-3), "gravity": GRAVITY},
    ),
    "Body.from_disc": (
        Body.from_disc,
        {"mass": KG, "radius": METRE, "distance": METRE, "gravity": GRAVITY},
    ),
    "Body.from_parts": (
        Body.from_parts,
        {"parts": refuses([Part("hoop", 1.0, 0.5, 0.25)], 1.0), "gravity": GRAVITY},
    ),
    "Body.centre_of_mass": (BODY.centre_of_mass, {"state": OF_STATES}),
    "Body.pivot_force": (BODY.pivot_force, {"motion": ONE_MOTION, "state": OF_STATES}),
    "Part": (
        Part,
        {
            "kind": refuses("hoop"),
            "mass": KG,
            "distance": METRE,
            "size": refuses(0.1, refused_as="radius"),
        },
    ),
    "Pushes": (Pushes, {"impulse": refuses(1e-5), "rate": refuses(20.0), "number": refuses(3)}),
    "EffectivePotential.from_state": (
        EffectivePotential.from_state,
        {"top": ONE_TOP, "state": ONE_STATE},
    ),
    "EffectivePotential.at": (POTENTIAL.at, {"theta": TILT}),
    "EffectivePotential.cubic": (POTENTIAL.cubic, {"u": TILT}),
    "EffectivePotential.find_third_root": (
        POTENTIAL.find_third_root,
        {"low": refuses(0.5), "high": refuses(0.6)},
    ),
    "Ledger.from_times": (
        Ledger.from_times,
        {"motion": ONE_MOTION, "begin": refuses(0.0), "end": refuses(0.25)},
    ),
    "Ledger.from_turns": (Ledger.from_turns, {"motion": ONE_MOTION, "t": refuses(0.5)}),
    "ExactTimes": (ExactTimes, {"nanoseconds": takes(5)}),
    "ExactTimes.advance": (ExactTimes(0).advance, {"nanoseconds": refuses(5)}),
}


def list_variants() -> Iterator[tuple[str, str, bool]]:
    for call, (_, given) in CALLS.items():
        yield call, "", True
        yield from ((call, name, each.takes_many) for name, each in given.items())


def find_shapes(found: Any) -> set[tuple[int, ...]]:
    """The shapes of all numbers of an answer, of records part by part."""
    if hasattr(found, "shape"):
        return {found.shape}
    if is_dataclass(found):
        found = {each.name: getattr(found, each.name) for each in fields(found)}
    parts = found.values() if isinstance(found, dict) else found
    if isinstance(parts, str) or not isinstance(parts, Iterable):
        return {()}
    return set().union(*map(find_shapes, parts))


@pytest.mark.parametrize(("call", "name", "is_taken"), [*list_variants()])
def test_a_call_with_many_answers_in_their_shape_or_refuses_the_argument(call, name, is_taken):
    function, given = CALLS[call]
    arguments = {each: value.many if each == name else value.one for each, value in given.items()}
    if not is_taken:
        named = given[name].refused_as or name
        with pytest.raises(ValueError, match=rf"^{named}\b.* must be .*, got "):
            function(**arguments)
        return
    alone = find_shapes(function(**{each: value.one for each, value in given.items()}))
    many = find_shapes(function(**arguments))
    if name:
        assert all(COUNT in shape for shape in many), (alone, many)


# These take nothing, or a record of which there is one alone.
WITHOUT_NUMBERS = {"kernel_version", "ExactTimes.ravel", "Exchange.from_ledger"}


def list_public_calls():
    for name in physics.__all__:
        found = getattr(physics, name)
        if inspect.isfunction(found):
            yield name
        elif inspect.isclass(found):
            members = (
                (each, getattr(part, "__func__", part)) for each, part in vars(found).items()
            )
            calls = (each for each, part in members if inspect.isfunction(part))
            yield from (f"{name}.{each}" for each in calls if not each.startswith("_"))


def test_every_public_function_and_method_is_called():
    assert {*list_public_calls()} - {call.split()[0] for call in CALLS} == WITHOUT_NUMBERS
