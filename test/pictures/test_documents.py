"""`make -C workshop pictures` writes every picture of the documents but those of measurements."""

import io
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from workshop.pictures import documents, page, replay
from workshop.pictures.pack import pack_shaded
from workshop.speed import filters, plots

ROOT = Path(__file__).parents[2]
MEASURED = {f"{name}.png" for name in (*plots.NAMES, filters.NAME)}  # written with their tables


@pytest.fixture
def written(tmp_path, monkeypatch):
    """The folder of the pictures, each of which is drawn as an empty one."""
    blank = io.BytesIO()
    Image.new("RGB", (9, 9)).save(blank, "PNG")
    monkeypatch.setattr(documents, "pack_figure", lambda _: blank.getvalue())
    monkeypatch.setattr(documents, "map_spin", lambda _: None)
    monkeypatch.setattr(documents, "draw_map", lambda _, target: Figure().savefig(target))
    monkeypatch.setattr("workshop.lesson.pictures.picture_of", lambda _: blank.getvalue())
    monkeypatch.setattr(replay, "render", lambda _, __, target: target.touch())
    assert documents.write_pictures(tmp_path) == 0
    return tmp_path


def list_pictures(folder):
    paths = [path for path in folder.rglob("*") if path.suffix in {".png", ".svg"}]
    return {path.relative_to(folder).as_posix() for path in paths}


def test_every_picture_of_the_documents_is_written_by_a_command(written):
    of_the_page = {f"{each.name}.png" for each in (*page.PICTURES, page.LESSON)}
    found = list_pictures(written)
    assert not found & of_the_page
    assert found | of_the_page | MEASURED == list_pictures(ROOT / "docs")


def test_every_picture_is_shown_by_a_document():
    texts = [path.read_text() for path in [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")]]
    for name in list_pictures(ROOT / "docs"):
        assert any(f"{name})" in text for text in texts), name


def test_make_draws_all_of_them():
    rule = (ROOT / "workshop/Makefile").read_text().split("\npictures:")[1].split("\n\n")[0]
    assert "$(WORKSHOP) pictures" in rule
    assert "workshop.pictures.page" in rule


TEAL, BLUE = (2, 148, 108), (10, 70, 180)


def test_a_shaded_picture_keeps_the_rare_colours_of_its_legend():
    across, down = np.meshgrid(np.linspace(0, 1, 640), np.linspace(0, 1, 480))
    light = 30 + 200 * across * down
    drawn = np.stack([light, light * (0.6 + 0.3 * down), light * (0.4 + 0.5 * across)], axis=2)
    drawn = drawn.astype(np.uint8)
    drawn[470:474, 10:28], drawn[470:474, 40:58] = TEAL, BLUE
    with Image.open(io.BytesIO(pack_shaded(Image.fromarray(drawn)))) as picture:
        assert picture.mode == "P"
        kept = np.asarray(picture.convert("RGB"), dtype=int)
    assert np.abs(kept[470:474, 10:28] - TEAL).max() <= 1
    assert np.abs(kept[470:474, 40:58] - BLUE).max() <= 1
