"""Random records with their truth: clean ones, and those of a fault that the fit does not model."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from workshop.records.bodies import Body, Course, Kick, Real, place_body
from workshop.records.cameras import Camera
from workshop.records.sensors import Gyroscope

Draw = np.random.Generator
FRAMES, SAMPLES = 120.0, 200.0  # a second, of a film and of a sensor
SECONDS = 3.0
RANGES = np.radians([125.0, 250.0, 500.0, 1000.0, 2000.0])  # rad/s, of sensors that one can buy
FINE = 4000  # rows a second, among which the highest places of an axis are looked for
PIXELS = (0.2, 0.5, 1.0)  # deviations of the noise
AXES, RATES = 0.003, 0.02  # the same in lengths of the axis, and in rad/s


@dataclass(frozen=True)
class Drawn:
    """A record as a table, what `top_fit` is told of it, and the truth.

    Attributes
    ----------
    columns : mapping
        Of names to numbers (n,).
    options : tuple of str
        Of `top_fit`.
    truth : mapping
        True numbers by the names that `top_fit` prints; without those that there are not, as the
        momentum of a body that no axis is symmetric about.
    """

    columns: Mapping[str, Real]
    options: tuple[str, ...] = ()
    truth: Mapping[str, float] = field(default_factory=dict)

    def write(self, path: Path) -> None:
        """Write the table."""
        rows = zip(*(each.tolist() for each in self.columns.values()), strict=True)
        lines = [",".join(self.columns), *(",".join(f"{each:.9g}" for each in row) for row in rows)]
        path.write_text("\n".join([*lines, ""]), encoding="utf-8")


@dataclass(frozen=True)
class Start:
    """A body and how it is let go: tilt and azimuth in rad, rates of the body in rad/s."""

    body: Body
    theta: float
    phi: float
    rates: tuple[float, float, float]

    def follow(self, kicks: tuple[Kick, ...] = ()) -> Course:
        """Return its motion, somewhat longer than a record."""
        matrix = place_body(self.theta, self.phi)
        return Course(self.body, matrix, np.asarray(self.rates), 1.1 * SECONDS, kicks)

    @property
    def truth(self) -> dict[str, float]:
        """Constants of the motion and the state of the first row."""
        Ix, _, Iz = self.body.moments
        x, y, spin = self.rates
        return {
            "Mgl/Ix": self.body.weight / Ix,
            "p_psi/Ix": Iz * spin / Ix,
            "theta": self.theta,
            "theta_dot": x,
            "phi_dot": y / np.sin(self.theta),
        }


def draw_start(draw: Draw) -> Start:
    """Return a top with a nutation of some degrees, as one kicks it by hand."""
    ratio, weight = draw.uniform(0.3, 1.6), draw.uniform(40, 300)
    momentum = draw.uniform(14, 45) * draw.choice([1, -1])
    theta = float(draw.uniform(0.35, 1.1))
    across = weight / momentum * np.sin(theta) + draw.choice([1, -1]) * draw.uniform(0.7, 2.5)
    body = Body((1.0, 1.0, float(ratio)), float(weight))
    rates = float(draw.normal()), float(across), float(momentum / ratio)
    return Start(body, theta, float(draw.uniform(-3, 3)), rates)


def draw_camera(draw: Draw, height: float) -> Camera:
    """Return a camera some lengths away, above the pivot, that looks so high above the pivot."""
    distance, elevation = draw.uniform(3, 9), np.radians(draw.uniform(20, 50))
    place = 0.0, float(-distance * np.cos(elevation)), float(distance * np.sin(elevation))
    focal = float(draw.uniform(180, 300) * distance)
    return Camera(place, (0.0, 0.0, height), focal, roll=float(0.03 * draw.normal()))


def film(draw: Draw, start: Start, camera: Camera, *options: str) -> Drawn:
    """Return points of the axis in a film."""
    times = np.arange(round(SECONDS * FRAMES)) / FRAMES
    seen = camera.film(start.follow(), times)
    u, v = (seen + draw.choice(PIXELS) * draw.normal(size=seen.shape)).T
    known = {"nearness": 1 / camera.distance, "elevation": camera.elevation}
    return Drawn({"t": times, "u": u, "v": v}, ("--perspective", *options), start.truth | known)


def observe(draw: Draw, start: Start, kicks: tuple[Kick, ...] = ()) -> Drawn:
    """Return points of the axis in space."""
    times = np.arange(round(SECONDS * FRAMES)) / FRAMES
    axes = start.follow(kicks).at(times)[0][:, :, 2]
    x, y, z = (axes + AXES * draw.normal(size=axes.shape)).T
    return Drawn({"t": times, "x": x, "y": y, "z": z}, (), start.truth)


def sense(draw: Draw, start: Start, sensor: Gyroscope, kicks: tuple[Kick, ...] = ()) -> Drawn:
    """Return the rates that a gyroscope on the body shows."""
    times = np.arange(round(SECONDS * SAMPLES)) / SAMPLES
    rates = start.follow(kicks).at(times)[1]
    wx, wy, wz = sensor.measure(rates, RATES * draw.normal(size=rates.shape)).T
    Ix, _, Iz = start.body.moments
    truth = {name: start.truth[name] for name in ("Mgl/Ix", "p_psi/Ix", "theta")}
    more = {"Iz/Ix": Iz / Ix, "spin": start.rates[2]}
    return Drawn({"t": times, "wx": wx, "wy": wy, "wz": wz}, (), truth | more)


def _aim(draw: Draw) -> Camera:
    """Return a camera that looks at the middle of the top, as nearly all do."""
    return draw_camera(draw, 0.5)


def _measure(camera: Camera) -> tuple[str, ...]:
    return "--size", *map(str, camera.size)


def _film_with(**fault: object) -> Callable[[Draw], Drawn]:
    """Return a draw of films of a camera with one fault, of which the size is known."""

    def make(draw: Draw) -> Drawn:
        start, camera = draw_start(draw), _aim(draw)
        return film(draw, start, replace(camera, **fault), *_measure(camera))  # type: ignore[arg-type]

    return make


def _film_level(draw: Draw) -> Drawn:
    return film(draw, draw_start(draw), draw_camera(draw, 0.0))


def _film_aimed(draw: Draw) -> Drawn:
    return film(draw, draw_start(draw), _aim(draw))


def _film_far(draw: Draw) -> Drawn:
    camera = draw_camera(draw, 0.5)
    place = tuple(20.0 * each for each in camera.place)
    far = replace(camera, place=place, focal=20.0 * camera.focal)  # type: ignore[arg-type]
    return film(draw, draw_start(draw), far, *_measure(far))


def _slow_clock(draw: Draw) -> Drawn:
    """Film of 29.97 frames a second, whose times are those of 30."""
    camera = _aim(draw)
    drawn = film(draw, draw_start(draw), camera, *_measure(camera))
    return replace(drawn, columns={**drawn.columns, "t": drawn.columns["t"] * (29.97 / 30)})


def _split(start: Start) -> Start:
    Ix, _, Iz = start.body.moments
    return replace(start, body=replace(start.body, moments=(Ix, 1.02 * Ix, Iz)))


def _asymmetric(draw: Draw) -> Drawn:
    drawn = sense(draw, _split(draw_start(draw)), Gyroscope())
    return replace(drawn, truth={})


def _asymmetric_axis(draw: Draw) -> Drawn:
    return replace(observe(draw, _split(draw_start(draw))), truth={})


def _draw_kick(draw: Draw) -> tuple[Kick, ...]:
    angle = draw.uniform(-np.pi, np.pi)
    change = 0.15 * np.cos(angle), 0.15 * np.sin(angle), 0.0
    return (Kick(float(draw.uniform(0.35, 0.65) * SECONDS), change),)


def _kicked(draw: Draw) -> Drawn:
    return observe(draw, draw_start(draw), _draw_kick(draw))


def _kicked_rates(draw: Draw) -> Drawn:
    return sense(draw, draw_start(draw), Gyroscope(), _draw_kick(draw))


def _slow(start: Start, dry: float, linear: float) -> Start:
    """Return a start that loses parts of its spin in a record, by dry and by linear friction."""
    Ix, _, Iz = start.body.moments
    torque = dry * Iz * abs(start.rates[2]) / SECONDS
    rate = linear / SECONDS
    friction = rate * Iz, rate * Ix / 4
    return replace(start, body=replace(start.body, dry=float(torque), linear=friction))


def _rub_dry(draw: Draw) -> Drawn:
    return observe(draw, _slow(draw_start(draw), 0.05, 0.0))


def _rub_dry_rates(draw: Draw) -> Drawn:
    return sense(draw, _slow(draw_start(draw), 0.05, 0.0), Gyroscope())


def _rub(draw: Draw) -> Drawn:
    return observe(draw, _slow(draw_start(draw), 0.0, 0.05))


def _sense_with(**fault: object) -> Callable[[Draw], Drawn]:
    def make(draw: Draw) -> Drawn:
        return sense(draw, draw_start(draw), Gyroscope(**fault))  # type: ignore[arg-type]

    return make


def find_nutation(start: Start) -> float:
    """Return the mean time between the highest places of an axis, in s."""
    times = np.arange(round(SECONDS * FINE)) / FINE
    heights = start.follow().at(times)[0][:, 2, 2]
    before, here, after = heights[:-2], heights[1:-1], heights[2:]
    tops = np.flatnonzero((before < here) & (here >= after))
    curves = before[tops] - 2 * here[tops] + after[tops]
    places = tops + 1 + (before[tops] - after[tops]) / (2 * curves)
    return float((places[-1] - places[0]) / (len(places) - 1) / FINE)


def _cut_spin(draw: Draw) -> Drawn:
    """Rates with the spin beyond a range of sensors, or beyond any other limit."""
    start = draw_start(draw)
    spin = abs(start.rates[2])
    below = RANGES[0.95 * spin > RANGES]
    limit = below[-1] if len(below) and draw.uniform() < 0.5 else draw.uniform(0.5, 0.95) * spin
    drawn = sense(draw, start, Gyroscope(limit=float(limit)))
    ratio = drawn.truth["Iz/Ix"] + 1e-4 * draw.normal()
    known = ("--Iz-Ix", f"{ratio:.9f}", "1e-4") if draw.uniform() < 0.5 else ()
    constant = (2 - drawn.truth["Iz/Ix"]) * start.rates[2]
    more = {"nutation_period": find_nutation(start), "cut": constant}
    return replace(drawn, options=known, truth={**drawn.truth, **more})


def _cut_swings(draw: Draw) -> Drawn:
    """Rates whose spin is within the range, and whose largest rates across the axis are not."""
    start = draw_start(draw)
    start = replace(start, rates=(start.rates[0], start.rates[1], start.rates[2] / 8))
    rates = np.abs(start.follow().at(np.arange(600) / SAMPLES)[1])
    across = rates[:, :2].max()
    limit = max(0.85 * across, 1.05 * abs(start.rates[2]))
    return sense(draw, start, Gyroscope(limit=float(limit)))


#: Records without a fault, by name.
CLEAN: dict[str, Callable[[Draw], Drawn]] = {
    "axis": lambda draw: observe(draw, draw_start(draw)),
    "rates": lambda draw: sense(draw, draw_start(draw), Gyroscope()),
    "film, aim known": _film_with(),
    "film, at the pivot": _film_level,
    "film, far away": _film_far,
}
#: Records of one fault each.
FAULTS: dict[str, Callable[[Draw], Drawn]] = {
    "aim": _film_aimed,
    "barrel": _film_with(barrel=0.01),
    "stretch": _film_with(stretch=0.01),
    "shutter": _film_with(shutter=0.008),
    "rolling shutter": _film_with(readout=0.02),
    "crop": _film_with(crop=(120.0, 40.0)),
    "mirrored": _film_with(is_mirrored=True),
    "time base": _slow_clock,
    "asymmetric, rates": _asymmetric,
    "asymmetric, axis": _asymmetric_axis,
    "kick, axis": _kicked,
    "kick, rates": _kicked_rates,
    "dry friction, axis": _rub_dry,
    "dry friction, rates": _rub_dry_rates,
    "linear friction, axis": _rub,
    "gains": _sense_with(gains=(1.0, 1.02, 1.0)),
    "tilted sensor": _sense_with(tilt=(0.01, 0.005, 0.0)),
    "spin beyond the range": _cut_spin,
    "swings beyond the range": _cut_swings,
}


def draw_record(name: str, seed: int) -> Drawn:
    """Return a record of a name of CLEAN or FAULTS."""
    names = [*CLEAN, *FAULTS]
    make = (CLEAN | FAULTS)[name]
    return make(np.random.default_rng([seed, names.index(name)]))
