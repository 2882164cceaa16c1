"""Pictures for the documents: PNG with a palette, a third of the size."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import IO

from matplotlib import rc_context
from matplotlib.figure import Figure
from PIL import Image

from symtop_ros.base.figure_style import SETTINGS

RESOLUTION = 110  # dots per inch: some 700 in the width of a page
COLORS, SHADES = 24, 128  # of the palettes of figures and of shaded bodies
ROUNDS = 10  # in which colours are chosen


def pack_figure(draw: Callable[[], Figure]) -> bytes:
    """Return the packed picture of a figure."""
    drawn = io.BytesIO()
    with rc_context(SETTINGS):
        draw().savefig(drawn, dpi=RESOLUTION)
    return pack(drawn)


def pack(file: Path | IO[bytes], colors: int = COLORS) -> bytes:
    """Return the packed picture of a PNG."""
    with Image.open(file) as picture:
        return _write(picture, colors)


def pack_shaded(picture: Image.Image) -> bytes:
    """Return the packed PNG of a picture with shaded bodies."""
    return _write(picture, SHADES)


def _write(picture: Image.Image, colors: int) -> bytes:
    packed = io.BytesIO()
    # This method keeps rare colours, which those of a legend are.
    method = Image.Quantize.MAXCOVERAGE
    palette = picture.convert("RGB").quantize(
        colors, method=method, kmeans=ROUNDS, dither=Image.Dither.NONE
    )
    palette.save(packed, "PNG", optimize=True)
    return packed.getvalue()
