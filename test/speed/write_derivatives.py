"""Write the reference of the derivatives, by differences of motions with 70 digits.

Run it by hand after a change: PYTHONPATH=.:test python test/speed/write_derivatives.py
"""

import json

from physics.differences import differentiate
from physics.tops import ARTICLE, CUSPS

from symtop_ros.physics import Motion
from workshop.speed.derivatives import FILE

TIMES = [0.1, 1.0, 10.0, 100.0]  # s


def main() -> None:
    facts = {
        "moments": ARTICLE.moments,
        "orientation": CUSPS.given_orientation.tolist(),
        "angular_velocity": CUSPS.angular_velocity.tolist(),
        "times": TIMES,
        "jacobians": differentiate(Motion(ARTICLE, CUSPS), TIMES).tolist(),
    }
    FILE.write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
