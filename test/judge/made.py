"""Estimates with known causes of their errors, single and in pairs, for the tests of the judge."""

from dataclasses import dataclass, replace

import numpy as np
from judge.cases import NONE, SECOND, make_estimates
from physics.tops import multiply
from scipy.spatial.transform import Rotation

from symtop_ros.arrays import compose, invert

NED = Rotation.from_quat([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])
FRD = Rotation.from_rotvec([np.pi, 0.0, 0.0])
TILT = Rotation.from_rotvec([0.4, 0.2, 0.0])


def heading(angle):
    return Rotation.from_rotvec([0.0, 0.0, angle])


@dataclass(frozen=True)
class Made:
    """An error of estimates."""

    world: Rotation = NONE
    body: Rotation = NONE
    delay: float = 0.0
    drift: float = 0.0
    spin: float = 0.0
    clock: float = 0.0
    scale: float = 0.0  # of a gyroscope whose rates are integrated
    change: str = ""
    noise: float = 0.0
    other: str = ""  # errors that no cause explains

    def make(self, truth, stamps, seed=1):
        """Return estimates with these errors."""
        random = np.random.default_rng(seed)
        seconds = (stamps - stamps[0]) / SECOND
        shifted = stamps - np.rint(self.clock * (stamps - stamps[0])).astype(np.int64)
        found = make_estimates(truth, shifted, delay=self.delay)
        q = found.orientations
        if self.scale:
            late = shifted - round(self.delay * SECOND)
            q = integrate_rates(truth, late, 1 + self.scale)
        q = compose(turn_z(self.drift * seconds), compose(wxyz(self.world), q))
        q = compose(compose(q, turn_z(self.spin * seconds)), wxyz(self.body))
        q = OTHERS[self.other](q)
        if self.noise:
            q = compose(q, wxyz(Rotation.from_rotvec(random.normal(0, self.noise, (len(q), 3)))))
        return replace(found, stamps=stamps, orientations=WRONG[self.change](q))


def integrate_rates(truth, stamps, factor):
    """Attitudes that follow from rates in the body frame, times a factor; exact at the first stamp.

    Rates of the middle of steps of at most 20 us: at 300 rad/s they turn by 6 mrad.
    """
    begin, end = int(stamps[0]), int(stamps[-1])
    marks = np.unique(np.concatenate((stamps, np.arange(begin, end, 20_000))))
    middles = (marks[:-1] + marks[1:]) // 2
    turns = truth.states_at(middles)[1] * np.diff(marks)[:, np.newaxis] / SECOND * factor
    attitude, path, wanted = truth.states_at(stamps[:1])[0][0], [], set(stamps.tolist())
    steps = wxyz(Rotation.from_rotvec(turns))
    for mark, step in zip(marks.tolist(), [*steps, None], strict=True):
        if mark in wanted:
            path.append(attitude)
        if step is not None:
            attitude = multiply(attitude, step)
    return np.array(path)


def wxyz(rotation):
    return rotation.as_quat()[..., [3, 0, 1, 2]]


def turn_z(angles):
    return wxyz(Rotation.from_rotvec(np.outer(angles, [0.0, 0.0, 1.0])))


WRONG = {
    "": lambda q: q,
    "order": lambda q: q[:, [1, 2, 3, 0]],
    "conjugate": invert,
    "conjugate_order": lambda q: invert(q)[:, [1, 2, 3, 0]],
}
OTHERS = {
    "": lambda q: q,
    "wave": lambda q: compose(turn_z(np.sin(np.arange(len(q)) * 0.05)), q),
    "still": lambda q: np.tile(q[:1], (len(q), 1)),
}
