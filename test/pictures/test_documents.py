"""`make -C workshop pictures` writes every picture of the documents but those of measurements."""

import io

import numpy as np
import pytest
from documents import ROOT
from PIL import Image

from workshop.pictures.documents import draw_traces
from workshop.pictures.pack import pack_shaded


def test_every_picture_is_shown_by_a_document():
    texts = [path.read_text() for path in [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")]]
    for path in (ROOT / "docs").rglob("*.[ps][nv]g"):
        name = path.relative_to(ROOT / "docs").as_posix()
        assert any(f"{name})" in text for text in texts), name


def test_make_draws_all_of_them():
    rule = (ROOT / "workshop/Makefile").read_text().split("\npictures:")[1].split("\n\n")[0]
    assert "$(WORKSHOP) pictures" in rule
    assert "workshop.pictures.page" in rule


def test_the_traces_are_what_the_command_draws():
    assert draw_traces() == (ROOT / "docs/traces.svg").read_text()


@pytest.mark.long
def test_a_picture_of_the_page_has_its_window_and_its_scene(tmp_path, browser):
    from workshop.pictures.page import PICTURES, draw  # which needs Playwright

    (phone,) = [each for each in PICTURES if each.name == "panel_phone"]
    path = draw(browser, phone, tmp_path)
    with Image.open(path) as picture, Image.open(ROOT / "docs" / path.name) as shown:
        assert picture.size == shown.size == tuple(phone.window)
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 50


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
