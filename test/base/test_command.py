"""Words of the command line: the nearest right form of a wrong one."""

import pytest

from symtop_ros.base.command import new_parser
from symtop_ros.ros.client.options import make_parser
from symtop_ros.ros.node.options import make_parser as make_node_parser

NEAREST = [
    ("hury", "(nearest: hurry)"),
    ("start theta=1 --nod x", "(nearest: --node)"),
    ("hurry --timout=3", "(nearest: --timeout)"),
]


@pytest.mark.parametrize(("words", "nearest"), NEAREST)
def test_an_unknown_word_names_the_nearest_known_one(words, nearest, capsys):
    with pytest.raises(SystemExit) as end:
        make_parser().parse_args(words.split())
    assert end.value.code == 2
    assert capsys.readouterr().err.rstrip().endswith(nearest)


@pytest.mark.parametrize("words", ["hury_slow", "scene=hurry_slow", "--sceen hurry_slow"])
def test_a_scene_without_its_option_names_the_option(words, capsys):
    with pytest.raises(SystemExit):
        make_node_parser().parse_args(words.split())
    assert "(nearest: --scene" in capsys.readouterr().err


def test_a_word_like_none_names_none(capsys):
    with pytest.raises(SystemExit):
        new_parser("top_x", "Does x.").parse_args(["qqq"])
    assert capsys.readouterr().err.endswith("unrecognized arguments: qqq\n")
