"""Tables of many values of a parameter, in which the search for causes looks for valleys."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from symtop_ros.arrays import Real, compose, invert
from symtop_ros.judge.causes.cause import CHANGES, set_parameter
from symtop_ros.judge.causes.search import Table
from symtop_ros.judge.compare import IDENTITY, NONE, Offset, Scaling
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.fit import MOST_DELAY
from symtop_ros.judge.truth import Truth

# A parameter is tried in steps in which it turns the attitude by so many rad, and at most so often.
GRID_STEP, MOST_STEPS = 0.5, 1000
MOST_CLOCK = 5e-3  # s per s
MOST_SCALE = 0.05  # of the scale of a gyroscope
TURNS = 8  # of world or body within the run, by a drift
BATCH = 32  # scales of which paths are computed together, as far as a cache reaches
COARSE = 150  # estimates that the search takes; the refinement takes SAMPLES
ExactKey = tuple[str, int, int, bool, tuple[float, float]]


@dataclass(eq=False)
class Grids:
    """Some estimates of a run, and the values of parameters that are tried with them."""

    some: Estimates
    truth: Truth
    fastest: float  # angular velocity of the motion in rad/s
    span: float  # s
    exacts: dict[ExactKey, tuple[Real, Real]] = field(default_factory=dict)
    scalings: dict[int, Scaling] = field(default_factory=dict)
    turns: dict[tuple[int, bytes], Real] = field(default_factory=dict)  # by their scales

    def tabulate(
        self, change: str, name: str, base: Offset = NONE, values: Real | None = None
    ) -> Table:
        """Return the table of a parameter, next to those of a base; without a name, of nothing."""
        changed = CHANGES[change][2](self.some)
        some = changed.thin(COARSE) if name else changed
        if values is None:
            values = self._grid(name) if name else np.zeros(1)
        base = replace(base, begin=int(self.some.stamps[0]), world=IDENTITY, body=IDENTITY)
        offsets = [set_parameter(base, name, float(v)) for v in values]
        exact, known = self._exact(some, name, offsets)
        if name == "scale" or base.scale:
            exact = self._scale(some, exact, offsets)
        if name == "spin" or base.spin:
            turns = np.stack([each.turn_body(some.stamps) for each in offsets])
            exact = compose(exact, turns)
        q = some.orientations[np.newaxis]
        if name == "drift" or base.drift:
            q = np.stack([compose(invert(e.turn_world(some.stamps)), q[0]) for e in offsets])
        shape = (len(values), len(some))
        return Table(
            values,
            np.broadcast_to(q, (*shape, 4)),
            np.broadcast_to(exact, (*shape, 4)),
            np.asarray(np.broadcast_to(known, shape), dtype=np.float64),
        )

    def _exact(self, some: Estimates, name: str, offsets: Sequence[Offset]) -> tuple[Real, Real]:
        """Return exact attitudes and what is known of them, for each offset or once for all."""
        moved = offsets if name in ("delay", "clock") else offsets[:1]
        ends = (moved[0].delay, moved[-1].clock)
        key = name if len(moved) > 1 else "", len(moved), len(some), some.of_sensor, ends
        if key not in self.exacts:
            stamps = np.concatenate([each.shift(some.stamps) for each in moved])
            exact, _, known = self.truth.states_at(stamps, some.of_sensor)
            shape = (len(moved), len(some))
            self.exacts[key] = exact.reshape(*shape, 4), known.reshape(shape).astype(np.float64)
        return self.exacts[key]

    def _scale(self, some: Estimates, exact: Real, offsets: Sequence[Offset]) -> Real:
        """Return what gyroscopes show of exact attitudes; the best delay is refined later."""
        scales, places = np.unique([each.scale for each in offsets], return_inverse=True)
        key = len(some), scales.tobytes()
        if key not in self.turns:
            if len(some) not in self.scalings:
                self.scalings[len(some)] = Scaling(self.truth, some.stamps)
            batches = np.split(scales, range(BATCH, len(scales), BATCH))
            turn = self.scalings[len(some)].turn
            self.turns[key] = np.concatenate([turn(each) for each in batches])
        return compose(self.turns[key][places], exact)

    def _grid(self, name: str) -> Real:
        """Return the values of a parameter that are tried."""
        angle, turns = self.fastest * self.span, 2 * np.pi * TURNS
        whole = max(angle, 1.0)
        scale = min(MOST_SCALE, turns / whole)
        drift = turns / self.span
        most, turn = {  # the largest value, and by how many rad it turns the attitude
            "delay": (MOST_DELAY, MOST_DELAY * self.fastest),
            "clock": (MOST_CLOCK, MOST_CLOCK * angle),
            "scale": (scale, scale * whole),
            "drift": (drift, turns),
            "spin": (drift, turns),
        }[name]
        count = int(min(max(turn / GRID_STEP, 10), MOST_STEPS))
        return np.linspace(-most, most, 2 * count + 1)
