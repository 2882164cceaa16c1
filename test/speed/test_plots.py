"""Plots of speed against error."""

from workshop.speed.benchmarks import Results
from workshop.speed.plots import _choose_looks, draw_motions
from workshop.speed.sweep import Curve, Measurement

POINT = Measurement(1e-3, 1e-9, 1e-10, 10, 1e-4, 0.0)


def test_the_legend_names_each_method_once():
    """A method that was measured on one motion of two is named, too."""
    measured = (("symtop_ros", "cusps"), ("symtop_ros", "loops"), ("SciPy DOP853", "cusps"))
    curves = [Curve(peer, motion, 10.0, (POINT,), "finest") for peer, motion in measured]
    looks = _choose_looks(dict.fromkeys(peer for peer, _ in measured))
    figure = draw_motions(Results(curves=curves), looks)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["symtop_ros", "SciPy DOP853"]
