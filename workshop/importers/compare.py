"""Compare what importers read with the body that is described."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from symtop_ros.physics import DEFAULT_GRAVITY, Body
from symtop_ros.run.models.descriptions import MATRIX, PLAIN, describe
from symtop_ros.truth.testset.score import DESCRIPTIONS, TURNED

# Sums of a dozen products of doubles, and of numbers in single precision (of other doubles by the
# least mass of a link in MuJoCo, 1e-15 kg).
DOUBLE, SINGLE = 1e-13, 2e-6


def expect(facts: Mapping[str, Any], description: str) -> dict[str, Any]:
    """Return mass, centre and moments in the frame of the link, from the numbers of a problem.

    Nothing of what writes the models is used but the turn of the frame, its place, and their names.
    """
    body = Body(facts["mass"], facts["arm"], facts["Ix_centre"], facts["Iz"], DEFAULT_GRAVITY)
    described = describe(description, body) if description in DESCRIPTIONS else PLAIN
    turn = np.array(MATRIX, float) if description in TURNED else np.eye(3)
    moments = turn.T @ np.diag([body.Ix, body.Ix, body.Iz]) @ turn
    centre = np.array(described.pivot) + turn.T @ [0.0, 0.0, body.arm]
    return {"mass": body.mass, "centre": centre, "moments": moments}


def find_error(found: Mapping[str, Any], exact: Mapping[str, Any]) -> tuple[float, str]:
    """Return the largest relative error, and what it is of."""
    size = np.sqrt(np.trace(exact["moments"]) / exact["mass"])  # a length
    apart = np.abs(np.subtract(found["centre"], exact["centre"])).max()
    errors = {
        "mass": abs(found["mass"] / exact["mass"] - 1),
        "centre of mass": apart / max(size, np.abs(exact["centre"]).max()),
        "tensor": np.abs(np.subtract(found["moments"], exact["moments"])).max()
        / np.abs(exact["moments"]).max(),
    }
    name = max(errors, key=lambda each: errors[each])
    return float(errors[name]), name


def judge(found: Mapping[str, Any], exact: Mapping[str, Any]) -> str:
    """Return "right", "to 6 digits", "tensor wrong by 73 %" or "refused"."""
    if "refused" in found:
        return "refused"
    error, name = find_error(found, exact)
    if error <= SINGLE:
        return "right" if error <= DOUBLE else "to 6 digits"
    return f"{name} wrong by {100 * error:.2g} %"
