"""A judgement of estimates, and its figures as text and for JSON."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.judge.compare import PERCENTILES, Errors, compare
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.explain import Explanation, explain
from symtop_ros.judge.mistakes import find_mistakes
from symtop_ros.judge.truth import Truth
from symtop_ros.simulation.validation import RefusedError
from symtop_ros.wire.layout import NANOSECONDS

YEAR = 366 * 86_400 * NANOSECONDS
QUANTITIES = {  # name -> label
    "attitude": "attitude (rad)",
    "tilt": "tilt (rad)",
    "heading": "heading (rad)",
    "angular_velocity": "ang. vel. (rad/s)",
}


@dataclass(frozen=True, eq=False)
class Judgement:
    """Errors of the estimates of one source."""

    source: str  # topic or file
    errors: Errors  # after what was removed
    found: Explanation
    removed: tuple[str, ...]  # "offset", "delay" and "drift", if they were taken away
    left_out: int  # messages without a readable attitude
    notes: tuple[str, ...]  # likely mistakes, and what is odd about the file

    @property
    def largest(self) -> float:
        """Largest error of the attitude in rad."""
        return float(self.errors.total.max())

    def facts(self) -> dict[str, Any]:
        """Return all figures, for JSON."""
        errors, offset = self.errors, self.found.offset
        quantities = {
            "attitude": errors.total,
            "tilt": errors.tilt,
            "heading": np.abs(errors.heading),
        }
        if errors.rate is not None:
            quantities["angular_velocity"] = errors.rate
        world, body = offset.angles
        return {
            "source": self.source,
            "estimates": len(errors.total),
            "unknown": errors.unknown,
            "after_the_run": errors.late,
            "left_out": self.left_out,
            "seconds": float(errors.seconds[-1]),
            "removed": list(self.removed),
            **{name: summarize(values) for name, values in quantities.items()},
            "growth_rms": [None if np.isnan(x) else float(x) for x in errors.growth()],
            "found": {
                "delay": None if "delay" in self.found.hidden else offset.delay,
                "drift": None if "drift" in self.found.hidden else offset.drift,
                "world_offset": {"angle": world, "w_x_y_z": offset.world.tolist()},
                "body_offset": {"angle": body, "w_x_y_z": offset.body.tolist()},
                "not_identifiable": list(self.found.hidden),
                "residual_rms": self.found.residual,
            },
            "notes": list(self.notes),
        }

    def format(self) -> str:
        """Return the figures as a table of text."""
        facts = self.facts()
        removed = f", {' and '.join(self.removed)} removed" if self.removed else ""
        growth = [x for x in facts["growth_rms"] if x is not None]
        lines = [
            f"{self.source}: {facts['estimates']} estimates in {facts['seconds']:.6g} s{removed}",
            _head(18),
            *(_row(QUANTITIES[name], 18, facts[name]) for name in QUANTITIES if name in facts),
            f"attitude, rms: {growth[0]:.2e} rad in the first tenth, {growth[-1]:.2e} in the last",
            self._explain(),
            *self._remarks(),
        ]
        return "\n".join(lines)

    def _explain(self) -> str:
        """Return what explains the errors, and what the motion hides, in sentences."""
        offset, hidden = self.found.offset, self.found.hidden
        world, body = offset.angles
        parts = [
            *([] if "delay" in hidden else [f"a delay of {offset.delay * 1e3:.4g} ms"]),
            *([] if "drift" in hidden else [f"a drift of {offset.drift:.3g} rad/s"]),
            f"a rotation of the world by {world:.2e} rad and of the body by {body:.2e} rad",
        ]
        text = f"best explained by {', '.join(parts)}; it leaves {self.found.residual:.2e} rad rms"
        return "\n".join([text, *(f"not identifiable: {HIDDEN[name]}" for name in hidden)])

    def _remarks(self) -> list[str]:
        counts = (
            (self.errors.unknown, "before the run or out of reach of its integration"),
            (self.errors.late, "after the last sample of the run"),
            (self.left_out, "without a readable attitude"),
        )
        left_out = [f"left out: {number} estimates {what}" for number, what in counts if number]
        return [*left_out, *(f"note: {note}" for note in self.notes)]


HIDDEN = {
    "delay": "the delay (in this steady motion it is the same as constant rotations)",
    "drift": "the drift (it is the same as constant rotations)",
    "rotations": "the rotations of world and body alone (only together)",
}


def judge(
    estimates: Estimates, truth: Truth, source: str, removed: tuple[str, ...] = ()
) -> Judgement:
    """Compare estimates with the exact motion; `removed` may name "offset", "delay", "drift"."""
    if not len(compare(estimates, truth).total):
        raise RefusedError(_describe_absence(estimates, truth, source))
    found = explain(estimates, truth)
    wanted = {
        "rotations": "offset" in removed,
        "delay": "delay" in removed,
        "drift": "drift" in removed,
    }
    taken = found if all(wanted.values()) else explain(estimates, truth, **wanted)
    errors = compare(estimates, truth, taken.offset)
    mistakes = find_mistakes(estimates, truth, found.offset, found.residual)
    notes = *(f"likely mistake: {each}" for each in mistakes), *estimates.notes
    return Judgement(source, errors, found, removed, estimates.left_out, notes)


def _describe_absence(estimates: Estimates, truth: Truth, source: str) -> str:
    """Return why there is nothing to judge, with both spans of time."""
    notes = "".join(f"; {note}" for note in estimates.notes)
    if not len(estimates):
        return f"{source} must have an attitude, got none of {estimates.left_out}{notes}"
    times = [estimates.stamps[0], estimates.stamps[-1], truth.begin or 0, truth.end]
    spans = (None if t is None else f"{int(t) / NANOSECONDS:.3f} s" for t in times)
    first, last, begin, end = spans
    hint = "; times count from 0" if estimates.stamps[0] < YEAR <= (truth.begin or 0) else ""
    return (
        f"{source} must have stamps within the run, {begin} to {end or 'any later time'}, "
        f"got {first} to {last}{hint}{notes}"
    )


def format_several(judgements: Sequence[Judgement]) -> str:
    """Return one table of the attitude errors of several sources."""
    width = max(len(each.source) for each in judgements)
    rows = [_row(each.source, width, each.facts()["attitude"]) for each in judgements]
    notes = [
        f"{each.source}: {line}"
        for each in judgements
        for line in [*each._explain().splitlines(), *each._remarks()]
    ]
    return "\n".join([f"{'attitude (rad)':{width}}{_head(0)}", *rows, *notes])


def _head(width: int) -> str:
    return f"{'':{width}}{'rms':>10}{'mean':>10}" + "".join(f"{f'{p} %':>10}" for p in PERCENTILES)


def _row(label: str, width: int, summary: dict[str, float]) -> str:
    return f"{label:{width}}" + "".join(f"{x:10.2e}" for x in summary.values())


def summarize(values: NDArray[np.float64]) -> dict[str, float]:
    """Return root mean square, mean and percentiles."""
    marks = np.percentile(values, PERCENTILES).tolist()
    return {
        "rms": float(np.sqrt((values**2).mean())),
        "mean": float(values.mean()),
        **{f"p{p}": float(x) for p, x in zip(PERCENTILES, marks, strict=True)},
    }
