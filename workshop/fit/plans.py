"""Plans held against fits: planned deviations, and the scatter of fits of such records."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.truth.fit import make_record
from symtop_ros.truth.fit.main import describe_record, make_parser
from symtop_ros.truth.fit.plan import Plan
from symtop_ros.truth.fit.plan_options import make_plan
from symtop_ros.truth.fit.refine import refine
from symtop_ros.truth.fit.values import SIZED, list_quantities, list_values

FITS = 200
# What is planned, as on the command line. The last one is near a fold.
SETUPS = {
    "phone, 120 frames a second": "cusps --kind pixels --rate 120 --seconds 3 --noise 1",
    "sensor, 200 Hz": "looping --kind rates --rate 200 --seconds 2 --noise 0.02",
    "camera, 30 frames a second": "cusps --kind angles --rate 30 --seconds 4 --noise 0.005",
    "phone, hardly a nutation": "cusps initial.phi_dot=6.4 --kind pixels --rate 120 --seconds 3 "
    "--noise 1",
}


@dataclass(frozen=True)
class Row:
    """A number of a plan: its deviation, the scatter of fits, and whether it will be known."""

    setup: str
    name: str
    value: float
    planned: float
    scatter: float
    is_known: bool

    @property
    def ratio(self) -> float:
        """The scatter in planned deviations."""
        return self.scatter / self.planned


def read_plan(words: str) -> Plan:
    """Return the plan of a command line."""
    options = make_parser().parse_args(["--plan", *words.split()])
    return make_plan(options, options.kind, describe_record(options.kind, options))


def hold(setup: str, fits: int = FITS) -> list[Row]:
    """Return the numbers of a plan, each with the scatter of fits about the truth.

    Each fit begins at the truth: whether a search finds it is the matter of the trial.
    """
    plan = read_plan(SETUPS[setup])
    draw = np.random.default_rng([*SETUPS].index(setup))
    errors = {name: np.zeros(fits) for name, _ in list_quantities(plan.fit)}
    for k in range(fits):
        for name, error in _fit(plan, draw).items():
            errors[name][k] = error
    found = {each.name: each for each in list_values(plan.fit)}
    return [
        Row(
            setup,
            name,
            found[name].value,
            found[name].deviation,
            float(np.sqrt((each**2).mean())),
            found[name].is_known,
        )
        for name, each in errors.items()
    ]


def _fit(plan: Plan, draw: np.random.Generator) -> dict[str, float]:
    """Return the errors of the numbers of one fit."""
    model, x = plan.fit.model, plan.fit.x
    exact = model.record
    values = exact.values + plan.noise * draw.normal(size=exact.values.shape)
    record = make_record(exact.times, values, exact.kind.name)
    found = refine(model.move(record), x)
    return {name: of(found.x) - of(x) for name, of in list_quantities(found)}


def write_plans(rows: list[Row]) -> Iterator[str]:
    """Yield the lines of a table of docs/trials.md: numbers of the top, and the worst of all."""
    yield "| record | number | planned | scatter | scatter/planned |"
    yield "|---|---|--:|--:|--:|"
    for row in rows:
        if row.name in SIZED:
            planned = f"{row.planned:.2g}" if row.is_known else f"{row.planned:.2g} (not known)"
            cells = row.setup, f"`{row.name}`", planned, f"{row.scatter:.2g}", f"{row.ratio:.2f}"
            yield f"| {' | '.join(cells)} |"
    sizes = list_sizes(rows)
    yield f"\nOf all numbers that are known the ratio is {sizes.min():.2f} to {sizes.max():.2f}."


def list_sizes(rows: list[Row]) -> Real:
    """Return the ratios of numbers that will be known."""
    return np.array([row.ratio for row in rows if row.is_known])
