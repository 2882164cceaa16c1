"""Synthetic records of random tops, of every kind and with every noise."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import DEFAULT_GRAVITY, Friction, Motion, State, Top, specific_force
from symtop_ros.truth.fit import Record, make_record
from symtop_ros.truth.fit.camera import project
from symtop_ros.truth.fit.model import find_axis

Draw = np.random.Generator
# deviation of the noise: rad of angles, parts of the length of the axis, pixels, rad/s
SIGMA = {
    "inertial": 0.1,
    "attitude": 5e-3,
    "rates": 0.1,
    "axis": 5e-3,
    "angles": 5e-3,
    "pixels": 0.7,
    "theta": 2e-3,
}
POSITION = (0.02, 0.01, 0.05)  # m, of an accelerometer
SEEDED = ("angles", "attitude", "axis", "pixels", "rates", "theta", "inertial")  # kinds, for seeds
TRIED = (30.0, 60.0, 120.0, 240.0, 1000.0)  # samples a second
LONGER = 16  # records in a series of flicker
FRICTION_EVERY = 8  # so many records have friction that is looked for


@dataclass(frozen=True, eq=False)
class Sample:
    """A record with its truth."""

    record: Record
    motion: Motion
    camera: dict[str, float]

    @property
    def truth(self) -> dict[str, float]:
        """The true numbers, by the names of `values.list_values`."""
        motion, turned = self.motion, self.record.kind.name == "rates" and self.motion.top.Mgl < 0
        top, start = motion.top, motion.start
        spin, angles, rates = start.angular_velocity[2], start.euler_angles, start.euler_rates
        sign = -1.0 if turned else 1.0  # the vertical and Mgl change sign together
        found = {
            "Mgl/Ix": sign * top.Mgl / top.Ix,
            "p_psi/Ix": top.Iz * spin / top.Ix,
            "Iz/Ix": top.Iz / top.Ix,
            "spin": spin,
            "theta": np.pi - angles.theta if turned else angles.theta,
            "phi": angles.phi,
            "theta_dot": sign * rates.theta_dot,
            "phi_dot": sign * rates.phi_dot,
            "gravity": DEFAULT_GRAVITY,
            "axial/Iz": motion.friction.axial / top.Iz,
            "transverse/Ix": motion.friction.transverse / top.Ix,
            **{name: value for name, value in self.camera.items() if name != "log_scale"},
            "scale": float(np.exp(self.camera.get("log_scale", 0.0))),
        }
        if self.record.has_friction:
            found["spin_half_time"] = np.log(2) * top.Iz / motion.friction.axial
        else:
            found["mean_precession_rate"] = sign * motion.mean_precession_rate
            found["nutation_period"] = motion.nutation_period
        return {name: float(value) for name, value in found.items()}


def draw_motion(draw: Draw, has_friction: bool) -> Motion:
    """Return a random motion: of both signs of Mgl, rods and discs, fast and slow, hanging."""
    top = Top(
        1.0, float(draw.uniform(0.1, 1.9)), float(draw.uniform(20, 400) * draw.choice([1, -1]))
    )
    p = float(draw.uniform(4, 80) * draw.choice([1, -1]))
    phi_dot, theta_dot = (float(3 * draw.normal()) for _ in range(2))
    theta, phi = float(draw.uniform(0.25, 2.7)), float(draw.uniform(-3, 3))
    psi_dot = p / top.Iz - phi_dot * np.cos(theta)
    start = State.from_euler(
        theta=theta, phi=phi, phi_dot=phi_dot, theta_dot=theta_dot, psi_dot=float(psi_dot)
    )
    if not has_friction:
        return Motion(top, start)
    axial, transverse = draw.uniform(0.02, 0.2), draw.uniform(0.02, 0.2)
    return Motion(top, start, Friction(float(axial * top.Iz), float(transverse)))


def see(motion: Motion, kind: str, times: Real, camera: dict[str, float]) -> Real:
    """Return what a record of a kind shows at some times."""
    state = motion.at(times)
    if kind == "attitude":
        return np.asarray(state.orientation)
    if kind == "rates":
        return np.asarray(state.angular_velocity)
    if kind == "inertial":
        forces = specific_force(motion, state, POSITION)
        return np.concatenate([state.angular_velocity, forces], axis=1)
    axis = find_axis(state.orientation)
    if kind == "axis":
        return axis
    if kind == "pixels":
        return np.asarray(
            project(axis[None], {name: np.array([v]) for name, v in camera.items()})[0]
        )
    angles = state.euler_angles
    return np.stack([angles.theta, angles.phi][: 1 if kind == "theta" else 2], axis=1)


def draw_camera(draw: Draw) -> dict[str, float]:
    """Return a random camera above the horizon."""
    return {
        "u": float(draw.uniform(400, 800)),
        "v": float(draw.uniform(300, 500)),
        "log_scale": float(np.log(draw.uniform(150, 400))),
        "elevation": float(draw.uniform(0.2, 1.2)),
        "roll": float(0.05 * draw.normal()),
    }


def draw_sample(kind: str, noise: str, seed: int) -> Sample:
    """Return a random record of a kind, with a noise."""
    draw = np.random.default_rng([seed, SEEDED.index(kind), sorted(NOISES).index(noise)])
    has_friction = seed % FRICTION_EVERY == FRICTION_EVERY - 1 and kind != "theta"
    motion = draw_motion(draw, has_friction)
    rate, count = float(draw.choice(TRIED)), int(draw.integers(150, 500))
    if kind in {"rates", "inertial"}:
        rate = max(rate, 60.0)
    if kind == "attitude":  # whole turns from row to row are not seen
        rate = max(rate, 0.6 * abs(float(motion.start.angular_velocity[2])))
    times = np.arange(count) / rate
    camera = draw_camera(draw) if kind == "pixels" else {}
    make = NOISES[noise]
    times, values = make(draw, times, lambda t: see(motion, kind, t, camera), SIGMA[kind])
    position = POSITION if kind == "inertial" else (0.0, 0.0, 0.0)
    record = make_record(times, values, kind, has_friction=has_friction, position=position)
    return Sample(record, motion, camera)


See = Callable[[Real], Real]


def _whiten(draw: Draw, times: Real, show: See, sigma: float) -> tuple[Real, Real]:
    exact = show(times)
    return times, exact + sigma * draw.normal(size=exact.shape)


def _autoregress(draw: Draw, times: Real, show: See, sigma: float) -> tuple[Real, Real]:
    exact = show(times)
    noise = draw.normal(size=exact.shape)
    for row in range(1, len(noise)):
        noise[row] = 0.8 * noise[row - 1] + 0.6 * noise[row]
    return times, exact + sigma * noise


def _flicker(draw: Draw, times: Real, show: See, sigma: float) -> tuple[Real, Real]:
    """Noise whose power falls with the frequency, also below one swing in the record.

    The record is a part of a longer series: noise that began with it would have a smaller mean.
    """
    exact = show(times)
    series = draw.normal(size=(LONGER * len(times), exact.shape[1]))
    spectrum = np.fft.rfft(series, axis=0)
    frequency = np.maximum(np.arange(len(spectrum)), 1.0)[:, np.newaxis]
    noise = np.fft.irfft(spectrum / np.sqrt(frequency), len(series), axis=0)[: len(times)]
    return times, exact + sigma * noise / noise.std()


def _throw_out(draw: Draw, times: Real, show: See, sigma: float) -> tuple[Real, Real]:
    _, values = _whiten(draw, times, show, sigma)
    bad = draw.random(len(times)) < 0.05
    values[bad] += 30 * sigma * draw.normal(size=values[bad].shape)
    return times, values


def _round(draw: Draw, times: Real, show: See, sigma: float) -> tuple[Real, Real]:
    step = 2 * sigma
    return times, step * np.round(show(times) / step)


def _jitter(draw: Draw, times: Real, show: See, sigma: float) -> tuple[Real, Real]:
    step = times[1] - times[0]
    late = times + draw.uniform(-0.02, 0.02, len(times)) * step
    return times, _whiten(draw, late, show, sigma)[1]


def _lose(draw: Draw, times: Real, show: See, sigma: float) -> tuple[Real, Real]:
    """Stretches that are missing, a third of the record in all."""
    seen = np.ones(len(times), dtype=bool)
    for first in draw.integers(len(times) // 5, len(times), 3):
        seen[first : first + len(times) // 9] = False
    return _whiten(draw, times[seen], show, sigma)


def _spoil(draw: Draw, times: Real, show: See, sigma: float) -> tuple[Real, Real]:
    """A few lines that are wrong altogether."""
    _, values = _whiten(draw, times, show, sigma)
    values[draw.integers(0, len(times), 4)] *= -1.0
    return times, values


NOISES: dict[str, Callable[[Draw, Real, See, float], tuple[Real, Real]]] = {
    "white": _whiten,
    "AR(1)": _autoregress,
    "flicker": _flicker,
    "outliers": _throw_out,
    "rounded": _round,
    "jitter": _jitter,
    "missing": _lose,
    "wrong lines": _spoil,
}
