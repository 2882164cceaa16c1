"""Pictures for the documents: PNG with a palette, a third of the size."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import IO

from matplotlib import rc_context
from matplotlib.figure import Figure
from PIL import Image

from symtop_ros.figures import SETTINGS

RESOLUTION, COLORS = 130, 64  # dots per inch, colours of a palette
SHADES, ROUNDS = 256, 10  # colours for shaded bodies, and rounds in which they are chosen


def pack_figure(draw: Callable[[], Figure]) -> bytes:
    """Return the packed picture of a figure."""
    drawn = io.BytesIO()
    with rc_context(SETTINGS):
        draw().savefig(drawn, dpi=RESOLUTION)
    return pack(drawn)


def pack(file: Path | IO[bytes]) -> bytes:
    """Return the packed picture of a PNG."""
    packed = io.BytesIO()
    with Image.open(file) as picture:
        picture.convert("RGB").quantize(COLORS).save(packed, "PNG", optimize=True)
    return packed.getvalue()


def pack_shaded(picture: Image.Image) -> bytes:
    """Return the packed PNG of a picture with shaded bodies."""
    packed = io.BytesIO()
    # This method keeps rare colours, which those of a legend are.
    method = Image.Quantize.MAXCOVERAGE
    palette = picture.convert("RGB").quantize(SHADES, method=method, kmeans=ROUNDS)
    palette.save(packed, "PNG", optimize=True)
    return packed.getvalue()
