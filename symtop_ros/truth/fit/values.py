"""Numbers of a fitted motion that the record determines, each with its deviation."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.truth.fit.aliases import SPARSE, count_rows, is_alias
from symtop_ros.truth.fit.camera import CAMERA
from symtop_ros.truth.fit.model import FORCE_BIASES, FRICTION, KICK, MOUNT, find_momentum
from symtop_ros.truth.fit.record import Known
from symtop_ros.truth.fit.refine import Fit
from symtop_ros.truth.fit.systematics import Budget, Part
from symtop_ros.truth.fit.valley import Valley

HELD = 0.01  # of the deviation of the time of a kick
SURE = 0.15  # of the scale of a number; one with a larger deviation is not known
LEVEL = 4.0  # deviations within which an elevation may be zero
SIDES = "p_psi/Ix", "phi_dot", "mean_precession_rate"  # change with the sign of p_psi
ALIASED = "Mgl/Ix", "p_psi/Ix", "Iz/Ix", "spin", "theta_dot", "phi_dot", "nutation_period"
# Rates across the axis show no number of the top but the period of its nutation.
ACROSS_HIDDEN = (
    *("Mgl/Ix", "p_psi/Ix", "spin", "theta", "theta_dot", "phi_dot", "mean_precession_rate"),
)
# Numbers of a top. Their zero is no convention, so a relative deviation has a meaning.
SIZED = (
    *("Mgl/Ix", "p_psi/Ix", "Iz/Ix", "spin", "mean_precession_rate", "nutation_period", "scale"),
    *FRICTION,
)
OTHERS = (*FRICTION, *MOUNT, "gravity", *FORCE_BIASES)
UNITS = {
    "Mgl/Ix": "1/s^2",
    "p_psi/Ix": "rad/s",
    "Iz/Ix": "",
    "spin": "rad/s",
    "theta": "rad",
    "phi": "rad",
    "theta_dot": "rad/s",
    "phi_dot": "rad/s",
    "mean_precession_rate": "rad/s",
    "nutation_period": "s",
    "axial/Iz": "1/s",
    "transverse/Ix": "1/s",
    "spin_half_time": "s",
    "kick_time": "s",
    "kick": "rad/s",
    "Ix": "kg m^2",
    "Iz": "kg m^2",
    "Mgl": "J",
    "scale": "pixels",
    "u": "pixels",
    "v": "pixels",
    "elevation": "rad",
    "roll": "rad",
    "nearness": "",
    **dict.fromkeys(("gravity", *FORCE_BIASES), "m/s^2"),
    **dict.fromkeys(MOUNT[:3], "rad/s"),
    **dict.fromkeys(MOUNT[3:], "rad"),
}


@dataclass(frozen=True)
class Value:
    """A number with its standard deviation."""

    name: str
    value: float
    deviation: float
    is_known: bool  # the deviation is small, and so is what the record leaves open
    is_straight: bool = True  # False: the deviation would be small, but is not reliable
    parts: tuple[Part, ...] = ()  # changes of it by usual violations of the assumptions

    @property
    def unit(self) -> str:
        """Unit of the number."""
        return UNITS[self.name]

    @property
    def systematic(self) -> float:
        """Deviation from usual violations of the assumptions."""
        return float(np.sqrt(sum(part.shift**2 for part in self.parts)))

    @property
    def total(self) -> float:
        """Total deviation: from the noise and from violated assumptions."""
        return float(np.hypot(self.deviation, self.systematic))


def list_values(fit: Fit) -> list[Value]:
    """Return the numbers that the record determines, in the order of the report.

    A number is not known if a twin or another motion that fits as well has a different one.
    """
    rivals = [other for other in fit.others if not is_alias(other, fit)]
    others = [(dict(list_quantities(other)), other.x) for other in rivals]
    hidden, valley, budget, found = find_hidden(fit), Valley(hold_kick(fit)), Budget(fit), []
    for name, of in list_quantities(fit):
        value = find_value(valley, budget, name, of)
        is_same = all(agree(value, named[name](x)) for named, x in others)
        found.append(value if is_same and name not in hidden else replace(value, is_known=False))
    return [*found, *find_half_time(found)]


def find_half_time(values: list[Value]) -> Iterator[Value]:
    """Yield the time until the spin is half: omega_z' = -(axial/Iz) omega_z, whatever the axis."""
    for each in values:
        if each.name == "axial/Iz" and each.value > 0:
            part = _relative(each.value, each.deviation)
            yield _combine("spin_half_time", np.log(2) / each.value, (part, 0.0), each)


def hold_kick(fit: Fit) -> Fit:
    """Return the fit with the time of its kick held.

    Otherwise a motion some deviations away would have its kick on the other side of a row. That row
    would have the whole jump as its residual, so no valley would be straight.
    """
    known = fit.model.record.known
    if "kick_time" not in known:
        return fit
    value, deviation = known["kick_time"]
    record = replace(fit.model.record, known={**known, "kick_time": (value, HELD * deviation)})
    return replace(fit, model=fit.model.move(record))


def agree(value: Value, rival: float) -> bool:
    """Return whether a number of another motion is within three deviations of a value."""
    left = rival - value.value
    if value.name in {"phi", "roll"}:
        left -= 2 * np.pi * np.round(left / (2 * np.pi))
    return bool(abs(left) <= 3 * value.deviation)


def find_hidden(fit: Fit) -> tuple[str, ...]:
    """Return names that an exact twin has with a different value."""
    if fit.model.lacks_ratio:
        return ACROSS_HIDDEN
    if fit.model.kind.name == "theta":
        return *SIDES, *(ALIASED if is_sparse(fit) else ())
    level = (*SIDES, "phi", "elevation") if is_level(fit) else ()
    return *level, *(ALIASED if is_sparse(fit) else ())


def is_sparse(fit: Fit) -> bool:
    """Return True if there are so few rows in a nutation that a different one shows the same."""
    return count_rows(fit) < SPARSE


def is_level(fit: Fit) -> bool:
    """Return True if a camera may be above or below the level of the pivot."""
    is_open = fit.has_mirror or not fit.model.record.breaks_twins
    if "elevation" not in fit.model.place or not is_open:
        return False
    place = fit.model.place["elevation"]
    deviation = fit.find_deviation(np.eye(len(fit.x))[place])
    return bool(abs(fit.x[place]) < LEVEL * deviation)


def list_quantities(fit: Fit) -> Iterator[tuple[str, Callable[[Real], float]]]:
    """Yield names and functions of the parameters (p,)."""
    model = fit.model

    def take(name: str) -> Callable[[Real], float]:
        return lambda x: float(x[model.place[name]])

    yield "Mgl/Ix", take("Mgl/Ix")
    yield "p_psi/Ix", lambda x: find_momentum(model, x)
    yield from ((name, take(name)) for name in ("Iz/Ix", "spin") if name in model.place)
    yield from _list_angles(fit)
    if not model.record.has_friction:
        for name in ("mean_precession_rate", "nutation_period"):
            yield name, lambda x, name=name: _ask(model.find_motion(x), name)  # type: ignore[misc]
    if model.record.has_kick:
        yield "kick_time", take("kick_time")
        # its direction in space turns with the azimuth, which not every record shows
        yield "kick", lambda x: float(np.linalg.norm(x[[model.place[name] for name in KICK[1:]]]))
    yield from ((name, take(name)) for name in OTHERS if name in model.place)
    for name in (each for each in CAMERA if each in model.place):
        yield _write_camera(name, take(name))


def _write_camera(name: str, take: Callable[[Real], float]) -> tuple[str, Callable[[Real], float]]:
    if name == "log_scale":
        return "scale", lambda x: float(np.exp(take(x)))
    return name, take


def _ask(motion: Any, name: str) -> float:
    try:
        return float(getattr(motion, name))
    except (ValueError, TypeError):
        return np.nan


def _list_angles(fit: Fit) -> Iterator[tuple[str, Callable[[Real], float]]]:
    """Yield the Euler angles of the axis at the first row, and their rates."""
    model = fit.model
    phi = model.find_motion(fit.x).start.euler_angles.phi

    def turn(x: Real) -> float:
        found = model.find_motion(x).start.euler_angles.phi
        return float(found - 2 * np.pi * np.round((found - phi) / (2 * np.pi)))

    yield "theta", lambda x: float(model.find_motion(x).start.euler_angles.theta)
    if model.kind.shows_azimuth:
        yield "phi", turn
    yield "theta_dot", lambda x: float(model.find_motion(x).start.euler_rates.theta_dot)
    yield "phi_dot", lambda x: float(model.find_motion(x).start.euler_rates.phi_dot)


def find_value(valley: Valley, budget: Budget, name: str, of: Callable[[Real], float]) -> Value:
    """Return a number and its deviation, by central differences within white deviations."""
    fit = budget.fit
    slope, value = find_slope(fit, of), of(fit.x)
    if not (np.isfinite(slope).all() and np.isfinite(value)):
        return Value(name, value, np.inf, False)
    deviation = fit.find_deviation(slope)
    is_small = deviation <= SURE * find_scale(fit, name, value)
    straight = not is_small or valley.is_straight(slope, of)
    parts = budget.list_parts(slope)
    return Value(name, value, deviation, is_small and straight, straight, parts)


def find_slope(fit: Fit, of: Callable[[Real], float]) -> Real:
    """Return the derivatives (p,) of a function of the parameters."""
    steps = 1e-6 * fit.model.find_scales(fit.x)
    if "Iz/Ix" in fit.model.place and fit.x[1] > 2 - 2e-6:
        steps[1] = -steps[1]
    near = [(fit.x + side, fit.x - side) for side in np.diag(steps)]
    if "Iz/Ix" in fit.model.place and steps[1] < 0:
        near[1] = near[1][0], fit.x
        steps[1] /= 2
    return np.array([(of(a) - of(b)) / (2 * h) for (a, b), h in zip(near, steps, strict=True)])


def find_scale(fit: Fit, name: str, value: float) -> float:
    """Return the size of a number, below which its deviation has to be for it to be known."""
    scales = dict(zip(fit.model.names, fit.model.find_scales(fit.x), strict=True))
    if name in {"nutation_period", "scale", "kick"}:
        return abs(value)
    if name == "kick_time":
        return fit.model.record.seconds
    if name in {"theta", "phi"}:
        return 1.0
    if name == "Iz/Ix":
        return abs(value)
    return float(scales.get(name, scales["wx"]))


def convert(values: list[Value], given: dict[str, Known]) -> list[Value]:
    """Return the numbers that follow from known ones: moments, weight, and the spin.

    Parameters
    ----------
    values : list of Value
    given : dict
        Values of "Iz/Ix", "Ix" in kg m^2 and "Mgl" in J, with their deviations.
    """
    by_name = {each.name: each for each in values}
    found: list[Value] = []
    if "Iz/Ix" in given and "spin" not in by_name:
        found.append(_divide("spin", by_name["p_psi/Ix"], given["Iz/Ix"]))
    if "Ix" not in given and "Mgl" in given:
        found.append(_divide_known("Ix", given["Mgl"], by_name["Mgl/Ix"]))
    if "Ix" in given and "Mgl" not in given:
        found.append(_multiply("Mgl", by_name["Mgl/Ix"], given["Ix"]))
    ratio = by_name.get("Iz/Ix") or ("Iz/Ix" in given and Value("Iz/Ix", *given["Iz/Ix"], True))
    size = given.get("Ix") or next(((v.value, v.deviation) for v in found if v.name == "Ix"), None)
    if ratio and size:
        found.append(_multiply("Iz", ratio, size))
    return found


def _relative(value: float, deviation: float) -> float:
    return deviation / abs(value) if value else np.inf


def _combine(name: str, value: float, relative: tuple[float, float], of: Value) -> Value:
    """Return a number that is proportional to another one, or to its inverse."""
    deviation = abs(value) * float(np.hypot(*relative))
    is_known = of.is_known and deviation <= SURE * abs(value)
    size = abs(value / of.value) if of.value else 0.0
    parts = tuple(Part(part.cause, size * part.shift) for part in of.parts)
    return Value(name, value, deviation, is_known, parts=parts)


def _multiply(name: str, value: Value, known: Known) -> Value:
    relative = _relative(value.value, value.deviation), _relative(*known)
    return _combine(name, value.value * known[0], relative, value)


def _divide(name: str, value: Value, known: Known) -> Value:
    relative = _relative(value.value, value.deviation), _relative(*known)
    return _combine(name, value.value / known[0], relative, value)


def _divide_known(name: str, known: Known, value: Value) -> Value:
    relative = _relative(value.value, value.deviation), _relative(*known)
    return _combine(name, known[0] / value.value, relative, value)
