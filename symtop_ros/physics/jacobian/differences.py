"""Derivatives of states by one step of each parameter, and what each of them lacks.

Axes are those of the states' times (m), of attitude and omega (2), of their components (3), and of
the parameters, the columns of the Jacobian (c).
"""

from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Places, Real
from symtop_ros.physics.jacobian.neighbours import Neighbours
from symtop_ros.physics.jacobian.nodes import (
    ORDER,
    find_curvature,
    measure_rounding,
    weigh,
    weigh_difference,
)
from symtop_ros.physics.jacobian.rounding import Rounding

FARTHEST = 2.0  # response beyond which states say nothing of a derivative


@dataclass(frozen=True, eq=False)
class Difference:
    """Derivatives (m, 2, 3, c)."""

    derivatives: Real
    responses: Real  # of the outermost states, in rad or in units of the fastest rate, (m, 1, 1, c)
    curved: Real  # errors by what the order leaves out
    rough: Real  # errors by the rounding of the states


@dataclass(frozen=True, eq=False)
class Differences:
    """Differences of the states of a motion's neighbours."""

    neighbours: Neighbours
    rounding: Rounding
    of_blocks: Real  # units of responses, (2,)

    def take(self, steps: Real, some: Places, columns: Places) -> Difference | None:
        """Return derivatives at some times by some columns, with the steps (9,) of all columns.

        None: a step is too short to change a double.
        """
        starts = self.neighbours.list_starts(steps)
        if starts is None:
            return None
        starts, lengths = starts[columns], steps[columns]
        moved = self.neighbours.follow(starts, some)
        given = self.neighbours.measure(starts)[..., columns]
        places = np.arange(len(columns))
        nodes = given[places, :, places] / lengths[:, None]
        orders = np.stack([weigh(nodes, count) for count in (ORDER, ORDER - 2, ORDER - 4)])
        by_order = np.einsum("ock,ckmar->omarc", orders, moved)
        inverses = np.linalg.inv(np.einsum("ock,ckp->opc", orders, given))
        tenth, eighth, sixth = by_order @ inverses[:, None, None]
        widths = np.abs(moved).max(axis=1).transpose(1, 2, 3, 0)
        responses = (widths / self.of_blocks[:, None, None]).max(axis=(1, 2), keepdims=True)
        left = np.abs(np.einsum("ck,ckmar->marc", weigh_difference(nodes), moved))
        left[:, :, :2] = left[:, :, :2].max(axis=2, keepdims=True)
        per_step = measure_rounding(orders[0]) / lengths
        rough = self.rounding.find(left, widths, some, columns) * per_step
        curved = np.maximum(find_curvature(tenth, eighth, sixth), 2 * left * per_step - rough)
        curved = np.where(responses > FARTHEST, np.inf, curved)
        return Difference(tenth, responses, curved, rough)
