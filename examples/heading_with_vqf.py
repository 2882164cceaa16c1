"""The heading that VQF finds on a spinning top, with a magnetometer and without.

pip install vqf (github.com/dlaidig/vqf) first. The numbers are root mean square errors in
rad, over the second ten seconds. The top starts two radians off the heading with which a filter
starts.
"""

from dataclasses import replace

import numpy as np
from vqf import VQF

from symtop_ros.base.arrays import Real, compose, invert
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.truth.imu import CONSUMER, Magnetometer, record_imu

SECONDS = 20
NOISY = Magnetometer(vector=(0.0, 2e-5, -4.5e-5), magnetometer_noise_density=6.7e-8, seed=1)


def find_headings(scene: str, rate: float) -> dict[str, float]:
    """Return the error of the heading without and with the magnetometer, at a rate in Hz."""
    imu = replace(CONSUMER, rate=rate, seed=1, magnetometer=NOISY)
    settings = Settings.from_scene(scene, initial__phi=2.0)
    record = record_imu(start_motion(settings), imu, SECONDS)
    rates, forces = (np.ascontiguousarray(part) for part in np.hsplit(record.measured, 2))
    found = VQF(1 / rate).updateBatch(rates, forces, record.measured_fields)
    half = len(rates) // 2
    return {
        name: error(found[key][half:], record.orientations[half:])
        for name, key in (("without", "quat6D"), ("with", "quat9D"))
    }


def error(estimates: Real, exact: Real) -> float:
    """Return the root mean square of the angle about the vertical between attitudes (n, 4)."""
    w, _, _, z = compose(estimates, invert(exact)).T
    angles = 2 * np.arctan2(z, w)
    return float(np.sqrt(np.mean(((angles + np.pi) % (2 * np.pi) - np.pi) ** 2)))


if __name__ == "__main__":
    for scene, rate in (("conical_pendulum", 1e3), ("cusps", 1e3), ("cusps", 1e4)):
        found = find_headings(scene, rate)
        text = ", ".join(f"{name} a magnetometer {size:.1g}" for name, size in found.items())
        print(f"{scene} at {rate:g} Hz: {text}")
