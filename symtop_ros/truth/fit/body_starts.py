"""Starts of the search for records of the body, as rates or attitudes, and of theta alone."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import numpy as np
from scipy.ndimage import median_filter
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real, compose, find_rotation_vectors, invert
from symtop_ros.truth.fit.across import measure_across, turn_upright
from symtop_ros.truth.fit.camera_starts import list_camera_starts
from symtop_ros.truth.fit.kinds import KINDS
from symtop_ros.truth.fit.model import Model, find_axis, name_parameters, point_along
from symtop_ros.truth.fit.record import Record
from symtop_ros.truth.fit.starts import Starts, fill, fill_axis_starts, list_axis_starts

RATIOS = (0.25, 1.0, 1.7)  # Iz/Ix of starts
ALLOWED = 0.01, 2.0  # Iz/Ix of bodies that spin
WHOLE = 0, 1, -1, 2, -2  # turns from row to row, besides those that are seen
FACTORS = np.linspace(0.85, 1.15, 7)  # factors of a constant that the rule of trapezoids gives
PAD = 8  # factor by which padding with zeros makes a spectrum finer


def list_starts(record: Record) -> Iterator[Starts]:
    """Yield starts for a record of any kind."""
    makers = {
        "rates": list_rate_starts,
        "across": list_across_starts,
        "attitude": list_attitude_starts,
        "theta": list_tilt_starts,
        "pixels": list_camera_starts,
    }
    return makers.get(record.kind.name, list_axis_starts)(record)


def list_rate_starts(record: Record) -> Iterator[Starts]:
    """Yield starts for the rates of the body, by linear least squares in a frame without spin.

    With W = wx + i wy, and the vertical G = gx + i gy, both seen from a frame that turns with the
    axis but does not spin, Euler's equations are W' = i (Iz/Ix) wz W - i (Mgl/Ix) G. Their
    integrals need no derivative of noise, and the vertical at the start is linear in them.
    """
    rates = median_filter(record.values, (3, 1), mode="nearest")
    spin = float(np.median(rates[:, 2]))
    columns, w = _integrate(record.times, record.values, rates[:, 2])
    x = np.linalg.lstsq(columns.reshape(-1, 6), w.ravel(), rcond=None)[0]
    weight = float(np.linalg.norm(x[1:4]))
    model = Model(record, turn_upright(np.asarray(x[1:4], dtype=float)))
    rows = [
        {"Mgl/Ix": weight, "Iz/Ix": ratio, "wx": x[4], "wy": x[5], "spin": spin}
        for ratio in (float(np.clip(x[0], 0.01, 1.99)), *RATIOS)
    ]
    yield Starts(model, np.array([fill(model, row) for row in rows]))


def _integrate(times: Real, rates: Real, spins: Real) -> tuple[Real, Real]:
    """Return columns (n, 2, 6) of the integrals: by Iz/Ix, by the vertical, and the first rates.

    Also return the rates across the axis, (n, 2), that they explain.
    """
    steps = np.diff(times)
    angle = _sum_up(spins[:, np.newaxis], steps)[:, 0]
    despun = (rates[:, 0] + 1j * rates[:, 1]) * np.exp(1j * angle)
    w = median_filter(np.stack([despun.real, despun.imag], axis=1), (3, 1), mode="nearest")
    across = np.column_stack([(w[1:] + w[:-1]) / 2, np.zeros(len(steps))])
    small = Rotation.from_rotvec(across * steps[:, np.newaxis])
    turned = [Rotation.identity()]
    for each in small:
        turned.append(turned[-1] * each)
    # turns the first vertical into later frames
    seen = Rotation.concatenate(turned).inv().as_matrix()
    by_ratio = _sum_up(np.median(spins) * np.stack([-w[:, 1], w[:, 0]], axis=1), steps)
    force = _sum_up((seen[:, [1, 0]] * np.array([[1.0], [-1.0]])).reshape(-1, 6), steps)
    first = np.broadcast_to(np.eye(2), (len(times), 2, 2))
    return np.concatenate([by_ratio[..., np.newaxis], force.reshape(-1, 2, 3), first], axis=2), w


def _sum_up(rows: Real, steps: Real) -> Real:
    """Return the integrals (n, m) of rows by the rule of trapezoids, from the first one on."""
    parts = (rows[1:] + rows[:-1]) / 2 * steps[:, np.newaxis]
    return np.concatenate([np.zeros((1, rows.shape[1])), np.cumsum(parts, axis=0)])


def list_across_starts(record: Record) -> Iterator[Starts]:
    """Yield starts for rates across the axis alone, by their constants of motion."""
    seen = measure_across(record.times, record.values[:, 0] + 1j * record.values[:, 1])
    ratio = record.known.get("Iz/Ix", (1.0, 0.0))[0]
    for factor in FACTORS:
        motion = replace(seen, k=factor * seen.k).find_motion(ratio)
        model = Model(record, np.asarray(motion.start.orientation))
        yield Starts(model, np.array([fill(model, name_parameters(motion))]))


def list_attitude_starts(record: Record) -> Iterator[Starts]:
    """Yield starts for attitudes: those of the axis, with the spin between two rows."""
    q = record.values
    turns = find_rotation_vectors(compose(invert(q[:-1]), q[1:])) / np.diff(record.times)[:, None]
    seen = float(np.median(turns[:, 2]))
    seen_axis = replace(record, kind=KINDS["axis"], values=find_axis(q))
    axis = fill_axis_starts(seen_axis, seen_axis.values)
    back = Rotation.from_quat(q[0][[1, 2, 3, 0]]).inv()
    back = back * Rotation.from_quat(axis.model.reference[[1, 2, 3, 0]])
    model, rows = Model(record, q[0]), []
    for start in axis.x:
        named = dict(zip(axis.model.names, start, strict=True))
        wx, wy, _ = back.apply([named["wx"], named["wy"], 0.0])
        p = named["p_psi/Ix"]
        for spin in [*list_spins(record, seen, p)] or [seen]:
            ratio = float(np.clip(p / spin, *ALLOWED))
            given = {"Mgl/Ix": named["Mgl/Ix"], "Iz/Ix": ratio, "spin": spin, "wx": wx, "wy": wy}
            rows.append(fill(model, given))
    yield Starts(model, np.array(rows))


def list_spins(record: Record, seen: float, p: float) -> Iterator[float]:
    """Yield the spin with the fewest whole turns between rows; if Iz/Ix is known, all spins.

    With p_psi/Ix = p a body must have Iz/Ix = p/spin.
    """
    spins = (seen + n * 2 * np.pi / record.step for n in WHOLE)
    allowed = (spin for spin in spins if spin and ALLOWED[0] < p / spin < ALLOWED[1])
    yield from allowed if "Iz/Ix" in record.known else islice(allowed, 1)


def list_tilt_starts(record: Record) -> Iterator[Starts]:
    """Yield starts for theta alone, by the frequency and the size of the nutation."""
    t, theta = record.times - record.times[0], record.values[:, 0]
    size, middle = float(np.ptp(theta)) / 2, float(np.sin(theta).mean())
    slope = float(np.polyfit(t[:5], theta[:5], 1)[0])
    model = Model(record, point_along(np.array([0.0, -np.sin(theta[0]), np.cos(theta[0])])))
    rows = [
        {"Mgl/Ix": sign * p * p * size / max(middle, 0.1), "p_psi/Ix": p, "wx": slope, "wy": kick}
        for p in find_nutation(t, theta) * np.array([0.2, 0.6, 0.8, 1.0, 1.2, 1.6])
        for kick in (0.0, 1.0, -1.0, 3.0, -3.0)
        for sign in (1.0, -1.0)
    ]
    yield Starts(model, np.array([fill(model, row) for row in rows]))


def find_nutation(times: Real, theta: Real) -> float:
    """Return the angular frequency with the most power in a tilt, at equal steps."""
    step = float(np.median(np.diff(times)))
    power = np.abs(np.fft.rfft(theta - theta.mean(), PAD * len(theta)))
    place = int(np.argmax(power[PAD // 2 :])) + PAD // 2
    return float(2 * np.pi * np.fft.rfftfreq(PAD * len(theta), step)[place])
