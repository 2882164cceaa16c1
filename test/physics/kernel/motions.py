"""Motions of all families, as bytes for a program, and what Python says of them."""

import struct
from fractions import Fraction
from functools import cache

import numpy as np
from physics.exact_motions import read_motions

from symtop_ros.physics import ExactTimes, Friction, Motion, State, Top
from symtop_ros.physics.kernel import bindings, records

MOTIONS = read_motions()
# But for weights of 1e-100 J, of which short times are refused.
UNDER_GRAVITY = [
    each
    for each in MOTIONS
    if not each.motion.is_driven and each.family != "a weight however small moves an axis at rest"
]
DRIVEN = [each for each in MOTIONS if each.motion.is_driven]
# of the time of a case; less than 1e15 turns, which is what the kernel serves
TIMES = np.array([0.0, 1e-9, -1e-4, 1e-3, -1e-2, 0.1, 0.02, -0.03, 0.04, 0.05, -0.06, 0.07])
STAMPS = np.array([0, 1, -1000, 10**6, 10**9 + 7, -(10**9), 3, 10**10], np.int64)
ELAPSED = Fraction(2**60 + 1, 2**30)  # ns
LONGEST = 5.0  # s of a driven motion
FACTOR = np.array([1.4])
# Products by halves take 2^-200 and more. Of the smallest ones halves of products would round.
TINY = [1.5 * 2.0**-199, 1.5 * 2.0**-201, 1.1 * 2.0**-1010, 1.3 * 2.0**-1014, 1.7 * 2.0**-1021]
# Names of enums that programs are told.
NAMES = {
    "kinds": records.KINDS,
    "subjects": records.SUBJECTS,
    "directions": records.DIRECTIONS,
    "rules": records.RULES,
    "places": records.PLACE_KINDS,
    "explanations": records.EXPLANATIONS,
    "turns": records.TURNS,
    "effects": records.EFFECTS,
    "paces": records.PACES,
    "parts": records.PARTS,
    "reasons": records.REASON_KINDS,
    "lifts": records.LIFT_KINDS,
    "senses": records.SENSES,
}
FACTOR_OF_RATE = records.KICK_KINDS.index("factor")


class Sample:
    """A motion, the times at which it is compared, and a torque that may act from a time on."""

    def __init__(self, motion, times, torque=None):
        self.motion, self.times, self.torque = motion, times, torque
        self.clock = ExactTimes(STAMPS, 1 / 3, ELAPSED)
        if motion.is_driven or motion.farthest_time < LONGEST:  # stamps within the times
            t = float(np.abs(times).max())
            self.clock = ExactTimes(STAMPS[[0, 1, 6, 3, 4]], 0.3 * t, Fraction(0.01 * t) * 10**9)

    def encode(self):
        """Return what the program reads."""
        motion = self.motion
        friction = motion.friction.axial, motion.friction.transverse
        state = motion.start.given_orientation, motion.start.angular_velocity
        high = float(self.clock.elapsed)
        stamps = self.clock.nanoseconds
        clock = self.clock.factor, high, float(self.clock.elapsed - Fraction(high)), 0.0, 0.0
        parts = [*motion.top.moments], *state, friction, motion.applied_torque
        numbers = [*parts, [len(self.times)], self.times, clock, [len(stamps)]]
        torque = [0] if self.torque is None else [1, self.times[-1], *self.torque]
        return (
            np.concatenate([np.asarray(each, float) for each in numbers]).tobytes()
            + stamps.tobytes()
            + struct.pack(f"{len(torque)}d", *torque)
        )

    def expect(self):
        """Return what the program writes, as doubles."""
        motion = self.motion
        rates = self.motion._rates
        kind = records.KINDS.index(motion.kind)
        constants = [kind, *motion.turning_angles, *(getattr(rates, n) for n, _ in rates._fields_)]
        verdicts = list_verdicts(motion)
        one_by_one = [motion.at(float(t)) for t in self.times]
        states = [*one_by_one, motion.at(self.times), motion.at(self.clock)]
        if self.torque is not None:
            t = float(self.times[-1])
            pushed = Motion(motion.top, motion.at(t), motion.friction, self.torque)
            states.append(pushed.at(t))
        rows = [np.concatenate([np.atleast_2d(each) for each in s._parts], axis=1) for s in states]
        return np.concatenate([constants, *verdicts, np.concatenate(rows).ravel()])


def list_verdicts(motion):
    """Yield the start from its angles, its regular rates, kicks and verdicts, by both holds."""
    start = np.frombuffer(motion._packed_start)
    top = start[:3]
    q = start[3:7]
    omega = start[7:10]
    angles = bindings.find_angles(q)
    rates = bindings.find_angle_rates(q, omega)
    yield from (angles, rates, *bindings.from_angles(angles, rates))
    for hold in range(2):
        one = top[None], angles[1:2], rates[2:3]
        yield bindings.find_regular_rates(*one, hold)[0]
        kicked, _, status = bindings.kick(top, q, omega, FACTOR_OF_RATE, hold, FACTOR)
        if status == records.VERTICAL:
            continue
        yield kicked
        (verdict,), _ = bindings.judge(start[None], FACTOR, hold)
        after = np.concatenate([start[:7], kicked, start[10:]])
        answer = bindings.judge_kick(start.tobytes(), after.tobytes(), hold)
        for each in (verdict, np.frombuffer(answer, bindings.VERDICTS)[0]):
            yield np.array(list(flatten(each.item())), float)


def flatten(numbers):
    """Yield the numbers of a record of records, in their order."""
    for each in numbers:
        if isinstance(each, tuple | list | np.ndarray):
            yield from flatten(each)
        else:
            yield each


def list_gravity(numbers):
    """Motions under gravity: eight of the table for each number."""
    for number in numbers:
        for each in UNDER_GRAVITY[8 * number : 8 * number + 8]:
            yield Sample(each.motion, max(each.times, key=abs) * TIMES)


def list_driven(numbers):
    """Motions with friction or an applied torque, which changes in some of them."""
    for number in numbers:
        for each in DRIVEN[number % 34 :: 34]:
            motion = each.motion
            t = min(max(each.times), LONGEST)
            torque = (1e-3 * motion.top.Mgl, 0.0, 0.0) if number % 2 else None
            # Back in time friction drives a top: it soon becomes too fast.
            before = 0.0 if motion.friction else -0.1
            yield Sample(motion, t * np.array([0.0, before, 0.01, 0.4, 1.0]), torque)
    motion = UNDER_GRAVITY[0].motion
    pushed = (0.0, 0.01 * motion.top.Mgl, 0.0)
    yield Sample(motion, UNDER_GRAVITY[0].times[0] * TIMES[:7], pushed)
    yield from list_weak()


def list_weak():
    """Driven motions with a number that is small or smaller than products by halves can take."""
    top = Top(1.0, 0.375, 0.75)
    for tiny in TINY:
        tilted = State((0.96, tiny, -1.5 * tiny, 0.28), (tiny, 0.0, 3.0))
        ordinary = State((0.5, 0.5, -0.5, 0.5), (0.5, -0.25, 3.0))
        for start, friction, torque in (
            (tilted, Friction(0.01, 0.02), (0.0, 0.0, 0.0)),
            (ordinary, Friction(tiny, 3.0 * tiny), (0.0, 0.0, 0.0)),
            (ordinary, Friction(0.0, 0.01), (tiny, 0.0, 2.0 * tiny)),
        ):
            # 1e-7 is a small part of a step, of which powers are tiny, too
            yield Sample(Motion(top, start, friction, torque), np.array([1e-7, 0.3, 2.5, -1.0]))


def encode(samples):
    """Return what the program reads from stdin."""
    return struct.pack("d", len(samples)) + b"".join(each.encode() for each in samples)


def expect(samples):
    """Return what the program writes to stdout; NaN has one set of bits."""
    return normalize(np.concatenate([each.expect() for each in samples]))


def normalize(numbers):
    """Return the bytes of doubles, with one NaN for all: its sign is not defined."""
    return np.where(np.isnan(numbers), np.nan, numbers).tobytes()


@cache
def list_many():
    """The motions of the table, as bytes for a program and as what it writes."""
    samples = list_samples(range(216), range(34))
    assert len(samples) > 1800
    return encode(samples), expect(samples)


def list_samples(gravity, driven):
    return [*list_gravity(gravity), *list_driven(driven)]
