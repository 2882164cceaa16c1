import importlib

import numpy as np
import pytest
from PIL import Image
from rerun.chunk import RrdReader
from trials import choose

from symtop_ros.base.figure_style import write_figures
from symtop_ros.replay.view import entities
from workshop import main as report
from workshop.article.figures import FIGURES
from workshop.article.recordings import MOTIONS, RATE, SCENES, SPAN
from workshop.article.retell import retell

FEW = [*FIGURES][:3]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("retold")
    with pytest.MonkeyPatch.context() as patch:  # a figure takes half a second
        patch.setattr("workshop.article.retell.FIGURES", {FEW[0]: FIGURES[FEW[0]]})
        assert retell(folder) == 0
    return folder


@pytest.mark.slow
def test_every_claim_holds_and_figures_are_written(folder):
    assert (folder / "claims.md").read_text().endswith("78 of 78 claims hold.\n")
    assert [*folder.glob("*.png")] == [folder / f"{FEW[0]}.png"]
    assert all(draw().axes for draw in FIGURES.values())


@pytest.mark.parametrize("name", choose(FIGURES, FEW[:1]))
def test_a_png_is_a_picture(tmp_path, name):
    write_figures({name: FIGURES[name]}, tmp_path)
    with Image.open(tmp_path / f"{name}.png") as picture:
        pixels = np.asarray(picture.convert("RGB"))
    assert pixels.shape[1] > 1000
    assert len(np.unique(pixels @ np.array([1, 256, 65536]))) > 100  # colours
    drawn = (pixels < 200).any(axis=2)
    assert 0.01 < drawn.mean() < 0.3
    edges = (drawn[0], drawn[-1], drawn[:, 0], drawn[:, -1])
    assert not any(edge.any() for edge in edges)  # nothing is cut off


PATHS = {name: [entities.TRACE, entities.MOMENTUM, entities.TORQUE] for name in MOTIONS}
for scene, list_exhibits in SCENES.items():
    PATHS[scene] = []
    for each in list_exhibits():
        PATHS[scene] += [f"/tops/{each.name}/{part}" for part in ("top", "trace")]
        PATHS[scene].append(f"/{each.group}/{each.name}")


@pytest.mark.slow
@pytest.mark.parametrize("name", PATHS)
def test_a_recording_has_what_it_shows_at_each_sample(folder, name):
    rows = dict.fromkeys(PATHS[name], 0)
    for chunk in RrdReader(folder / f"{name}.rrd").stream():
        if chunk.entity_path in rows and not chunk.is_static:
            rows[chunk.entity_path] += chunk.to_record_batch().num_rows
    assert all(count >= RATE * SPAN for count in rows.values()), rows


@pytest.mark.parametrize("name", report.COMMANDS)
def test_each_command_names_the_function_that_it_runs(name):
    module, _, function = report.COMMANDS[name]["run"].rpartition(".")
    assert callable(getattr(importlib.import_module(module), function))


@pytest.mark.parametrize("name", ["file", "file/below"])
def test_a_folder_that_cannot_be_written_is_refused_in_one_line(tmp_path, capsys, name):
    (tmp_path / "file").write_text("in the way")
    assert report.main(["article", str(tmp_path / name)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"workshop: {tmp_path}/file")
