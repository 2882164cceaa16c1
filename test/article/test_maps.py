"""Perry's maps: their numbers, and their files."""

import contextlib
import io

import pyarrow.parquet as pq
import pytest
from matplotlib.figure import Figure
from PIL import Image

from workshop.article import maps

SIDES = ("highest", "lowest")
FILES = {"perry.rrd"} | {
    f"perry_{name}.{suffix}" for name in ("spin", "tilt") for suffix in ("png", "svg", "parquet")
}


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Folder of both maps, and what was printed."""
    folder = tmp_path_factory.mktemp("maps")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed), pytest.MonkeyPatch.context() as patch:
        patch.setattr(maps, "POINTS", 40)
        patch.setattr(maps, "Figure", lambda figsize, layout: Figure(figsize))  # quick
        maps.write_maps(folder)
    return folder, printed.getvalue()


@pytest.mark.parametrize("name", ["spin", "tilt"])
def test_the_outcomes_of_a_table_are_those_of_its_turning_points(written, name):
    table = pq.read_table(written[0] / f"perry_{name}.parquet").to_pylist()
    # on the row of phi' = 0, if there is one, a hurry changes nothing
    assert {"higher", "lower"} <= {row["outcome"] for row in table} <= set(maps.OUTCOMES)
    for row in table[::101]:
        lifts = [row[f"{which}_before"] - row[f"{which}_after"] for which in SIDES]
        sign = {"higher": 1, "lower": -1, "as before": 0}[row["outcome"]]
        if sign:
            assert min(sign * lift for lift in lifts) >= -maps.SAME_ANGLE
            assert max(sign * lift for lift in lifts) > maps.SAME_ANGLE
        else:
            assert max(map(abs, lifts)) <= maps.SAME_ANGLE


def test_all_files_are_written_and_pictures_are_not_blank(written):
    folder, printed = written
    assert {file.name for file in folder.iterdir()} == FILES
    for name in ("spin", "tilt"):
        with Image.open(folder / f"perry_{name}.png") as picture:
            assert len(picture.convert("RGB").getcolors(1 << 24)) > 500
    assert printed.count("the rule holds on") == 2
    assert f"rerun {folder / 'perry.rrd'}" in printed
