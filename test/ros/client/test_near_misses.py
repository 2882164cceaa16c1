"""Words of top_ctl and top_node that are nearly right: one message, with the nearest name."""

import pytest

from symtop_ros.base.refusals import RefusedError, validate_names
from symtop_ros.ros.client.body import read_parts
from symtop_ros.ros.client.main import check_start, main, parse_values
from symtop_ros.ros.node.options import make_parser
from symtop_ros.run.simulation.changes.requests import KICK_FIELDS
from symtop_ros.run.simulation.presets import load_scene

NEAR = [
    (check_start, {"thetta": 1.0}, "theta", "thetta"),
    (lambda names: validate_names(names, KICK_FIELDS), {"hodl": "x"}, "hold", "hodl"),
    (load_scene, "hury_slow", "hurry_slow", "hury_slow"),
    (read_parts, "disk:170g,5cm,9cm", "disc", "disk:170g,5cm,9cm"),
    (read_parts, "bicycle_whel", "bicycle_wheel", "bicycle_whel"),
]


@pytest.mark.parametrize(
    ("read", "given", "nearest", "shown"), NEAR, ids=lambda each: str(each)[:20]
)
def test_the_nearest_name_is_in_the_refusal(read, given, nearest, shown):
    with pytest.raises(RefusedError) as refusal:
        read(given)
    text = str(refusal.value)
    assert text.endswith(f" (the nearest is {nearest}), got {shown!r}")
    assert len(text) < 400  # one line of a terminal that is not cut


def test_a_part_with_too_few_numbers_has_the_right_kind_and_no_nearest_one():
    with pytest.raises(RefusedError) as refusal:
        read_parts("disc:1kg")
    assert "nearest" not in str(refusal.value)


@pytest.mark.parametrize(
    "typed", ["theta=0,5", "theta=0,5rad", "precession_rate_factor=1,4", "theta=-1,5e-3"]
)
def test_a_decimal_comma_is_named(typed, capsys):
    name, _, text = typed.partition("=")
    assert main(["--node", "/missing", "start", typed]) == 1
    said = f"top_ctl: {name} must be a number with a decimal point, got {text!r}\n"
    assert capsys.readouterr().err == said


def test_lists_of_numbers_have_commas():
    assert parse_values(["angular_impulse=0,0,1e-4"]) == {"angular_impulse": [0, 0, 1e-4]}
    assert parse_values(["orientation=[0, 0, 0, 1]"]) == {"orientation": [0, 0, 0, 1]}


@pytest.mark.parametrize("word", ["scene=hury_slow", "scene:=hury_slow", "hury_slow"])
def test_a_scene_without_its_option_leads_to_it(word, capsys):
    with pytest.raises(SystemExit):
        make_parser().parse_args([word])
    assert "(nearest: --scene hurry_slow)\n" in capsys.readouterr().err
