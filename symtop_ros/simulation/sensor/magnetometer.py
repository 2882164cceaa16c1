"""A magnetometer: the constant field of the world, in the frame of the sensor."""

from dataclasses import dataclass

from symtop_ros.arrays import Real, Vector
from symtop_ros.physics import State
from symtop_ros.simulation.sensor.noise import AXES, MAX_NOISE, Noise
from symtop_ros.simulation.validation import number, vector

# T; x east, y north, z up (REP-103): north and down, as in central Europe
EARTH: Vector = (0.0, 2e-5, -4.5e-5)
MAX_FIELD = 1e3  # T
EXACT_FIELD = 1e-30  # (1e-15 T)^2, the covariance of what is exact: zero would mean "unknown"
MAGNETOMETER_NOISE = ("magnetometer_noise_density", "magnetometer_random_walk")
# That of a good consumer part (Bosch BMM150: 0.3 uT at 20 Hz), in T/sqrt(Hz).
BMM150 = 6.7e-8
FIRST_STREAM = 4 * AXES  # of numbers, after those of the gyroscope and the accelerometer


@dataclass(frozen=True)
class Magnetometer:
    """A magnetometer in the frame of an IMU, with whose rate it is read.

    Attributes
    ----------
    vector : tuple (3,)
        The field in T, world frame.
    magnetometer_noise_density : float
        White noise in T/sqrt(Hz).
    magnetometer_random_walk : float
        Random walk of the bias in T/s/sqrt(Hz).
    seed : int
        Of the noise, >= 0.

    Raises
    ------
    ValueError
        If a number is refused.

    Examples
    --------
    >>> from symtop_ros.imu import Imu, Magnetometer
    >>> Imu(magnetometer=Magnetometer(vector=(0, 2e-5, -4.5e-5))).magnetometer.seed
    0
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
        density, walk = self.magnetometer_noise_density, self.magnetometer_random_walk
        return Noise((density,), (walk,), self.seed, rate, begin, FIRST_STREAM)

    def variance(self, rate: float) -> float:
        """Return the variance of each axis in T^2."""
        return self.magnetometer_noise_density**2 * rate or EXACT_FIELD
