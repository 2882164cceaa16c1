"""`top_model` as its users call it."""

from xml.etree import ElementTree

import pytest

from symtop_ros.models.formats import FORMATS
from symtop_ros.models.main import main
from symtop_ros.simulation.presets import scene_names


@pytest.mark.parametrize("form", sorted(FORMATS))
def test_every_scene_can_be_written(form, tmp_path):
    for scene in scene_names():
        path = tmp_path / f"{scene}.{form}"
        assert main(["--format", form, "--scene", scene, "-o", str(path)]) == 0
        assert ElementTree.parse(path).getroot().tag in ("robot", "sdf", "mujoco")


def test_the_model_goes_to_standard_output(capsys):
    assert main(["--format", "mjcf"]) == 0
    assert capsys.readouterr().out.endswith("</mujoco>\n")


def test_what_a_model_leaves_out_is_told(capsys):
    assert main(["--format", "urdf", "--scene", "friction"]) == 0
    assert capsys.readouterr().err == "top_model: left out: friction\n"


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (("--scene", "none"), "scene must be "),
        (("--gravity", "0"), "gravity must be "),
        (("--gravity", "nan"), "gravity must be "),
        (("-o", "/missing/folder/top.urdf"), "/missing/folder/top.urdf: No such file"),
    ],
)
def test_a_refused_call_is_one_line(arguments, reason, capsys):
    assert main(["--format", "urdf", *arguments]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"top_model: {reason}")
    assert err.count("\n") == 1
