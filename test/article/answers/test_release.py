"""An axis that is let go at rest, with and without spin, and torque alone."""

import numpy as np
import pytest

from workshop.article.answers import release
from workshop.article.motions import TOP


def test_the_largest_tilts_are_those_of_the_constants_of_motion():
    degrees = [np.degrees(release.largest_tilt(TOP, spin)) for spin in release.SPINS]
    assert degrees == pytest.approx([180.0, 163.8, 130.4, 93.8, 38.0, 30.4], abs=0.05)
