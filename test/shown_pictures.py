"""Pictures of the documents, compared with those that are drawn now."""

from pathlib import Path
from typing import IO

import numpy as np
from PIL import Image


def assert_same_picture(*files: Path | IO[bytes]) -> None:
    """Assert that two pictures are the same, up to the edges of letters."""
    pictures = []
    for file in files:
        with Image.open(file) as picture:
            pictures.append(np.asarray(picture.convert("L"), dtype=float))
    assert pictures[0].shape == pictures[1].shape
    # versions of Matplotlib smooth the edges of letters differently
    assert np.abs(pictures[0] - pictures[1]).mean() < 2.0
