"""The figures of a judgement of estimates, as text and for JSON."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.judge.compare import PERCENTILES, Errors, Offset


@dataclass(frozen=True, eq=False)
class Judgement:
    """Errors of the estimates of one source."""

    source: str  # topic or file
    errors: Errors  # after what was removed
    found: Offset  # the constant rotations and the delay that explain most of the errors
    removed: tuple[str, ...]  # "offset" and "delay", if they were taken away
    left_out: int  # messages without a readable attitude

    @property
    def largest(self) -> float:
        """Largest error of the attitude in rad."""
        return float(self.errors.total.max())

    def facts(self) -> dict[str, Any]:
        """Return all figures, for JSON."""
        errors, found = self.errors, self.found
        quantities = {
            "attitude": errors.total,
            "tilt": errors.tilt,
            "heading": np.abs(errors.heading),
        }
        if errors.rate is not None:
            quantities["angular_velocity"] = errors.rate
        world, body = found.angles
        return {
            "source": self.source,
            "estimates": len(errors.total),
            "unknown": errors.unknown,
            "left_out": self.left_out,
            "seconds": float(errors.seconds[-1]),
            "removed": list(self.removed),
            **{name: summarize(values) for name, values in quantities.items()},
            "growth_rms": [None if np.isnan(x) else float(x) for x in errors.growth()],
            "found": {
                "delay": found.delay,
                "world_offset": {"angle": world, "w_x_y_z": found.world.tolist()},
                "body_offset": {"angle": body, "w_x_y_z": found.body.tolist()},
            },
        }

    def format(self) -> str:
        """Return the figures as a table of text."""
        facts = self.facts()
        removed = f", {' and '.join(self.removed)} removed" if self.removed else ""
        lines = [
            f"{self.source}: {facts['estimates']} estimates in {facts['seconds']:.6g} s{removed}",
            f"{'':18}{'rms':>10}{'mean':>10}" + "".join(f"{f'{p} %':>10}" for p in PERCENTILES),
        ]
        for name, unit in (
            ("attitude", "rad"),
            ("tilt", "rad"),
            ("heading", "rad"),
            ("angular_velocity", "rad/s"),
        ):
            if name in facts:
                label = f"{name.replace('_', ' ')} ({unit})"
                label = label.replace("angular velocity", "ang. vel.")
                lines.append(f"{label:18}" + "".join(f"{x:10.2e}" for x in facts[name].values()))
        growth = [x for x in facts["growth_rms"] if x is not None]
        lines.append(
            f"attitude, rms: {growth[0]:.2e} rad in the first tenth, {growth[-1]:.2e} in the last"
        )
        world, body = self.found.angles
        lines.append(
            f"best explained by a delay of {self.found.delay * 1e3:.4g} ms, a rotation of the "
            f"world by {world:.2e} rad and of the body by {body:.2e} rad"
        )
        for number, what in (
            (self.errors.unknown, "before the run or out of reach of its integration"),
            (self.left_out, "without a readable attitude"),
        ):
            if number:
                lines.append(f"left out: {number} estimates {what}")
        return "\n".join(lines)


def summarize(values: NDArray[np.float64]) -> dict[str, float]:
    """Return root mean square, mean and percentiles."""
    marks = np.percentile(values, PERCENTILES).tolist()
    return {
        "rms": float(np.sqrt((values**2).mean())),
        "mean": float(values.mean()),
        **{f"p{p}": float(x) for p, x in zip(PERCENTILES, marks, strict=True)},
    }
