"""A judgement of estimates, and its figures as text and for JSON."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.judge.causes import Cause, Finding
from symtop_ros.truth.judge.compare import NONE, PERCENTILES, Errors, Offset, compare
from symtop_ros.truth.judge.mistakes import find_mistakes
from symtop_ros.truth.judge.named_causes import align, explain, find_nearest
from symtop_ros.truth.judge.outliers import count_outliers, trim
from symtop_ros.truth.judge.relative import LABEL, Relative, measure_relative
from symtop_ros.truth.judge.search import find_causes
from symtop_ros.truth.judge.sentences import choose_key, list_parts, list_sentences, write_fault
from symtop_ros.truth.judge.summary import format_row, summarize
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.topics.estimates import Estimates
from symtop_ros.words import write

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
    found: Finding | None  # None: nothing was looked for
    aligned: str | None  # the model that was stated in place of it, and its least squares
    fitted: Cause | None
    removed: tuple[str, ...]  # "offset", "delay" and "drift", if they were taken away
    left_out: int  # messages without a readable attitude
    notes: tuple[str, ...]  # likely mistakes, and what is odd about the file
    outliers: int = 0  # estimates that are far off what explains the others
    robust: bool = False  # True: they were left out of it
    relative: Relative | None = None  # errors of turns over a lag

    def facts(self) -> dict[str, Any]:
        """Return all figures, for JSON."""
        errors = self.errors
        return {
            "source": self.source,
            "estimates": len(errors.total),
            "unknown": errors.unknown,
            "not_judged": errors.unjudged,
            "before_the_run": errors.early,
            "after_the_run": errors.late,
            "left_out": self.left_out,
            "seconds": float(errors.seconds[-1]),
            "removed": list(self.removed),
            **{name: summarize(values) for name, values in errors.quantities.items()},
            "relative": self.relative.facts() if self.relative else None,
            "growth_rms": [None if np.isnan(x) else float(x) for x in errors.growth()],
            "aligned": self.aligned,
            "fitted": None if self.fitted is None else _describe_cause(self.fitted),
            "found": None if self.found is None else _describe_finding(self.found),
            "outliers": self.outliers,
            "robust": self.robust,
            "notes": list(self.notes),
        }

    def format(self) -> str:
        """Return the figures as a table of text."""
        facts = self.facts()
        removed = f", {' and '.join(self.removed)} removed" if self.removed else ""
        growth = [x for x in facts["growth_rms"] if x is not None]
        lines = [
            f"{self.source}: {write_count(facts['estimates'], 'estimate')} in "
            f"{facts['seconds']:.6g} s{removed}",
            _head(LABEL),
            *(format_row(label, LABEL, facts[k]) for k, label in QUANTITIES.items() if k in facts),
            *([self.relative.format()] if self.relative else []),
            f"attitude, rms: {growth[0]:.2e} rad in the first tenth, {growth[-1]:.2e} in the last",
            self._explain(),
            *self._remarks(),
        ]
        return "\n".join(lines)

    def _explain(self) -> str:
        """Return what explains the errors, and what the motion hides, in sentences."""
        if self.found is None:
            parts = list_parts(self.fitted) if self.fitted else []
            record = {
                "model": self.aligned,
                "parts": {"several": parts} if parts else None,
                "residual": summarize(self.errors.total)["rms"],
                "fault": write_fault(self.fitted),
            }
            return write("found.aligned", record)
        key = choose_key(self.found) if len(self.errors.total) > 1 else "single"
        return "\n".join(list_sentences(self.found, key))

    def _remarks(self) -> list[str]:
        counts = (
            (self.errors.early, "before what is known of the run"),
            (self.errors.unjudged, "where the log does not say which motion holds"),
            (self.errors.unknown, "out of reach of the integration of the run"),
            (self.errors.late, "after what is known of the run"),
            (self.left_out, "without a readable attitude"),
        )
        left_out = [
            f"left out: {write_count(number, 'estimate')} {what}"
            for number, what in counts
            if number
        ]
        return [*left_out, *self._count_outliers(), *(f"note: {note}" for note in self.notes)]

    def _count_outliers(self) -> list[str]:
        counted = write_count(self.outliers, "estimate", "are")
        record = {"counted": counted, "robust": self.robust}
        return [write("outliers", record)] if self.outliers or self.robust else []


def judge(
    estimates: Estimates,
    truth: Truth,
    source: str,
    removed: tuple[str, ...] = (),
    aligned: str | None = None,
    robust: bool = False,
    lag: int | None = None,
) -> Judgement:
    """Compare estimates with the exact motion.

    `removed` may name "offset", "delay", "drift"; with a stated model of `aligned` nothing else is
    looked for. With `robust` causes and models are those of the estimates without outliers. With a
    lag (ns) the errors of the turns over it are measured as well.
    """
    if not len(compare(estimates, truth).total):
        raise RefusedError(_describe_absence(estimates, truth, source))
    run = used = truth.select(estimates)
    if robust:
        used = trim(run, truth, lambda some: find_nearest(some, truth, aligned))
    said = _align(used, truth, aligned) if aligned else _explain(used, truth, removed)
    return Judgement(
        source=source,
        errors=compare(estimates, truth, said.taken),
        found=said.found,
        aligned=aligned,
        fitted=said.fitted,
        removed=removed,
        left_out=estimates.left_out,
        notes=(*said.mistakes, *estimates.notes),
        outliers=len(run) - len(used) if robust else count_outliers(run, truth, said.nearest),
        robust=robust,
        relative=None if lag is None else measure_relative(estimates, truth, said.taken, lag),
    )


@dataclass(frozen=True, eq=False)
class _Said:
    """The causes of the errors of estimates: the nearest, those that are named, what is removed."""

    nearest: Cause
    taken: Offset
    found: Finding | None = None
    fitted: Cause | None = None
    mistakes: tuple[str, ...] = ()


def _align(used: Estimates, truth: Truth, model: str) -> _Said:
    fitted = align(used, truth, model)
    return _Said(fitted, fitted.offset, fitted=fitted)


def _explain(used: Estimates, truth: Truth, removed: tuple[str, ...]) -> _Said:
    found = find_causes(used, truth)
    taken = explain(used, truth, removed).offset if removed else NONE
    mistakes = (f"likely mistake: {each}" for each in find_mistakes(used, truth, found))
    return _Said(found.nearest or found.best, taken, found, mistakes=tuple(mistakes))


def _describe_cause(cause: Cause) -> dict[str, Any]:
    """Return what was fitted, for JSON, with standard deviations."""
    offset = cause.offset
    world, body = zip_longest(offset.angles, cause.turn_deviations)
    return {
        "begin": offset.begin,
        "delay": offset.delay,
        "drift": offset.drift,
        "body_drift": offset.spin,
        "clock_rate": offset.clock,
        "gyroscope_scale": offset.scale,
        "world_offset": _describe_turn(*world, offset.world),
        "body_offset": _describe_turn(*body, offset.body),
        "deviations": dict(zip(cause.parameters, cause.deviations, strict=False)),
        "independent_estimates": cause.independent,
        "correlation_time": cause.correlation_time,
        "no_deviations_as": cause.fault or None,
    }


def _describe_turn(angle: float, deviation: float | None, q: Real) -> dict[str, Any]:
    return {"angle": angle, "deviation": deviation or None, "w_x_y_z": q.tolist()}


def _describe_finding(found: Finding) -> dict[str, Any]:
    """Return what was found, for JSON: the cause of which the sentences speak."""
    said = found.said
    is_hidden = "delay" in found.hidden and "delay" not in said.parameters
    return {
        "explained": found.explained,
        "no_cause_as": found.fault or None,
        "candidate": _describe_candidate(found.candidate),
        "share": _find_share(found),
        "estimates_move": not found.still,
        "mistake": said.change or None,
        **_describe_cause(said),
        **({"delay": None} if is_hidden else {}),
        "delay_period": found.period,
        "heading_step": found.heading_step,
        "other_delays": [each.offset.delay for each in found.aliases],
        "not_identifiable": list(found.hidden),
        "residual_rms": said.residual,
        "stamp_steps": found.steps and vars(found.steps),
        "line": found.swing and vars(found.swing),
    }


def _find_share(found: Finding) -> float | None:
    """Return the part of the root mean square that a candidate explains, or any cause at most."""
    if found.explained:
        return None
    return 1 - found.said.residual / found.best.residual if found.candidate else found.share


def _describe_candidate(cause: Cause | None) -> dict[str, Any] | None:
    """Return a cause that explains a part, for JSON."""
    if cause is None:
        return None
    return {
        "mistake": cause.change or None,
        "residual_rms": cause.residual,
        **_describe_cause(cause),
    }


def _describe_absence(estimates: Estimates, truth: Truth, source: str) -> str:
    """Return why there is nothing to judge, with both spans of time."""
    notes = "".join(f"; {note}" for note in estimates.notes)
    if not len(estimates):
        return f"{source} must have an attitude, got none of {estimates.left_out}{notes}"
    if unjudged := int(truth.find_unjudged(estimates.stamps).sum()):
        return (
            f"{source} must have estimates where the log says which motion holds, got {unjudged} "
            f"where it does not{notes}"
        )
    if unreached := len(estimates) - sum(truth.count_outside(estimates.stamps)):
        return (
            f"{source} must have estimates of a motion that can be integrated, got "
            f"{unreached} of one that takes too long{notes}"
        )
    times = [estimates.stamps[0], estimates.stamps[-1], truth.begin or 0, truth.end]
    first, last, begin, end = (
        None if t is None else f"{int(t) / NANOSECONDS:.3f} s" for t in times
    )
    hint = "; times count from 0" if estimates.stamps[0] < YEAR <= (truth.begin or 0) else ""
    return (
        f"{source} must have stamps within the run, {begin} to {end or 'any later time'}, "
        f"got {first} to {last}{hint}{notes}"
    )


def format_judgements(judgements: Sequence[Judgement]) -> str:
    """Return the figures of one source, or one table of the attitude errors of several."""
    if len(judgements) == 1:
        return judgements[0].format()
    width = max(len(each.source) for each in judgements)
    rows = [format_row(each.source, width, each.facts()["attitude"]) for each in judgements]
    notes = [
        f"{each.source}: {line}"
        for each in judgements
        for line in [*each._explain().splitlines(), *each._remarks()]
    ]
    return "\n".join([f"{'attitude (rad)':{width}}{_head(0)}", *rows, *notes])


def _head(width: int) -> str:
    return f"{'':{width}}{'rms':>10}{'mean':>10}" + "".join(f"{f'{p} %':>10}" for p in PERCENTILES)
