"""Statements on what a record cannot determine, and why.

A twin is named only if it was computed and shows the same record to rounding.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from symtop_ros.truth.fit.across import Across
from symtop_ros.truth.fit.aliases import count_rows, is_alias
from symtop_ros.truth.fit.camera import project
from symtop_ros.truth.fit.model import find_axis, find_momentum
from symtop_ros.truth.fit.record import Known
from symtop_ros.truth.fit.refine import Fit
from symtop_ros.truth.fit.systematics import Budget
from symtop_ros.truth.fit.twins import (
    bias_spin,
    change_axial_moment,
    exchange_momenta,
    mirror_picture,
    mirror_view,
    reverse_momenta,
    scale_moments,
    see_from_above,
    turn_azimuth,
    turn_camera,
    turn_over,
)
from symtop_ros.truth.fit.values import (
    ACROSS_HIDDEN,
    ALIASED,
    Value,
    find_slope,
    is_level,
    is_sparse,
)

EXACT = 1e-9  # of the size of a record; twins agree to rounding, which grows with time
ROWS = 50  # at which twins are compared
STRONG = 0.98  # correlation of two numbers that are only known together
ABOVE = 4.0  # deviations within which a camera may be straight above
RATIO = 0.5  # Iz/Ix of a twin
BIAS = 0.01  # of the spin, by which the gyroscope of a twin is wrong
OF_CAMERAS = "mirrored", "upright", "high", "above"
#: The twins of each kind.
EXACT_TWINS: dict[str, tuple[str, ...]] = {
    "attitude": ("moments",),
    "rates": ("moments", "over", "azimuth", "bias"),
    "across": ("moments", "over", "azimuth", "cut"),
    "inertial": ("moments", "azimuth"),
    "axis": ("moments", "spin"),
    "angles": ("moments", "spin"),
    "pixels": ("moments", "spin", "mirrored", "upright", "high", "above"),
    "theta": ("moments", "spin", "azimuth", "exchange", "reverse"),
}


@dataclass(frozen=True)
class Unknown:
    """One statement, whose words are those of the template `unknown.KIND`.

    Attributes
    ----------
    kind : str
    names : str
        Numbers that are not known.
    numbers : tuple of float
        Numbers in the sentence.
    """

    kind: str
    names: str
    numbers: tuple[float, ...] = ()


def list_unknown(fit: Fit, values: Sequence[Value], given: dict[str, Known]) -> list[Unknown]:
    """Return statements on what a record does not determine."""
    together = [*list_together(fit, values)]
    found = [*list_twins(fit, given), *_list_aim(fit), *together, *_list_ambiguities(fit, values)]
    said = {name for each in found for name in each.names.split(", ")}
    curved = [each.name for each in values if not each.is_straight and each.name not in said]
    if curved:
        found.append(Unknown("curved", ", ".join(curved)))
    paired = {
        name for each in found if each.kind == "together" for name in each.names.split(" and ")
    }
    found += [
        Unknown("weak", each.name, (each.value, each.deviation))
        for each in values
        if not each.is_known and np.isfinite(each.deviation) and each.name not in paired
        if not any(each.name in other.names.split(", ") for other in found)
    ]
    # if two numbers are known only in combination, any value of one has a motion: none is listed
    others = [] if together else fit.others
    return [*found, *_list_motions(fit, others)]


def list_twins(fit: Fit, given: dict[str, Known]) -> Iterator[Unknown]:
    """Yield exact twins of the motion that was found."""
    motion = fit.model.find_motion(fit.x)
    own = show(fit, motion)
    size = float(np.abs(own).max())
    for kind in EXACT_TWINS[fit.model.kind.name]:
        if _is_settled(fit, kind, given):
            continue
        make = make_camera_twin if kind in OF_CAMERAS else make_body_twin
        twin = make(fit, motion, kind)
        is_open = kind == "high" and fit.has_mirror
        if is_open or np.abs(twin.shown - own).max() <= EXACT * size:
            yield Unknown(kind, twin.names, twin.numbers)


def _is_settled(fit: Fit, kind: str, given: dict[str, Known]) -> bool:
    """Return True if something else settles what a twin leaves open."""
    settled = {
        "moments": "Ix" in given or "Mgl" in given,
        "spin": "Iz/Ix" in given,
        "cut": not fit.model.lacks_ratio,
        "bias": fit.model.record.has_mount,
        "upright": "roll" in fit.model.record.camera,
        "high": "elevation" in fit.model.record.camera,
        "above": not is_above(fit),
    }
    return settled.get(kind, False)


def is_above(fit: Fit) -> bool:
    """Return True if a camera may look straight down."""
    camera = fit.model.find_camera(fit.x)
    left = np.pi / 2 - camera["elevation"]
    if "elevation" not in fit.model.place:
        return bool(abs(left) < EXACT)
    deviation = fit.find_deviation(np.eye(len(fit.x))[fit.model.place["elevation"]])
    return bool(left < ABOVE * deviation)


@dataclass(frozen=True, eq=False)
class Twin:
    """A twin: its record, the names of the numbers that differ, and these numbers."""

    shown: Real
    names: str
    numbers: tuple[float, ...] = ()


def make_body_twin(fit: Fit, motion: Motion, kind: str) -> Twin:
    """Return a twin of a record that has no camera."""
    if kind == "moments":
        return Twin(show(fit, scale_moments(motion, 2.0)), "Ix, Iz, Mgl")
    if kind == "spin":
        return Twin(show(fit, change_axial_moment(motion, motion.top.Ix / 2)), "Iz/Ix, spin")
    if kind == "over":
        return Twin(show(fit, turn_over(motion)), "sign of Mgl")
    if kind == "azimuth":
        return Twin(show(fit, turn_azimuth(motion, 1.0)), "phi")
    if kind == "cut":
        shown = show(fit, Across.of(motion).find_motion(RATIO))
        return Twin(shown, ", ".join(("Iz/Ix", *ACROSS_HIDDEN)), measure_constant(fit))
    return make_momentum_twin(fit, motion, kind)


def measure_constant(fit: Fit) -> tuple[float, float]:
    """Return (2 - Iz/Ix) wz, which rates across the axis show, with its deviation."""

    def find(x: Real) -> float:
        return Across.of(fit.model.find_motion(x)).k

    return find(fit.x), fit.find_deviation(find_slope(fit, find))


def make_momentum_twin(fit: Fit, motion: Motion, kind: str) -> Twin:
    """Return a twin with a different p_psi."""
    p = find_p(motion)
    if kind == "bias":
        bias = BIAS * float(motion.start.angular_velocity[2])
        shown = show(fit, bias_spin(motion, bias)) - [0.0, 0.0, bias]
        return Twin(shown, "bias_z", (bias, 2 * bias))
    if kind == "reverse":
        return Twin(show(fit, reverse_momenta(motion)), "sign of p_psi", (-p,))
    twin = exchange_momenta(motion)
    names = "p_psi/Ix, phi_dot, mean_precession_rate"
    return Twin(show(fit, twin), names, (p, find_p(twin)))


def make_camera_twin(fit: Fit, motion: Motion, kind: str) -> Twin:
    """Return a twin that a different camera shows, or one from straight above."""
    camera, p = fit.model.find_camera(fit.x), find_p(motion)
    if kind == "mirrored":
        twin, turned = mirror_picture(motion, camera)
        shown = _project(fit, twin, turned)
        return Twin(shown * [-1.0, 1.0] + [2 * camera["u"], 0.0], "sign of p_psi", (-p,))
    if kind == "upright":
        twin, turned = turn_camera(motion, camera)
        return Twin(_project(fit, twin, turned), "sign of Mgl", (-motion.top.Mgl, p))
    if kind == "high":
        twin, low = mirror_view(motion, camera)
        return Twin(_project(fit, twin, low), "sign of p_psi", (low["elevation"], -p))
    level = {**camera, "elevation": np.pi / 2}
    moved = _project(fit, see_from_above(motion), level) - _project(fit, motion, level)
    return Twin(show(fit, motion) + moved, "sign of Mgl", (-motion.top.Mgl, -p))


def find_p(motion: Motion) -> float:
    """Return p_psi."""
    return float(motion.top.Iz * motion.start.angular_velocity[2])


def show(fit: Fit, motion: Motion) -> Real:
    """Return what a motion shows at some times of a record."""
    kind = fit.model.kind.name
    if kind == "pixels":
        return _project(fit, motion, fit.model.find_camera(fit.x))
    state = motion.at(_choose_times(fit))
    if kind == "rates":
        return np.asarray(state.angular_velocity)
    if kind == "across":
        return np.asarray(state.angular_velocity[:, :2])
    if kind == "inertial":  # its forces follow from the rates and the vertical
        return np.concatenate([state.angular_velocity, state.vertical], axis=-1)
    if kind == "attitude":
        return np.asarray(state.orientation)
    axis = find_axis(state.orientation)
    return np.asarray(axis[:, 2:]) if kind == "theta" else axis


def _choose_times(fit: Fit) -> Real:
    record = fit.model.record
    times = record.times - record.times[0]
    return np.asarray(times[:: max(1, len(times) // ROWS)])


def _project(fit: Fit, motion: Motion, camera: dict[str, float]) -> Real:
    axis = find_axis(motion.at(_choose_times(fit)).orientation)
    return np.asarray(
        project(axis[np.newaxis], {name: np.array([each]) for name, each in camera.items()})[0]
    )


def _list_aim(fit: Fit) -> Iterator[Unknown]:
    """Yield what p_psi would be if a near camera whose aim is not known looks above the pivot."""
    if fit.model.record.kind.name == "pixels" and (shift := Budget(fit).raise_aim()) is not None:
        p = find_slope(fit, lambda x: find_momentum(fit.model, x)) @ shift
        yield Unknown("aim", "aim of the camera", (find_momentum(fit.model, fit.x) + float(p),))


def list_together(fit: Fit, values: Sequence[Value]) -> Iterator[Unknown]:
    """Yield pairs of numbers of which only a combination is known."""
    doubtful = {v.name for v in values if not v.is_known and v.name in fit.model.place}
    turning = next((v for v in values if v.name == "mean_precession_rate" and v.is_known), None)
    if {"Mgl/Ix", "p_psi/Ix"} <= doubtful and turning is not None:
        a, p = fit.model.place["Mgl/Ix"], fit.model.place["p_psi/Ix"]
        covariance = fit.covariance
        ratio = float(covariance[a, p] / np.sqrt(covariance[a, a] * covariance[p, p]))
        if abs(ratio) > STRONG:
            numbers = turning.value, turning.deviation, *find_rest(fit)
            yield Unknown("together", "Mgl/Ix and p_psi/Ix", numbers)
    if "scale" in {v.name for v in values if not v.is_known} and "log_scale" in fit.model.place:
        yield Unknown("tilt", "scale and theta")


def find_rest(fit: Fit) -> tuple[float, float]:
    """Return (Mgl minus mean precession rate times p_psi)/Ix, and its deviation.

    A regular precession has Mgl = p_psi Omega - Ix Omega^2 cos(theta), of any p_psi. So the mean
    precession rate is the factor. A factor from the covariance would hold only next to the fitted
    p_psi, which may be far off.
    """

    def find(x: Real) -> float:
        motion = fit.model.find_motion(x)
        turning = Motion(motion.top, motion.start).mean_precession_rate  # friction has none
        return float(x[fit.model.place["Mgl/Ix"]]) - turning * find_momentum(fit.model, x)

    return find(fit.x), fit.find_deviation(find_slope(fit, find))


def _list_motions(fit: Fit, others: Sequence[Fit]) -> Iterator[Unknown]:
    """Yield motions that fit as well."""
    for other in others:
        motion = other.model.find_motion(other.x)
        numbers = float(motion.top.Mgl), find_p(motion)
        if is_alias(other, fit):
            yield Unknown("alias", "rows in a nutation", (*numbers, count_rows(other)))
        else:
            yield Unknown("other", "Mgl/Ix, p_psi/Ix", numbers)


def _list_ambiguities(fit: Fit, values: Sequence[Value]) -> Iterator[Unknown]:
    """Yield nutations with few rows, level cameras, and whole turns of the spin."""
    if is_sparse(fit):
        names = {each.name for each in values}
        hidden = ", ".join(name for name in ALIASED if name in names)
        yield Unknown("sparse", hidden, (count_rows(fit),))
    if is_level(fit):
        yield Unknown("level", "sign of p_psi")
    if fit.model.kind.name == "attitude":
        turns = 2 * np.pi / fit.model.record.step
        yield Unknown("turns", "spin", (turns,))
