import xml.etree.ElementTree as ET

import numpy as np
import pytest
from PIL import Image
from rerun.chunk import RrdReader

from symtop_ros.playback.scene import paths
from symtop_ros.report.article import main
from symtop_ros.report.article.claim import Claim
from symtop_ros.report.article.curves import LOOKS
from symtop_ros.report.article.figures import FIGURES
from symtop_ros.report.article.recordings import MOTIONS, RATE, SPAN
from symtop_ros.report.style import BLUE, GOLD, INK, RED


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("retold") / "made" / "here"
    assert main.retell(folder) == 0
    return folder


@pytest.mark.parametrize("name", FIGURES)
def test_a_png_is_a_picture(folder, name):
    with Image.open(folder / f"{name}.png") as picture:
        pixels = np.asarray(picture.convert("RGB"))
    assert pixels.shape[1] > 1000
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 100
    drawn = (pixels < 200).any(axis=2)
    assert 0.01 < drawn.mean() < 0.3
    edges = (drawn[0], drawn[-1], drawn[:, 0], drawn[:, -1])
    assert not any(edge.any() for edge in edges)  # nothing is cut off


@pytest.mark.parametrize("name", FIGURES)
def test_an_svg_is_a_drawing(folder, name):
    root = ET.parse(folder / f"{name}.svg").getroot()
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert len(list(root.iter("{http://www.w3.org/2000/svg}path"))) > 10


def test_colours_differ_in_grey():
    assert min(np.diff(sorted(map(_luminance, (INK, BLUE, RED, GOLD))))) > 20
    assert len({dash for _, dash in LOOKS.values()}) == len(LOOKS)


def _luminance(color):
    return np.dot([0.299, 0.587, 0.114], list(bytes.fromhex(color[1:])))


@pytest.mark.parametrize("name", MOTIONS)
def test_a_recording_has_the_axis_the_momentum_and_the_torque(folder, name):
    rows = dict.fromkeys((paths.TRACE, paths.MOMENTUM, paths.TORQUE), 0)
    for chunk in RrdReader(folder / f"{name}.rrd").stream():
        if chunk.entity_path in rows and not chunk.is_static:
            rows[chunk.entity_path] += chunk.to_record_batch().num_rows
    assert all(count >= RATE * SPAN for count in rows.values()), rows


def test_the_claims_are_written_and_printed(folder, capsys, monkeypatch):
    monkeypatch.setattr(main, "write_figures", lambda _: [])
    monkeypatch.setattr(main, "write_recordings", lambda _: [])
    assert main.retell(folder) == 0
    printed = capsys.readouterr().out
    assert "22 of 22 claims hold." in printed
    assert printed.splitlines()[-1] in (folder / "claims.md").read_text()


def test_a_claim_that_fails_is_an_exit_status(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(main, "claims", lambda: [Claim("It is so.", "it is not", holds=False)])
    monkeypatch.setattr(main, "write_figures", lambda _: [])
    monkeypatch.setattr(main, "write_recordings", lambda _: [])
    assert main.retell(tmp_path) == 1
    assert "FAIL It is so." in capsys.readouterr().out


@pytest.mark.parametrize("name", ["file", "file/below"])
def test_a_folder_that_cannot_be_written_is_refused_in_one_line(tmp_path, capsys, name):
    (tmp_path / "file").write_text("in the way")
    assert main.retell(tmp_path / name) == 1
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith(f"top_report: {tmp_path}/file")


def test_a_file_that_cannot_be_written_is_refused_in_one_line(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(main, "write_figures", lambda _: [])
    (tmp_path / "cusps.rrd").mkdir()
    assert main.retell(tmp_path) == 1
    assert capsys.readouterr().err.splitlines() == [
        f"top_report: {tmp_path / 'cusps.rrd'}: Is a directory"
    ]
