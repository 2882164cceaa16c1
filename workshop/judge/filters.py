"""Attitudes that filters of other authors make of the rates and forces of a sensor in the pivot."""

import importlib
from collections.abc import Callable
from random import Random

import numpy as np

from workshop.judge.motion import Course, Real, conjugate, multiply, turn

RATE = 200  # samples a second
GRAVITY = 9.81
NOISE = 2e-3, 2e-2  # rad/s and m/s^2, of a sample
SETTLED = 0.6  # s, before estimates are judged


def measure(random: Random, course: Course, times: Real) -> tuple[Real, Real]:
    """Return rates and forces (n, 3) in the body, with white noise."""
    states = course.states(times)
    up = np.array([[0.0, 0.0, 0.0, GRAVITY]])
    forces = multiply(multiply(conjugate(states[:, :4]), up), states[:, :4])[:, 1:]
    noise = np.array([[random.gauss(0, 1) for _ in range(6)] for _ in times])
    return states[:, 4:] + NOISE[0] * noise[:, :3], forces + NOISE[1] * noise[:, 3:]


def run_ahrs(name: str) -> Callable[[Real, Real, Real], Real]:
    """Return a filter of ahrs, from a start on."""

    def run(rates: Real, forces: Real, start: Real) -> Real:
        kind = getattr(importlib.import_module("ahrs.filters"), name)
        options = {} if name == "AngularRate" else {"acc": forces}
        found = kind(gyr=rates, frequency=float(RATE), q0=start, **options).Q
        return np.asarray(found, dtype=float)

    return run


def run_vqf(rates: Real, forces: Real, start: Real) -> Real:
    """Return the attitudes of VQF, turned to the heading of the start."""
    vqf = importlib.import_module("vqf").VQF(1 / RATE)
    found = vqf.updateBatch(np.ascontiguousarray(rates), np.ascontiguousarray(forces))["quat6D"]
    return turn_to(np.asarray(found, dtype=float), start)


def run_imufusion(rates: Real, forces: Real, start: Real) -> Real:
    """Return the attitudes of imufusion, turned to the heading of the start."""
    module = importlib.import_module("imufusion")
    settings, filtering = module.AhrsSettings(), module.Ahrs()
    settings.convention, settings.sample_rate = module.CONVENTION_ENU, RATE
    filtering.set_settings(settings)
    found = []
    for rate, force in zip(np.degrees(rates), forces / GRAVITY, strict=True):
        filtering.update_no_magnetometer(rate, force)
        found.append(filtering.get_quaternion())
    return turn_to(np.array(found, dtype=float), start)


def turn_to(found: Real, start: Real) -> Real:
    """Return attitudes about the vertical as far as the first is nearest to a start."""
    w, _, _, z = multiply(start, conjugate(found[0]))
    return multiply(turn([0.0, 0.0, 2 * np.arctan2(z, w)]), found)


FILTERS = {
    "ahrs AngularRate": run_ahrs("AngularRate"),
    "ahrs Madgwick": run_ahrs("Madgwick"),
    "ahrs Mahony": run_ahrs("Mahony"),
    "vqf": run_vqf,
    "imufusion": run_imufusion,
}
