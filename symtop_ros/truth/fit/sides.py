"""Twins of a plain record as starts for a record that breaks them.

The search knows nothing of an accelerometer or of perspective: without them rates do not show the
sign of Mgl, and a picture not that of its elevation. So each motion that was found is improved with
the whole record, and so is its twin.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from symtop_ros.truth.fit.model import TURNS, Model
from symtop_ros.truth.fit.record import Record
from symtop_ros.truth.fit.search import Candidate, drop_spikes, drop_twins, improve
from symtop_ros.truth.fit.starts import fill
from symtop_ros.truth.fit.twins import mirror_view, turn_over

MOST = 3  # motions of a search that are improved with their twins
STEPS = 60  # evaluations
SLIGHT = 0.05  # nearness of a start: at zero the picture does not depend on which side is near

Side = tuple[Motion, Mapping[str, float]]  # a motion, and the numbers of the camera that differ


def expand(found: Sequence[Candidate], record: Record) -> list[Candidate]:
    """Return candidates of a plain record as those of the whole one, the best first."""
    if not record.breaks_twins:
        return [*found]
    smooth = replace(record, values=drop_spikes(record.values))
    tried = [
        improve(*restate(each.model, each.x, motion, camera, smooth), STEPS)
        for each in found[:MOST]
        for motion, camera in list_sides(each)
    ]
    return drop_twins(sorted(tried, key=lambda each: each.cost), len(tried))


def list_sides(found: Candidate) -> Iterator[Side]:
    """Yield a motion and its twins, each with the camera that shows the same plain record."""
    motion = found.model.find_motion(found.x)
    if found.model.kind.name == "rates":
        yield motion, {}
        yield turn_over(motion), {}
        return
    camera = found.model.find_camera(found.x)
    for seen, side in ((motion, camera), mirror_view(motion, camera)):
        yield seen, {"elevation": side["elevation"], "nearness": SLIGHT}


def restate(
    model: Model, x: Real, motion: Motion, changed: Mapping[str, float], record: Record
) -> tuple[Model, Real]:
    """Return the model about the start of another motion, and its parameters.

    Numbers that the motion does not determine are those of x, except the changed ones.
    """
    new = Model(record, np.asarray(motion.start.orientation))
    wx, wy, spin = (float(each) for each in motion.start.angular_velocity)
    kept = {name: float(value) for name, value in zip(model.names, x, strict=True)}
    own = {"Mgl/Ix": motion.top.Mgl, "p_psi/Ix": spin, "spin": spin, "wx": wx, "wy": wy}
    return new, fill(new, {**kept, **dict.fromkeys(TURNS, 0.0), **own, **changed})
