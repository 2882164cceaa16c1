"""A gyroscope on the body: gains, a mount that is not along the axes, biases, and a range."""

from dataclasses import dataclass

import numpy as np

from workshop.records.bodies import Real


@dataclass(frozen=True)
class Gyroscope:
    """What a sensor makes of the rates of the body.

    Attributes
    ----------
    gains : tuple of float
        Of its three axes.
    tilt : tuple of float
        Small angles by which it is turned about x, y and z of the body, in rad.
    bias : tuple of float
        In rad/s.
    limit : float
        Largest rate that it shows, in rad/s.
    """

    gains: tuple[float, float, float] = (1.0, 1.0, 1.0)
    tilt: tuple[float, float, float] = (0.0, 0.0, 0.0)
    bias: tuple[float, float, float] = (0.0, 0.0, 0.0)
    limit: float = np.inf

    def measure(self, rates: Real, noise: Real) -> Real:
        """Return rates (n, 3) as the sensor shows them; beyond its range its limit."""
        seen = rates + np.cross(rates, self.tilt)
        return np.clip(seen * self.gains + self.bias + noise, -self.limit, self.limit)
