"""The motion with friction or an applied torque: no closed form, integrated as far as needed."""

import math
from bisect import bisect_left
from collections import deque
from collections.abc import Iterator
from threading import Lock
from typing import TypeAlias

import numpy as np

from symtop_ros.arrays import Real, Vector
from symtop_ros.physics.driven.equations import DrivenEquations, Extended
from symtop_ros.physics.driven.series import Knot, Piece, Stepper
from symtop_ros.physics.kernel.compiled import CompiledMotion
from symtop_ros.physics.state import State
from symtop_ros.physics.times import ExactTimes, refuse_too_fast, to_rough_seconds
from symtop_ros.physics.top import Friction, Top
from symtop_ros.physics.values import refuse

KEPT = 1024  # knots kept over the whole integration; beyond this every other one is dropped
BLOCK = 1024  # times whose variables are held at once
MOST_DECAYS = 1e5  # decay times in one call: some seconds
RECENT = 64  # pieces kept up to the present one: to go back a little costs nothing


class DrivenMotion:
    """States by Taylor series, in pieces in both directions of time from the start.

    Threads may share it: a lock keeps each call whole, because a call moves along the pieces.
    """

    def __init__(
        self,
        top: Top,
        start: State,
        friction: Friction,
        torque: Vector,
        compiled: CompiledMotion | None,
    ) -> None:
        self._start = start
        self._decay = max(friction.transverse / top.Ix, friction.axial / top.Iz)  # 1/s
        self._lock = Lock()
        self._trails: dict[int, AnyTrail]  # by direction
        if compiled:
            self._trails = dict.fromkeys((1, -1), compiled)
        else:
            equations = DrivenEquations(top, friction, torque)
            stepper, knot = Stepper(equations), Knot(0.0, equations.start(start))
            self._trails = {each: Trail(equations, stepper, knot, each) for each in (1, -1)}

    def _find_trail(self, t: float) -> "AnyTrail":
        return self._trails[1 if t >= 0 else -1]

    def at(self, t: float) -> tuple[Real, Real]:
        """Return orientation (4,) and angular velocity (3,) at one time in s."""
        if t == 0:
            return self._start.parts
        with self._lock:
            orientation, omega = self._find_reachable_trail(t).compute_states(np.array([t]))
        return np.asarray(orientation[0], np.float64), np.asarray(omega[0], np.float64)

    def fill(self, times: Real | ExactTimes, orientation: Real, angular_velocity: Real) -> None:
        """Write the states at times (n,) in s or exact times into arrays (n, 4) and (n, 3)."""
        seconds = to_rough_seconds(times)
        order = np.argsort(np.abs(seconds), kind="stable")
        for side in (seconds >= 0, seconds < 0):
            sorted_places = order[side[order]]
            for first in range(0, len(sorted_places), BLOCK):
                places = sorted_places[first : first + BLOCK]
                last = float(seconds[places[-1]])
                with self._lock:
                    states = self._find_reachable_trail(last).compute_states(times[places])
                orientation[places], angular_velocity[places] = states
        orientation[seconds == 0] = self._start.orientation  # bit for bit

    def _find_reachable_trail(self, t: float) -> "AnyTrail":
        """Refuse a time that a strong friction makes too far: each decay time takes a step.

        After some decay times the top creeps, but explicit series cannot take longer steps.
        """
        trail, decay = self._find_trail(t), self._decay
        reached = trail.reach(t, 0)
        if abs(t - reached) * decay > MOST_DECAYS:
            farthest = abs(reached) + MOST_DECAYS / decay
            raise refuse(
                "t",
                f"within {farthest:.3g} s of the start (friction stops the top in {1 / decay:.3g} "
                "s, and every such time takes a step)",
                t,
            )
        return trail

    def reach(self, t: float, steps: float) -> float:
        """Integrate towards t in a limited number of steps; return the time reached."""
        with self._lock:
            return self._find_trail(t).reach(t, steps)


class Trail:
    """The pieces of an integration in one direction of time.

    They depend on the motion alone, not on earlier requests: a state is the same to the last bit
    whatever was asked before. Some knots and pieces are kept, so that one can go back.
    """

    def __init__(
        self, equations: DrivenEquations, stepper: Stepper, start: Knot, direction: int
    ) -> None:
        self._equations, self._stepper, self._direction = equations, stepper, direction
        self._kept, self._spacing = [start], 1  # knots, and the number of pieces between two
        self._recent: deque[Piece] = deque(maxlen=RECENT)  # the last one is the present piece
        self._count = 0  # pieces before the present one

    def compute_states(self, times: Real | ExactTimes) -> tuple[Extended, Extended]:
        """Return orientations (n, 4) and angular velocities (n, 3) at times (n,), sorted."""
        if isinstance(times, ExactTimes):
            seconds, rests = times.split_seconds
            exact = seconds.astype(np.longdouble) + rests
        else:
            exact = times.astype(np.longdouble)
        return self._equations.read(np.concatenate(list(self.evaluate(exact))))

    def evaluate(self, times: Extended) -> Iterator[Extended]:
        """Yield the variables at times (n,) in s, sorted from the start on, piece by piece."""
        distances, first = np.abs(times), 0
        while first < len(times):
            t = float(times[first])
            reached = self.reach(t, math.inf)
            if reached != t:
                raise refuse_too_fast(t, reached)
            piece = self._recent[-1]
            after = int(np.searchsorted(distances, abs(piece.end), side="right"))
            after = max(after, first + 1)  # its double is the end, and it is a little further on
            yield piece.at(times[first:after])
            first = after

    def reach(self, t: float, steps: float) -> float:
        """Integrate towards a time in a limited number of steps, or to where it is too fast."""
        self._go_back(t)
        piece = self._recent[-1]
        while steps > 0 and abs(piece.end) < abs(t) and piece.end != piece.start.t:
            piece = self._step(piece)
            steps -= 1
        return min(t, piece.end, key=abs)

    def _step(self, piece: Piece) -> Piece:
        """Return the piece after the present one."""
        self._count += 1
        knot = piece.following
        if self._count == len(self._kept) * self._spacing:
            self._kept.append(knot)
        if len(self._kept) > KEPT:
            self._kept, self._spacing = self._kept[::2], 2 * self._spacing
        self._append_piece(knot)
        return self._recent[-1]

    def _go_back(self, t: float) -> None:
        """Go back to a piece that begins nearer to the start than a time in s."""
        while self._recent and abs(self._recent[-1].start.t) >= abs(t) and self._count:
            self._recent.pop()
            self._count -= 1
        if not self._recent:
            place = bisect_left(self._kept, abs(t), key=lambda knot: abs(knot.t)) - 1
            place = max(place, 0)  # the start belongs to the first piece
            self._count = place * self._spacing
            self._append_piece(self._kept[place])

    def _append_piece(self, knot: Knot) -> None:
        self._recent.append(self._stepper.step(knot, self._direction))


AnyTrail: TypeAlias = Trail | CompiledMotion
