"""Write taylor_motions.json.xz: 200 motions of 16 families by Taylor series, to 25 digits.

Run it as `PYTHONPATH=.:test python test/physics/write_taylor_motions.py`; it takes some minutes.
Inputs and times are doubles, taken as exact. `q` is the orientation (w, x, y, z) up to sign and
`omega` the body angular velocity in rad/s; `largest` is the largest |omega_xy| of the motion.
"""

import json
import lzma

from mpmath import mp
from physics.taylor_families import FAMILIES, PATH, make_case
from physics.tops import largest_rate

COUNT = 200
DIGITS = 25


def solve(family, seed):
    case = make_case(family, seed)
    series, times = case.series, case.times
    states = [series.at(t) for t in times]
    return {
        "family": family,
        "moments": case.moments,
        "q0": case.orientation,
        "omega0": case.omega,
        "period": case.period if case.has_period else None,
        "largest": largest_rate(case.motion),
        "t": times,
        "q": [[mp.nstr(c, DIGITS) for c in q] for q, _ in states],
        "omega": [[mp.nstr(c, DIGITS) for c in omega] for _, omega in states],
    }


def main():
    motions = [solve(FAMILIES[n % len(FAMILIES)], n // len(FAMILIES)) for n in range(COUNT)]
    text = "[\n" + ",\n".join(json.dumps(motion) for motion in motions) + "\n]\n"
    PATH.write_bytes(lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME))


if __name__ == "__main__":
    main()
