"""Compute the exact states of the report's reference motions anew, to 25 digits, by the reference.

Run it by hand after a change: PYTHONPATH=.:test python test/speed/write_reference.py
Inputs and times are those of the file: a new motion is an entry without `exact` and `limit`.
"""

import json
import lzma
from typing import Any

from mpmath import mp

from symtop_ros.physics.reference.series import Inputs
from workshop.digits import ClosedForm, Series
from workshop.speed.reference import FILE, PARTS, read_entries
from workshop.testset.exact import distance, perturb

DIGITS = 25


def find_limit(inputs: Inputs, t: float) -> float:
    """Return what half an ulp of every input does: the root of the sum of squares."""
    exact, *moved = (ClosedForm(each, 80).at(t).orientation for each in (inputs, *perturb(inputs)))
    with mp.workdps(80):
        return float(mp.norm([distance(exact, each) for each in moved]))


def solve(entry: dict[str, Any]) -> dict[str, Any]:
    """Return an entry with its exact orientations and what half an ulp of its inputs does."""
    names = ("Ix", "Iz", "Mgl", "orientation", "angular_velocity")
    inputs = Inputs.exact(*(entry[name] for name in names))
    torque = entry.get("torque", (0, 0, 0))
    motion: ClosedForm | Series
    if any(entry["friction"]) or any(torque):
        motion = Series(inputs, 40, entry["friction"], torque)
        limits = None
    else:
        motion = ClosedForm(inputs)
        limits = [find_limit(inputs, t) for t in entry["t"]]
    exact = [[mp.nstr(c, DIGITS) for c in motion.at(t).orientation] for t in entry["t"]]
    return {**entry, "exact": exact, "limit": limits}


def main() -> None:
    entries = read_entries()
    text = ",\n".join(
        f'"{part}": [\n' + ",\n".join(json.dumps(solve(each)) for each in entries[part]) + "\n]"
        for part in PARTS
    )
    FILE.write_bytes(lzma.compress(f"{{{text}}}\n".encode(), preset=9 | lzma.PRESET_EXTREME))


if __name__ == "__main__":
    main()
