"""The notebook of the library: its cells run, print what they show, and draw where they show it."""

import contextlib
import io
import json

import matplotlib as mpl
import matplotlib.pyplot as plt
import pytest
from documents import ROOT, broken_links, same

NOTEBOOK = ROOT / "docs/top.ipynb"
CELLS = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
MOST_BYTES = 150_000  # it is read as a page, and its plots are part of the file


@pytest.fixture
def without_a_screen(monkeypatch):
    mpl.use("Agg")
    monkeypatch.setattr(plt, "show", lambda: None)  # else a cell would close what it has drawn
    with mpl.rc_context():
        yield
    plt.close("all")


@pytest.mark.usefixtures("without_a_screen")
def test_each_cell_of_the_notebook_prints_and_draws_what_it_shows():
    variables = {}
    for cell in (each for each in CELLS if each["cell_type"] == "code"):
        code = "".join(cell["source"])
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            exec(code, variables)
        streams = (each for each in cell["outputs"] if each["output_type"] == "stream")
        shown = "".join(line for each in streams for line in each["text"])
        assert same(printed.getvalue(), shown, code), printed.getvalue()
        pictures = [each for each in cell["outputs"] if "image/png" in each.get("data", {})]
        drawn = [plt.figure(number) for number in plt.get_fignums()]
        assert len(drawn) == len(pictures)
        assert all(axes.lines for figure in drawn for axes in figure.axes)
        plt.close("all")


def test_the_notebook_was_run_from_its_beginning_without_an_error():
    code = [cell for cell in CELLS if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in code] == [*range(1, len(code) + 1)]
    assert all(each["output_type"] != "error" for cell in code for each in cell["outputs"])
    assert NOTEBOOK.stat().st_size < MOST_BYTES


def test_the_links_of_the_notebook_lead_to_pages():
    assert [*broken_links(NOTEBOOK)] == []
