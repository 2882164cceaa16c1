"""The state of the top: a unit quaternion and a body angular velocity, one or many."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Real = NDArray[np.float64]

NORM_TOLERANCE = 1e-3  # an orientation further from norm 1 is a mistake, not rounding
ROUNDING = 4 * np.finfo(float).eps
SMALLEST = 1e-100
LARGEST_RATE = 1e150  # rad/s; squares of it stay finite


class Angles(NamedTuple):
    """Euler angles z-x-z or their rates: precession phi, tilt theta, spin psi (rad or rad/s)."""

    phi: Any
    theta: Any
    psi: Any


@dataclass(frozen=True, eq=False)
class State:
    """Orientation and angular velocity at one instant, or at many.

    Parameters
    ----------
    orientation : array_like (..., 4)
        Unit quaternion (w, x, y, z), body -> world. Normalised on the way in; numbers below 1e-100
        are zero, here and in the angular velocity.
    angular_velocity : array_like (..., 3)
        In the body frame, rad/s.

    Raises
    ------
    ValueError
        Where shapes do not fit, a number is not finite, a norm is off by more than 1e-3, or an
        angular velocity exceeds 1e150 rad/s.
    """

    orientation: Real
    angular_velocity: Real

    def __init__(self, orientation: ArrayLike, angular_velocity: ArrayLike) -> None:
        q = _without_dust(_finite("orientation", orientation, 4))
        omega = _without_dust(_finite("angular_velocity", angular_velocity, 3))
        if q.shape[:-1] != omega.shape[:-1]:
            msg = f"orientation {q.shape} and angular_velocity {omega.shape} do not go together"
            raise ValueError(msg)
        if omega.size and np.abs(omega).max() > LARGEST_RATE:
            largest = np.abs(omega).max()
            msg = f"angular_velocity: got {largest:g} rad/s, allowed is up to {LARGEST_RATE:g}"
            raise ValueError(msg)
        self._set(q, omega)

    @classmethod
    def unchecked(cls, orientation: Real, angular_velocity: Real) -> State:
        """Return the state of finite arrays that fit; they become read-only, and its own."""
        state = object.__new__(cls)
        state._set(orientation, angular_velocity)
        return state

    def _set(self, orientation: Real, angular_velocity: Real) -> None:
        object.__setattr__(self, "orientation", _read_only(_normalised(orientation)))
        object.__setattr__(self, "angular_velocity", _read_only(angular_velocity))

    @classmethod
    def from_euler(
        cls,
        *,
        theta: float,
        phi: float = 0.0,
        psi: float = 0.0,
        theta_dot: float = 0.0,
        phi_dot: float = 0.0,
        psi_dot: float = 0.0,
    ) -> State:
        """Return the state with these Euler angles z-x-z (rad) and rates (rad/s)."""
        angles = {"theta": theta, "phi": phi, "psi": psi}
        rates = {"theta_dot": theta_dot, "phi_dot": phi_dot, "psi_dot": psi_dot}
        for name, value in {**angles, **rates}.items():
            if not np.isfinite(value):
                msg = f"{name}: got {value}, allowed is a finite number"
                raise ValueError(msg)
        plus, minus = (phi + psi) / 2, (phi - psi) / 2
        c, s = np.cos(theta / 2), np.sin(theta / 2)
        orientation = c * np.cos(plus), s * np.cos(minus), s * np.sin(minus), c * np.sin(plus)
        sine = np.sin(theta)
        omega = (
            phi_dot * sine * np.sin(psi) + theta_dot * np.cos(psi),
            phi_dot * sine * np.cos(psi) - theta_dot * np.sin(psi),
            phi_dot * np.cos(theta) + psi_dot,
        )
        return cls(orientation, omega)

    @cached_property
    def vertical(self) -> Real:
        """World z' in the body frame, (..., 3): sin theta sin psi, sin theta cos psi, cos theta."""
        w, x, y, z = self._parts
        return _read_only(
            _vector(2 * (x * z - w * y), 2 * (y * z + w * x), (w * w + z * z) - (x * x + y * y))
        )

    @property
    def _parts(self) -> tuple[Real, Real, Real, Real]:
        q = self.orientation
        return q[..., 0], q[..., 1], q[..., 2], q[..., 3]

    @property
    def euler_angles(self) -> Angles:
        """Angles (phi, theta, psi) in rad, 0 <= theta <= pi; on the vertical phi is taken as 0."""
        w, x, y, z = self._parts
        theta = 2 * np.arctan2(np.hypot(x, y), np.hypot(w, z))
        upper, lower = np.arctan2(z, w), np.arctan2(y, x)
        on_vertical = (theta == 0) | (theta == np.pi)
        phi = np.where(on_vertical, 0.0, _wrapped(upper + lower))
        psi = np.where(on_vertical, np.where(theta == 0, 2 * upper, -2 * lower), upper - lower)
        return Angles(*(_plain(angle) for angle in (phi, theta, _wrapped(psi))))

    @cached_property
    def euler_rates(self) -> Angles:
        """Rates (phi', theta', psi') in rad/s; on the vertical phi' is taken as 0."""
        vertical, omega = self.vertical, self.angular_velocity
        gx, gy, gz = vertical[..., 0], vertical[..., 1], vertical[..., 2]
        wx, wy, wz = omega[..., 0], omega[..., 1], omega[..., 2]
        sine = np.hypot(gx, gy)
        with np.errstate(invalid="ignore", divide="ignore"):
            phi_dot = np.where(sine > 0, (wx * gx + wy * gy) / sine / sine, 0.0)
            theta_dot = np.where(sine > 0, (wx * gy - wy * gx) / sine, np.hypot(wx, wy))
        psi_dot = wz - phi_dot * gz
        return Angles(*(_plain(rate) for rate in (phi_dot, theta_dot, psi_dot)))

    def to_world(self, vector: ArrayLike) -> Real:
        """Turn a body-frame vector (..., 3) into the world frame."""
        return _turned(*self._parts, np.asarray(vector, dtype=float))

    def to_body(self, vector: ArrayLike) -> Real:
        """Turn a world-frame vector (..., 3) into the body frame."""
        w, x, y, z = self._parts
        return _turned(-w, x, y, z, np.asarray(vector, dtype=float))

    def __iter__(self) -> Iterator[Real]:
        """Unpack as orientation, angular_velocity."""
        return iter((self.orientation, self.angular_velocity))

    def __eq__(self, other: object) -> bool:
        """Compare bit for bit (q and -q differ)."""
        return isinstance(other, State) and all(
            np.array_equal(a, b) for a, b in zip(self, other, strict=True)
        )

    __hash__ = None  # type: ignore[assignment]


def _finite(name: str, value: ArrayLike, size: int) -> Real:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError) as error:
        msg = f"{name}: got {value!r}, allowed are {size} numbers"
        raise ValueError(msg) from error
    if array.ndim == 0 or array.shape[-1] != size:
        msg = f"{name}: got shape {array.shape}, allowed is (..., {size})"
        raise ValueError(msg)
    if not np.isfinite(array).all():
        msg = f"{name}: got {value!r}, allowed are finite numbers"
        raise ValueError(msg)
    return array


def _without_dust(array: Real) -> Real:
    """Zero for what is too small to be squared; no motion can tell it from zero."""
    array[np.abs(array) < SMALLEST] = 0.0
    return array


def _normalised(q: Real) -> Real:
    """Unit quaternions; those which are one to rounding stay as they are."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    with np.errstate(over="ignore"):
        norm = np.sqrt((w * w + z * z) + (x * x + y * y))[..., np.newaxis]
    off = np.abs(norm - 1)
    largest = off.max(initial=0.0)
    if largest <= ROUNDING:
        return q
    if largest > NORM_TOLERANCE:
        worst = float(norm.flat[off.argmax()])
        msg = f"orientation: got a norm of {worst:g}, allowed is 1 within {NORM_TOLERANCE:g}"
        raise ValueError(msg)
    return np.asarray(np.where(off > ROUNDING, q / norm, q))


def _turned(w: Real, x: Real, y: Real, z: Real, v: Real) -> Real:
    """Return q v q* = v + w t + (x, y, z) x t with t = 2 (x, y, z) x v."""
    a, b, c = v[..., 0], v[..., 1], v[..., 2]
    t, u, s = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return _vector(
        a + w * t + (y * s - z * u), b + w * u + (z * t - x * s), c + w * s + (x * u - y * t)
    )


def _vector(x: Real, y: Real, z: Real) -> Real:
    vector = np.empty((*np.shape(x), 3))
    vector[..., 0], vector[..., 1], vector[..., 2] = x, y, z
    return vector


def _wrapped(angle: Real) -> Real:
    return np.asarray(angle - 2 * np.pi * np.rint(angle / (2 * np.pi)))


def _plain(value: Real) -> Any:
    return float(value) if value.ndim == 0 else value


def _read_only(array: Real) -> Real:
    array.flags.writeable = False
    return array
