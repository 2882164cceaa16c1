"""Types of arrays and of short tuples that all folders share."""

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Stamps = NDArray[np.int64]  # ns
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]  # (w, x, y, z)
