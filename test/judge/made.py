"""Estimates with known causes of their errors, single and in pairs, for the tests of the judge."""

from dataclasses import dataclass, replace

import numpy as np
from judge.cases import SECOND, make_estimates
from scipy.spatial.transform import Rotation

from symtop_ros.quaternions import compose, invert

NED = Rotation.from_quat([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])
FRD = Rotation.from_rotvec([np.pi, 0.0, 0.0])
MOUNT = Rotation.from_rotvec([0.3, -0.2, 0.1])
TILT = Rotation.from_rotvec([0.4, 0.2, 0.0])


def heading(angle):
    return Rotation.from_rotvec([0.0, 0.0, angle])


@dataclass(frozen=True)
class Made:
    """What is wrong with estimates."""

    world: Rotation | None = None
    body: Rotation | None = None
    delay: float = 0.0
    drift: float = 0.0
    spin: float = 0.0
    clock: float = 0.0
    change: str = ""
    noise: float = 0.0
    other: str = ""  # errors that no cause explains

    def make(self, truth, stamps, seed=1):
        """Return estimates with these errors."""
        random = np.random.default_rng(seed)
        seconds = (stamps - stamps[0]) / SECOND
        shifted = stamps - np.rint(self.clock * (stamps - stamps[0])).astype(np.int64)
        found = make_estimates(truth, shifted, None, None, self.delay)
        q = compose(turn_z(self.drift * seconds), _turn_world(self.world, found.orientations))
        q = compose(q, turn_z(self.spin * seconds))
        if self.body is not None:
            q = compose(q, wxyz(self.body))
        q = OTHERS[self.other](q, random)
        if self.noise:
            q = compose(q, wxyz(Rotation.from_rotvec(random.normal(0, self.noise, (len(q), 3)))))
        return replace(found, stamps=stamps, orientations=WRONG[self.change](q))


def wxyz(rotation):
    return rotation.as_quat()[..., [3, 0, 1, 2]]


def turn_z(angles):
    return wxyz(Rotation.from_rotvec(np.outer(angles, [0.0, 0.0, 1.0])))


def _turn_world(world, q):
    return q if world is None else compose(wxyz(world), q)


WRONG = {
    "": lambda q: q,
    "order": lambda q: q[:, [1, 2, 3, 0]],
    "conjugate": invert,
    "conjugate_order": lambda q: invert(q)[:, [1, 2, 3, 0]],
}
OTHERS = {
    "": lambda q, random: q,
    "random": lambda q, random: wxyz(Rotation.random(len(q), random_state=random)),
    "walk": lambda q, random: compose(turn_z(np.cumsum(random.normal(0, 0.02, len(q)))), q),
    "wave": lambda q, random: compose(turn_z(np.sin(np.arange(len(q)) * 0.05)), q),
    "still": lambda q, random: np.tile(q[:1], (len(q), 1)),
    "jump": lambda q, random: compose(turn_z(np.where(np.arange(len(q)) > len(q) / 2, 1, 0)), q),
}
