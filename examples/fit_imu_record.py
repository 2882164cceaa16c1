"""Ratios of the moments and the start of a top, fitted to a noisy record of its sensor."""

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.imu import CONSUMER, Imu, record_imu

motion = Motion(
    Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068),
    State.from_euler(theta=0.5, psi=0.4, phi_dot=-15, psi_dot=200),
)
sensor = replace(CONSUMER, position=(0.01, 0, 0.02), rate=500, seed=1)
measured = record_imu(motion, sensor, seconds=2).measured
noise = [sensor.gyroscope_noise_density] * 3 + [sensor.accelerometer_noise_density] * 3
sigma = np.array(noise) * sensor.rate**0.5
exact = Imu(position=sensor.position, rate=sensor.rate)


def residuals(p: Any, count: int) -> Any:
    """Computed minus measured, in deviations; p is Iz/Ix, Mgl/Ix, theta, psi and omega."""
    q = State.from_euler(theta=p[2], psi=p[3]).orientation
    guess = Motion(Top(1.0, *p[:2]), State(q, p[4:]))
    record = record_imu(guess, exact, seconds=count / sensor.rate)
    return ((record.measured - measured[:count]) / sigma).ravel()


p: Any = [0.3, 250.0, 0.4, 0.3, *measured[0, :3]]  # a guess
low, high = np.full(7, -np.inf), np.full(7, np.inf)
low[0], high[0] = 1e-3, 1.999  # Iz/Ix of a rigid body is at most 2
for count in (25, len(measured)):
    fit: Any = least_squares(residuals, p, args=(count,), x_scale="jac", bounds=(low, high))
    p = fit.x
errors = np.sqrt(np.diag(np.linalg.inv(fit.jac.T @ fit.jac)))
print(f"chi^2 {2 * fit.cost / (measured.size - 7):.2f} per degree of freedom")
print(f"Iz/Ix  {p[0]:.7f} +- {errors[0]:.7f}, exact {0.0572 / 0.228:.7f}")
print(f"Mgl/Ix {p[1]:.4f} +- {errors[1]:.4f}, exact {68 / 0.228:.4f}")
print(f"theta  {p[2]:.6f} +- {errors[2]:.6f}")
