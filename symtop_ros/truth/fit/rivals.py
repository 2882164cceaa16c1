"""Models for a record that one free motion does not explain: linear friction, or a kick.

The three models are compared with the same noise model, that of the motion with a kick, which has
the smallest residuals: the correlated noise of another model would include the effect of friction
or of a kick. A kick that does not exist has no time, so its gain by chance does not follow the
chi-squared distribution (Davies 1987; Andrews 1993). The gain at the best time is simulated, with
white noise added to one motion.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.stats import chi2

from symtop_ros.base.arrays import Real
from symtop_ros.truth.fit.aliases import RATES
from symtop_ros.truth.fit.check import HOLDS, Check
from symtop_ros.truth.fit.fitting import choose_twin, is_better, sum_squares
from symtop_ros.truth.fit.kicks import find_best, find_reach
from symtop_ros.truth.fit.model import FRICTION, KICK, Model
from symtop_ros.truth.fit.record import FEWEST, Record
from symtop_ros.truth.fit.refine import Fit, find_noise, fit_weighted, refine
from symtop_ros.truth.fit.search import list_bounds
from symtop_ros.truth.fit.starts import fill

SURE = 0.999  # part of the records of one free motion in which the gain by chance is smaller
# Factor on the gain by chance. The noise is estimated together with the kick, which makes gains
# larger: with correlated noise one record in thirty gained a tenth more than one in a thousand does
# with white noise.
CLEAR = 1.5
DRAWS = 1000  # of white noise
PLACES = 40  # of a kick, that are tried
MANY = 2000  # rows in which rivals are looked for
TRIED = 3  # places that are followed by least squares
SLIGHT = 1e-6  # change of the rates for a derivative, relative to their size
STEPS = 3  # steps before and after a kick that are tried, if rates jump
BESIDE = 1e-4  # smallest distance of a kick from a row, in steps
LOSES = 5.0  # deviations by which friction is not zero


@dataclass(frozen=True, eq=False)
class Rival:
    """A motion with more parameters, compared with one free motion.

    Attributes
    ----------
    kind : str
        "friction" or "kick".
    fit : Fit
    gain : float
        Reduction of the sum of squared residuals, in squared deviations.
    needed : float
        Gain that one record of a thousand has by chance.
    """

    kind: str
    fit: Fit
    gain: float
    needed: float

    @property
    def is_clear(self) -> bool:
        """True if it explains more than chance does."""
        return self.margin > 0

    @cached_property
    def explains(self) -> bool:
        """True if its residuals are noise, and both halves have the same constants."""
        return self.is_clear and Check(self.fit).verdict == HOLDS

    @property
    def margin(self) -> float:
        """Gain beyond the gain that is needed to exceed chance."""
        return self.gain - CLEAR * self.needed

    @property
    def loses_spin(self) -> bool:
        """True if the loss of spin by friction is far larger than its deviation."""
        if self.kind != "friction":
            return False
        place = self.fit.model.place[FRICTION[0]]
        deviation = self.fit.find_deviation(np.eye(len(self.fit.x))[place])
        return self.is_clear and bool(self.fit.x[place] > LOSES * deviation)


def find_rivals(fit: Fit, check: Check) -> list[Rival]:
    """Return the rivals that explain more than one free motion, the clearest first.

    Rivals are tried if the residuals are not white noise; for a long record, in a part of its rows.
    """
    record = fit.model.record
    is_white = check.verdict == HOLDS and not len(fit.noise.partial)
    if is_white or record.has_friction or len(record) < 4 * FEWEST:
        return []
    if len(record) > MANY:
        part = refine(fit.model.move(record.thin(MANY)), fit.x)
        return [extend(each, record) for each in compare(part, check)]
    return compare(fit, check)


def find_calm(fit: Fit, rivals: Sequence[Rival]) -> Fit:
    """Return the free motion next to a rival if its residuals are smaller; else the fit.

    All searches may have missed this motion: then a rival gains much with a kick close to zero.
    """
    for rival in rivals:
        calm = choose_twin(refine(*_move(rival.fit, fit.model.record)))
        if is_better(calm, fit):
            fit = calm
    return fit


def extend(rival: Rival, record: Record) -> Rival:
    """Return a rival that was found in a part of a record, fitted to all of it."""
    model = rival.fit.model
    whole = replace(model.record, times=record.times, values=record.values)
    return replace(rival, fit=refine(model.move(whole), rival.fit.x))


def compare(fit: Fit, check: Check) -> list[Rival]:
    """Return the rivals of a motion that explain more than chance does, the clearest first."""
    record = fit.model.record
    # a weak kick makes the noise seem correlated, and is found by its linear effect
    is_slight = check.verdict == HOLDS
    kicked = fit_kick(fit, [] if is_slight else [*find_beginning(record)])
    rubbed = fit_friction(fit, is_slight)
    # each with the noise of the model with most parameters, that with a kick
    own = measure(kicked, fit)
    found = [
        Rival("kick", kicked, own - measure(kicked, kicked), find_chance(kicked, fit)),
        Rival("friction", rubbed, own - measure(kicked, rubbed), float(chi2.ppf(SURE, 2))),
    ]
    clear = [each for each in found if each.is_clear]
    return sorted(clear, key=lambda each: each.margin, reverse=True)


def find_beginning(record: Record) -> Iterator[Fit]:
    """Yield the motion of the first rows, as far as one explains them."""
    first = find_reach(record)
    if first is not None and FEWEST <= first < len(record):
        part = record.select(slice(first))
        found = find_best(part)
        yield refine(found.model.move(part), found.x)


def measure(noise: Fit, fit: Fit) -> float:
    """Return the sum of squared residuals of a model, with the noise of another fit."""
    x = fit_weighted(fit.model, fit.x, noise.noise)
    return sum_squares(noise, fit.model.find_residuals(x))


def fit_friction(fit: Fit, is_slight: bool) -> Fit:
    """Return the best motion with friction: next to the fit, or also by a search if not slight."""
    record = replace(fit.model.record, has_friction=True)
    starts = [_move(fit, record)]
    if not is_slight:
        found = find_best(record)
        starts.append((found.model.move(record), found.x))
    return _choose([refine(*each) for each in starts])


def fit_kick(fit: Fit, beginnings: Sequence[Fit]) -> Fit:
    """Return the best motion with a kick: a weak one, or one where the first motion ends."""
    record = replace(fit.model.record, has_kick=True)
    starts = [add_kick(*_move(fit, record), place) for place in rate_places(whiten_plainly(fit))]
    starts += [join(each, record) for each in beginnings]
    best = _choose([refine(*start) for start in starts])
    # once more with the noise of that fit: the correlated residuals of one motion may be the kick
    free = Fit(fit.model, fit_weighted(fit.model, fit.x, best.noise), best.noise)
    starts = [add_kick(*_move(free, record), place) for place in rate_places(free)]
    best = _choose([best, *(refine(*start) for start in starts)])
    return settle_time(best) if record.kind.name in RATES else best


def whiten_plainly(fit: Fit) -> Fit:
    """Return the fit with its noise treated as white."""
    return Fit(fit.model, fit.x, find_noise(fit.model, fit.x, lasts=False))


def settle_time(fit: Fit) -> Fit:
    """Return the fit with the time of its kick known to a step, if rates jump there.

    Rates may hardly show at which time between two rows the kick was; a time beyond these rows
    leaves the whole jump as a residual. So the time counts as a known number with the deviation of
    rounding to the step. It is kept off the rows, where the derivative would be that of the jump.
    """
    fit = _choose([fit, *try_steps(fit)])
    record, place = fit.model.record, fit.model.place["kick_time"]
    times = record.times - record.times[0]
    row = int(np.clip(np.searchsorted(times, fit.x[place]), 1, len(times) - 1))
    step = times[row] - times[row - 1]
    x = fit.x.copy()
    x[place] = np.clip(x[place], times[row - 1] + BESIDE * step, times[row] - BESIDE * step)
    known = {**record.known, "kick_time": (float(x[place]), float(step / np.sqrt(12)))}
    return replace(fit, model=fit.model.move(replace(record, known=known)), x=x)


def try_steps(fit: Fit) -> Iterator[Fit]:
    """Yield the motions with a kick some steps before and after."""
    place = fit.model.place["kick_time"]
    for steps in range(-STEPS, STEPS + 1):
        x = fit.x.copy()
        x[place] += steps * fit.model.record.step
        x = np.clip(x, *list_bounds(fit.model))
        yield replace(fit, x=fit_weighted(fit.model, x, fit.noise))


def join(before: Fit, record: Record) -> tuple[Model, Real]:
    """Return the motion of the first rows, with the kick that leads to that of the others."""
    model, x = _move(before, record)
    rest = replace(record.select(slice(len(before.model.record), None)), has_kick=False)
    found = find_best(rest)
    place = float(rest.times[0] - record.times[0])
    first, second = before.model.find_motion(before.x).at(place), found.model.find_motion(found.x)
    if record.kind.shows_spin:  # the body is the same, and the azimuth of the other may differ
        change = first.to_world(second.start.angular_velocity - first.angular_velocity)
    else:
        change = second.start.to_world(second.start.angular_velocity)
        change = change - first.to_world(first.angular_velocity)
    x[model.place["kick_time"]] = place
    x[[model.place[name] for name in KICK[1:]]] = change
    return model, x


def _move(fit: Fit, record: Record) -> tuple[Model, Real]:
    """Return the model of another record about the same start, and its parameters."""
    model = Model(record, fit.model.reference)
    return model, fill(model, dict(zip(fit.model.names, fit.x.tolist(), strict=True)))


def _choose(found: Sequence[Fit]) -> Fit:
    """Return the best fit, by the noise of the one with the smallest mean residual."""
    best = min(found, key=lambda each: float(np.abs(each.residuals).mean()))
    return min(found, key=lambda each: sum_squares(best, each.residuals))


def add_kick(model: Model, x: Real, place: float) -> tuple[Model, Real]:
    """Return parameters with a kick at a place, as large as its linear effect says."""
    x = x.copy()
    x[model.place["kick_time"]] = place
    slopes, left = _derive_kick(model, x, place), model.find_residuals(x)
    size = np.median(np.abs(left), axis=0) + 1e-300  # outliers do not count
    usual = (np.abs(left) < 10 * size).all(axis=1)
    columns = (slopes[usual] / size[:, np.newaxis]).reshape(-1, len(KICK) - 1)
    change = np.linalg.lstsq(columns, -(left[usual] / size).ravel(), rcond=None)[0]
    x[[model.place[name] for name in KICK[1:]]] = change
    return model, x


def _derive_kick(model: Model, x: Real, place: float) -> Real:
    """Return the derivatives (n, r, 3) of the residuals by a change of the rates at a place."""
    rates = SLIGHT * float(model.find_scales(x)[model.place["wx"]])
    moved = np.tile(x, (4, 1))
    moved[:, model.place["kick_time"]] = place
    for k, name in enumerate(KICK[1:]):
        moved[:, model.place[name]] = 0.0
        moved[k + 1, model.place[name]] = rates
    left = model.compare(model.show(moved))
    slopes = [model.subtract(each, left[0]) / rates for each in left[1:]]
    return np.stack(slopes, axis=-1)


def list_places(fit: Fit) -> Real:
    """Return times at which a kick is tried, in s after the first row."""
    times = fit.model.record.times - fit.model.record.times[0]
    rows = np.linspace(FEWEST, len(times) - 1 - FEWEST, PLACES).astype(int)
    return np.asarray(times[np.unique(rows)] - fit.model.record.step / 2)


def rate_places(fit: Fit) -> list[float]:
    """Return the places at which a kick makes the squares smallest, to first order."""
    bases, places = _span_kicks(fit)
    white = fit.noise.whiten(fit.residuals).ravel()
    gains = ((bases @ white) ** 2).sum(axis=1)
    # those of the highest peaks: next to the best place all are good
    peaks = np.flatnonzero((gains >= np.roll(gains, 1)) & (gains >= np.roll(gains, -1)))
    best = peaks[np.argsort(gains[peaks])[::-1][:TRIED]]
    return [*map(float, places[best])]


def _span_kicks(fit: Fit) -> tuple[Real, Real]:
    """Return what kicks at places do that no other motion does: bases (m, 3, n r), and places."""
    model, x = _move(fit, replace(fit.model.record, has_kick=True))
    free = np.linalg.qr(fit.columns.reshape(-1, len(fit.x)) / fit.sizes)[0]
    places, bases = list_places(fit), []
    for place in places.tolist():
        columns = fit.noise.whiten(_derive_kick(model, x, place)).reshape(len(free), -1)
        columns /= np.linalg.norm(columns, axis=0) + 1e-300
        columns -= free @ (free.T @ columns)
        bases.append(np.linalg.svd(columns, full_matrices=False)[0].T)
    return np.array(bases), places


def find_chance(kicked: Fit, fit: Fit) -> float:
    """Return the gain that a kick at the best place has by chance, once in a thousand records."""
    free = Fit(fit.model, fit_weighted(fit.model, fit.x, kicked.noise), kicked.noise)
    bases, places = _span_kicks(free)
    # white noise seen along the bases is normal, with their products as covariance
    columns = bases.reshape(-1, bases.shape[2])
    values, vectors = np.linalg.eigh(columns @ columns.T)
    draw = np.random.default_rng(1).normal(size=(len(values), DRAWS))
    seen = vectors @ (np.sqrt(np.maximum(values, 0.0))[:, np.newaxis] * draw)
    gains = (seen.reshape(len(places), -1, DRAWS) ** 2).sum(axis=1).max(axis=0)
    return float(np.quantile(gains, SURE))
