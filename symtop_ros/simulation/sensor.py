"""The inertial sensor on the top: exact, or with noise that is the same in every computation.

Noise is a function of the seed and of the stamp, not of what was computed before. So a log can be
computed again from any of its files, whatever samples were missed.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Real, Vector, compose
from symtop_ros.physics import STANDARD_GRAVITY, Body, Motion, State, Top, specific_force
from symtop_ros.simulation.validation import number, vector
from symtop_ros.wire.layout import NANOSECONDS

EXACT = 1e-18  # (1e-9)^2, a covariance of what is exact: zero would mean "unknown" (sensor_msgs)
CENTRE: Vector = (0.0, 0.0, 0.0)
ALONG = (0.0, 0.0, 0.0, 1.0)
# A random walk is known exactly at multiples of BLOCK ns, and by bridges between them down to
# BLOCK / 2^LEVELS = 65 us; between these points it is straight.
BLOCK_BITS, LEVELS = 40, 24
BLOCK = 1 << BLOCK_BITS  # ns; 18 minutes
LONGEST_WALK = 1 << 57  # ns; four years and a half
AXES = 3
MIN_RATE, MAX_RATE = 1e-3, 1e6  # Hz
MAX_DISTANCE = 1e6  # m
MAX_NOISE = 1e6
NOISE = (
    "gyroscope_noise_density",
    "gyroscope_random_walk",
    "accelerometer_noise_density",
    "accelerometer_random_walk",
)
# Streams of numbers: three of the gyroscope, then three of the accelerometer.
WHITE, WALKS = range(2 * AXES), range(2 * AXES, 4 * AXES)


@dataclass(frozen=True)
class Imu:
    """An inertial measurement unit on a top.

    Noise densities and random walks are in the units of datasheets and of Kalibr's YAML. A sample
    has white noise of a density times the root of the rate.

    Attributes
    ----------
    position : tuple (3,)
        Its place in the body frame in m.
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
    seed : int
        Of the noise, >= 0.
    rate : float
        Samples per second.
    begin : int
        Stamp in ns at which the biases are zero.

    Raises
    ------
    ValueError
        If a number is refused.

    Examples
    --------
    >>> from symtop_ros.imu import Imu
    >>> Imu(position=(0, 0, 0.02), rate=1000).has_noise
    False
    >>> Imu(rate=0)
    Traceback (most recent call last):
    symtop_ros.simulation.validation.RefusedError: rate must be 0.001 to 1e+06 Hz, got 0
    """

    position: Vector = CENTRE
    orientation: tuple[float, float, float, float] = ALONG
    gyroscope_noise_density: float = 0.0
    gyroscope_random_walk: float = 0.0
    accelerometer_noise_density: float = 0.0
    accelerometer_random_walk: float = 0.0
    seed: int = 0
    rate: float = 200.0
    begin: int = 0

    def __post_init__(self) -> None:
        vector("position", self.position, 3, MAX_DISTANCE, "m, body frame")
        number("rate", self.rate, "Hz", MIN_RATE, MAX_RATE)
        number("seed", self.seed, "", 0, 2**63 - 1)
        values = asdict(self)
        for name in NOISE:
            number(name, values[name], "in SI units", 0.0, MAX_NOISE)
        _ = self.mount  # refused here if it is no unit quaternion

    @property
    def has_noise(self) -> bool:
        """True if the sensor is not exact."""
        return any((*self._densities, *self._walks))

    @property
    def covariances(self) -> dict[str, float]:
        """Variance of each axis of what is measured, by the names in the message."""
        gyroscope, accelerometer = (
            density * density * self.rate if density else EXACT for density in self._densities
        )
        return {
            "orientation": EXACT,
            "angular_velocity": gyroscope,
            "linear_acceleration": accelerometer,
        }

    @property
    def _densities(self) -> tuple[float, float]:
        return self.gyroscope_noise_density, self.accelerometer_noise_density

    @property
    def _walks(self) -> tuple[float, float]:
        return self.gyroscope_random_walk, self.accelerometer_random_walk

    @cached_property
    def mount(self) -> State:
        """The orientation as a state: `mount.to_body` turns components into the sensor frame."""
        x, y, z, w = self.orientation
        return State((w, x, y, z), CENTRE)

    def measure(self, motion: Motion, state: State, gravity: float) -> tuple[Real, Real, Real]:
        """Return what an exact sensor measures."""
        force = specific_force(motion, state, self.position, gravity)
        orientation = compose(state.orientation, self.mount.orientation)
        turned = self.mount.to_body(state.angular_velocity), self.mount.to_body(force)
        return orientation[..., [1, 2, 3, 0]], *turned

    def noise(self, stamps: Any) -> Real:
        """Return the errors of angular velocity and acceleration at stamps."""
        times = np.asarray(stamps, dtype=np.int64)
        errors = self.biases(times)
        sizes = np.repeat([each * math.sqrt(self.rate) for each in self._densities], AXES)
        if any(self._densities):
            white = _normals(self.seed, WHITE, times)
            errors += np.moveaxis(sizes.reshape(-1, *[1] * times.ndim) * white, 0, -1)
        return errors

    def biases(self, stamps: Any) -> Real:
        """Return the slow part of the errors: the random walks."""
        times = np.asarray(stamps, dtype=np.int64)
        if not any(self._walks):
            return np.zeros((*times.shape, 2 * AXES))
        walks = random_walks(self.seed, WALKS, times - self.begin)
        return np.asarray(np.moveaxis(walks, 0, -1) * np.repeat(self._walks, AXES))


# A good consumer sensor (Bosch BMI088, with walks from its bias stability).
CONSUMER = Imu(CENTRE, ALONG, 2.4e-4, 1e-5, 1.7e-3, 1e-4)


@dataclass(frozen=True)
class Rig:
    """Gravity and the sensor: all that samples depend on besides the motion."""

    gravity: float = STANDARD_GRAVITY  # m/s^2
    imu: Imu | None = None  # the sensor on the top, or None

    def to_values(self) -> dict[str, str]:
        """Return the values for an event, in decimals that read back to the same doubles."""
        values = {"gravity": repr(self.gravity)}
        if self.imu:
            imu = asdict(self.imu)
            values["imu.mount"] = " ".join(map(repr, (*imu["position"], *imu["orientation"])))
            values["imu.noise"] = " ".join(repr(imu[name]) for name in (*NOISE, "rate"))
            values["imu.seed"], values["imu.begin"] = str(imu["seed"]), str(imu["begin"])
        return values

    @classmethod
    def from_values(cls, values: Mapping[str, str]) -> "Rig":
        """Return the rig of an event."""
        gravity = float(values["gravity"])
        if not 0 < gravity < math.inf:
            raise ValueError(f"gravity must be > 0 m/s^2, got {gravity:g}")
        if "imu.mount" not in values:
            return cls(gravity)
        a, b, c, x, y, z, w = map(float, values["imu.mount"].split())
        *noise, rate = map(float, values["imu.noise"].split())
        seed, begin = int(values["imu.seed"]), int(values["imu.begin"])
        named = dict(zip(NOISE, noise, strict=True))
        return cls(
            gravity, Imu((a, b, c), (x, y, z, w), seed=seed, rate=rate, begin=begin, **named)
        )


@lru_cache(maxsize=8)
def find_body(top: Top, gravity: float) -> Body | None:
    """Return the body that is chosen for a top; None if no body can be it."""
    try:
        return Body.of(top, gravity)
    except ValueError:
        return None


def random_walks(seed: int, streams: Sequence[int], times: Any) -> Real:
    """Return random walks that grow by the root of the time in s, and are zero at 0.

    They are built by bridges between known points (Lévy's construction), so that any time is
    computed alone.
    """
    times = np.clip(np.asarray(times, dtype=np.int64), 0, LONGEST_WALK)
    block, rest = times >> BLOCK_BITS, times & (BLOCK - 1)
    known = np.arange(int(block.max(initial=0)) + 1)
    steps = math.sqrt(BLOCK / NANOSECONDS) * _normals(seed, streams, known << (LEVELS + 2))
    ends = np.concatenate((np.zeros((len(streams), 1)), np.cumsum(steps, axis=1)), axis=1)
    low, high = ends[:, block], ends[:, block + 1]
    walks = low + (high - low) * (rest / BLOCK)
    # The bridges of each level: its number at these times, and how far from its ends they are.
    for level in range(1, LEVELS + 1):  # in this order for any number of times: the same bits
        bits = BLOCK_BITS - level + 1
        inside = (rest & ((1 << bits) - 1)) / (1 << bits)
        sizes = (1 - np.abs(2 * inside - 1)) * np.sqrt((1 << bits) / NANOSECONDS / 4)
        places = (block << (LEVELS + 2)) + (1 << level) + (rest >> bits)
        walks = walks + sizes * _normals_of_runs(seed, streams, places)
    return np.asarray(walks)


def _normals_of_runs(seed: int, streams: Sequence[int], counters: Real) -> Real:
    """Return the normal numbers of counters, computed once for a run of equal ones."""
    flat = np.atleast_1d(counters).ravel()
    begins = np.flatnonzero(np.append(True, flat[1:] != flat[:-1])[: len(flat)])
    lengths = np.diff(np.append(begins, len(flat)))
    found = np.repeat(_normals(seed, streams, flat[begins]), lengths, axis=1)
    return found.reshape(len(streams), *np.shape(counters))


def _normals(seed: int, streams: Sequence[int], counters: Any) -> Real:
    """Return standard normal numbers, (k, ...), one for each stream and counter (...).

    They are a hash, not a sequence: that of SplitMix64 (Steele, Lea and Flood 2014), twice. The
    inverse of the normal distribution makes normal numbers of it.
    """
    # Imported here, because its import takes longer than that of the physics.
    from scipy.special import ndtri  # noqa: PLC0415

    counters = np.asarray(counters).astype(np.uint64)
    numbers = np.array(streams, dtype=np.uint64).reshape(-1, *[1] * counters.ndim)
    keys = _hash(_hash(np.array([seed], dtype=np.uint64))[0] + numbers)
    bits = _hash(_hash(counters) ^ keys)
    return np.asarray(ndtri(((bits >> np.uint64(11)) + 0.5) * 2.0**-53))


def _hash(value: NDArray[np.uint64]) -> NDArray[np.uint64]:
    with np.errstate(over="ignore"):  # products modulo 2^64
        z = value + np.uint64(0x9E3779B97F4A7C15)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        return np.asarray(z ^ (z >> np.uint64(31)))
