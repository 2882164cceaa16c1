"""The sensor on the top, exact or with noise: an IMU, and a magnetometer in its frame.

A `Rig` is gravity, the mass and the sensor: all that samples depend on besides the motion.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real, Vector, compose
from symtop_ros.base.refusals import number, vector
from symtop_ros.physics import DEFAULT_GRAVITY, Body, Motion, State, Top, specific_force
from symtop_ros.run.simulation.sensor.noise import AXES, MAX_NOISE, Noise
from symtop_ros.run.wire.diagnostics import write_text

EXACT = 1e-18  # (1e-9)^2, a covariance of what is exact: zero would mean "unknown" (sensor_msgs)
CENTRE: Vector = (0.0, 0.0, 0.0)
ALONG = (0.0, 0.0, 0.0, 1.0)
MIN_RATE, MAX_RATE = 1e-3, 1e6  # Hz
MAX_DISTANCE = 1e6  # m
NOISE = (
    "gyroscope_noise_density",
    "gyroscope_random_walk",
    "accelerometer_noise_density",
    "accelerometer_random_walk",
)
LIMITS = (
    "gyroscope_range",
    "gyroscope_resolution",
    "accelerometer_range",
    "accelerometer_resolution",
)
PARTS = slice(0, 3), slice(3, 6)  # of a sample: rates, and specific forces
LARGEST_LIMIT = 1e9  # rad/s or m/s^2
# T; x east, y north, z up (REP-103): north and down, as in central Europe
EARTH: Vector = (0.0, 2e-5, -4.5e-5)
MAX_FIELD = 1e3  # T
EXACT_FIELD = 1e-30  # (1e-15 T)^2, the covariance of what is exact: zero would mean "unknown"
MAGNETOMETER_NOISE = ("magnetometer_noise_density", "magnetometer_random_walk")
# Noise density of a good consumer part (Bosch BMM150: 0.3 uT at 20 Hz), in T/sqrt(Hz).
BMM150 = 6.7e-8
FIRST_STREAM = 4 * AXES  # of numbers, after those of the gyroscope and the accelerometer


@dataclass(frozen=True)
class Magnetometer:
    """A magnetometer in the frame of an IMU, read at the rate of the IMU.

    Attributes
    ----------
    vector : tuple (3,)
        The field in T, world frame.
    magnetometer_noise_density : float
        White noise in T/sqrt(Hz).
    magnetometer_random_walk : float
        Random walk of the bias in T/s/sqrt(Hz).
    seed : int
        Seed of the noise, >= 0.

    Raises
    ------
    ValueError
        If a number is refused.

    Examples
    --------
    >>> from symtop_ros.truth.imu import Imu, Magnetometer
    >>> seen = Magnetometer(vector=(0, 2e-5, -4.5e-5))
    >>> Imu(magnetometer=seen).magnetometer == seen
    True
    """

    vector: Vector = EARTH
    magnetometer_noise_density: float = 0.0
    magnetometer_random_walk: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        vector("vector", self.vector, 3, MAX_FIELD, "T, world frame")
        number("seed", self.seed, "", 0, 2**63 - 1)
        for name in MAGNETOMETER_NOISE:
            number(name, getattr(self, name), "in SI units", 0.0, MAX_NOISE)

    def measure(self, state: State, mount: State) -> Real:
        """Return the field in the frame of the sensor, which is mounted on the body as given."""
        return mount.to_body(state.to_body(self.vector))

    def noise(self, rate: float, begin: int) -> Noise:
        """Return its errors, for a rate in Hz; its biases are zero at the stamp `begin` (ns)."""
        return Noise(
            (self.magnetometer_noise_density,),
            (self.magnetometer_random_walk,),
            self.seed,
            rate,
            begin,
            FIRST_STREAM,
        )

    def variance(self, rate: float) -> float:
        """Return the variance of each axis in T^2."""
        return self.magnetometer_noise_density**2 * rate or EXACT_FIELD


@dataclass(frozen=True)
class Imu:
    """An inertial measurement unit on a top.

    Noise densities and random walks are in the units of datasheets and of Kalibr's YAML. A sample
    has white noise of a density times the root of the rate. It is then rounded to the resolution,
    and clipped at the ends of the range, as in real sensors.

    Attributes
    ----------
    position : tuple (3,)
        Position of the sensor in the body frame, in m.
    orientation : tuple (4,)
        Quaternion x, y, z, w, sensor to body.
    gyroscope_noise_density : float
        White noise in rad/s/sqrt(Hz).
    gyroscope_random_walk : float
        Random walk of the bias in rad/s^2/sqrt(Hz).
    accelerometer_noise_density : float
        White noise in m/s^2/sqrt(Hz).
    accelerometer_random_walk : float
        Random walk of the bias in m/s^3/sqrt(Hz).
    gyroscope_range, accelerometer_range : float
        Largest absolute value of a component, in rad/s and m/s^2; 0 for no limit.
    gyroscope_resolution, accelerometer_resolution : float
        Step to which numbers are rounded, in rad/s and m/s^2; 0 for no rounding.
    seed : int
        Seed of the noise, >= 0.
    rate : float
        Samples per second.
    begin : int
        Stamp in ns at which the biases are zero.
    magnetometer : Magnetometer or None
        A magnetometer in the frame of the IMU.

    Raises
    ------
    ValueError
        If a number is refused.

    Examples
    --------
    >>> from symtop_ros.truth.imu import Imu
    >>> Imu(position=(0, 0, 0.02), rate=1000).is_exact
    True
    >>> Imu(rate=0)
    Traceback (most recent call last):
    symtop_ros.base.refusals.RefusedError: rate must be 0.001 to 1e+06 Hz, got 0
    """

    position: Vector = CENTRE
    orientation: tuple[float, float, float, float] = ALONG
    gyroscope_noise_density: float = 0.0
    gyroscope_random_walk: float = 0.0
    accelerometer_noise_density: float = 0.0
    accelerometer_random_walk: float = 0.0
    gyroscope_range: float = 0.0
    gyroscope_resolution: float = 0.0
    accelerometer_range: float = 0.0
    accelerometer_resolution: float = 0.0
    seed: int = 0
    rate: float = 200.0
    begin: int = 0
    magnetometer: Magnetometer | None = None

    def __post_init__(self) -> None:
        vector("position", self.position, 3, MAX_DISTANCE, "m, body frame")
        number("rate", self.rate, "Hz", MIN_RATE, MAX_RATE)
        number("seed", self.seed, "", 0, 2**63 - 1)
        for name in NOISE:
            number(name, getattr(self, name), "in SI units", 0.0, MAX_NOISE)
        for name in LIMITS:
            number(name, getattr(self, name), "in SI units", 0.0, LARGEST_LIMIT)
        _ = self.mount  # refused here if it is no unit quaternion

    @property
    def is_exact(self) -> bool:
        """True if the gyroscope and the accelerometer have no noise, no range and no resolution."""
        return not any(getattr(self, name) for name in (*NOISE, *LIMITS))

    @property
    def covariances(self) -> dict[str, float]:
        """Variance of each axis of what is measured, by the names in the message.

        Rounding adds the variance of a uniform distribution over a step, resolution^2/12.
        """
        gyroscope, accelerometer = (
            density * density * self.rate + step * step / 12 or EXACT
            for density, (_, step) in zip(self._noise.densities, self._limits, strict=True)
        )
        return {
            "orientation": EXACT,
            "angular_velocity": gyroscope,
            "linear_acceleration": accelerometer,
        }

    @cached_property
    def _noise(self) -> Noise:
        return Noise(
            (self.gyroscope_noise_density, self.accelerometer_noise_density),
            (self.gyroscope_random_walk, self.accelerometer_random_walk),
            self.seed,
            self.rate,
            self.begin,
        )

    @property
    def _limits(self) -> tuple[tuple[float, float], ...]:
        """Range and resolution of the gyroscope and of the accelerometer."""
        return (
            (self.gyroscope_range, self.gyroscope_resolution),
            (self.accelerometer_range, self.accelerometer_resolution),
        )

    @cached_property
    def mount(self) -> State:
        """The orientation as a state: `mount.to_body` turns components into the sensor frame."""
        x, y, z, w = self.orientation
        return State((w, x, y, z), CENTRE)

    def measure(self, motion: Motion, state: State, gravity: float) -> tuple[Real, Real, Real]:
        """Return what an exact sensor measures."""
        return (
            compose(state.orientation, self.mount.orientation)[..., [1, 2, 3, 0]],
            self.mount.to_body(state.angular_velocity),
            self.mount.to_body(specific_force(motion, state, self.position, gravity)),
        )

    def noise(self, stamps: Any) -> Real:
        """Return the errors of angular velocity and acceleration at stamps, before rounding."""
        return self._noise.draw(stamps)

    def show(self, exact: Real, stamps: Any) -> Real:
        """Return the output of the sensor for exact rates and forces (..., 6) at stamps."""
        if self.is_exact:
            return exact
        shown = np.array(exact + self.noise(stamps))
        for part, (end, step) in zip(PARTS, self._limits, strict=True):
            if step:
                shown[..., part] = np.rint(shown[..., part] / step) * step
            if end:
                shown[..., part] = np.clip(shown[..., part], -end, end)
        return shown

    def biases(self, stamps: Any) -> Real:
        """Return the slow part of the errors: the random walks."""
        return self._noise.biases(stamps)

    def measure_field(self, state: State, stamps: Any) -> tuple[Real, Real]:
        """Return the field in T that an exact magnetometer measures, and the errors of this one."""
        assert self.magnetometer
        return (
            self.magnetometer.measure(state, self.mount),
            self.magnetometer.noise(self.rate, self.begin).draw(stamps),
        )


# A good consumer sensor (Bosch BMI088, with walks from its bias stability).
CONSUMER = Imu(CENTRE, ALONG, 2.4e-4, 1e-5, 1.7e-3, 1e-4)


@dataclass(frozen=True)
class Rig:
    """Gravity, mass and sensor: all that samples depend on besides the motion."""

    gravity: float = DEFAULT_GRAVITY  # m/s^2
    imu: Imu | None = None  # the sensor on the top, or None
    mass: float = 0.0  # kg of the top; 0: a body is chosen

    @cached_property
    def values(self) -> Mapping[str, str]:
        """The values for an event, in decimals that read back to the same doubles."""
        values = {"gravity": repr(self.gravity)}
        if self.mass:
            values["mass"] = repr(self.mass)
        if imu := self.imu:
            values |= {
                "imu.mount": write_text((*imu.position, *imu.orientation)),
                "imu.noise": write_text([getattr(imu, name) for name in (*NOISE, "rate")]),
                "imu.seed": str(imu.seed),
                "imu.begin": str(imu.begin),
            }
            limits = [getattr(imu, name) for name in LIMITS]
            if any(limits):
                values["imu.limits"] = write_text(limits)
            if found := imu.magnetometer:
                values |= {
                    "magnetic_field.vector": write_text(found.vector),
                    "magnetic_field.noise": write_text(
                        [getattr(found, name) for name in MAGNETOMETER_NOISE]
                    ),
                    "magnetic_field.seed": str(found.seed),
                }
        return values

    def find_body(self, top: Top) -> Body | None:
        """Return the body of a top; None if no body can be it."""
        return find_body(top, self.gravity, self.mass)

    @classmethod
    def from_values(cls, values: Mapping[str, str]) -> "Rig":
        """Return the rig of an event."""
        gravity = float(values["gravity"])
        if not 0 < gravity < math.inf:
            raise ValueError(f"gravity must be > 0 m/s^2, got {gravity:g}")
        mass = float(values.get("mass", "0"))  # a log of before has none
        if not 0 <= mass < math.inf:
            raise ValueError(f"mass must be >= 0 kg, got {mass:g}")
        return cls(gravity, _read_imu(values) if "imu.mount" in values else None, mass)


def _read_imu(values: Mapping[str, str]) -> Imu:
    a, b, c, x, y, z, w = map(float, values["imu.mount"].split())
    *noise, rate = map(float, values["imu.noise"].split())
    limits = map(float, values.get("imu.limits", "0 0 0 0").split())
    return Imu(
        (a, b, c),
        (x, y, z, w),
        **dict(zip(NOISE, noise, strict=True)),
        **dict(zip(LIMITS, limits, strict=True)),
        seed=int(values["imu.seed"]),
        rate=rate,
        begin=int(values["imu.begin"]),
        magnetometer=_read_magnetometer(values) if "magnetic_field.vector" in values else None,
    )


def _read_magnetometer(values: Mapping[str, str]) -> Magnetometer:
    x, y, z = map(float, values["magnetic_field.vector"].split())
    density, walk = map(float, values["magnetic_field.noise"].split())
    return Magnetometer((x, y, z), density, walk, int(values["magnetic_field.seed"]))


@lru_cache(maxsize=8)
def find_body(top: Top, gravity: float, mass: float = 0.0) -> Body | None:
    """Return the body of a top: of its mass, or the chosen one; None if no body can be it."""
    try:
        return Body.from_top(top, gravity, mass or None)
    except ValueError:
        return None
