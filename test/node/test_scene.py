"""Scene files that are none: refused in one sentence, soon and in little memory."""

import os
import time

import pytest
from odd_values import assert_one_sentence

from symtop_ros.node import scene
from symtop_ros.node.fields import RefusedError
from symtop_ros.node.scene import scene_values

HEAD = "/**:\n  ros__parameters:\n"
LAUGHS = "".join(
    f"    a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9) if k else 1}]\n" for k in range(12)
)
MAPS = "".join(
    f"    a{k}: &a{k} {{x: {f'*a{k - 1}' if k else 1}, y: {f'*a{k - 1}' if k else 1}}}\n"
    for k in range(40)
)
NO_ALIASES = "allowed are no aliases, and 8 levels"
REFUSED = {
    "lists of lists of aliases": (HEAD + LAUGHS, NO_ALIASES),
    "maps of maps of aliases": (HEAD + MAPS, NO_ALIASES),
    "an alias of itself": ("&a /**: *a", NO_ALIASES),
    "deep lists": (HEAD + "    x: " + "[" * 30_000 + "]" * 30_000, NO_ALIASES),
    "deep maps": (HEAD + "    x: " + "{a: " * 9_000 + "1" + "}" * 9_000, NO_ALIASES),
    "a huge file": (HEAD + "    top: {Ix: 1.0}\n" + "# more\n" * 100_000, "allowed are 65536"),
    "a tag of Python": (
        HEAD + '    x: !!python/object/apply:os.system ["exit 1"]',
        "could not determine a constructor for the tag",
    ),
    "nothing": ("", "is not a ROS parameter file"),
    "a list": ("[1, 2]", "is not a ROS parameter file"),
    "no parameters": ("/**: {}", "is not a ROS parameter file"),
    "control characters": ("\0\1\2", "special characters are not allowed"),
    "a number for a name": (HEAD + "    1: 2", "is not a ROS parameter file"),
    "a date": (HEAD + "    publish_rate: 2020-01-01", "'publish_rate': got datetime.date(2020"),
    "a set": (HEAD + "    publish_rate: !!set {a}", "'publish_rate': got {'a': None}, allowed"),
    "an integer of 70 bits": (HEAD + f"    publish_rate: {2**70}", "'publish_rate': got 1180591"),
    "an integer of 6000 digits": (HEAD + "    publish_rate: " + "9" * 6000, "Exceeds the limit"),
    "bytes that are no text": (b"\xff\xfe\xfa", "'utf-8' codec can't decode"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(scene, "scene_folder", lambda: tmp_path)
    return tmp_path


@pytest.mark.parametrize(("content", "sentence"), REFUSED.values(), ids=REFUSED)
def test_a_scene_that_is_none_is_refused_soon_and_in_one_sentence(folder, content, sentence):
    data = content if isinstance(content, bytes) else content.encode()
    (folder / "odd.yaml").write_bytes(data)
    began = time.process_time()
    with pytest.raises(RefusedError) as refusal:
        scene_values("odd")
    assert time.process_time() - began < 2.0
    assert sentence in str(refusal.value)
    assert_one_sentence(str(refusal.value))


@pytest.mark.parametrize("make", [os.mkdir, os.mkfifo])
def test_a_scene_that_is_no_file_is_refused(folder, make):
    make(folder / "odd.yaml")
    with pytest.raises(RefusedError, match=r"odd\.yaml is not a ROS parameter file"):
        scene_values("odd")


@pytest.mark.parametrize("name", ["none", "../odd", "", 5, None, ["odd"], "x" * 100_000, "\x1b\n"])
def test_a_scene_that_is_not_there_is_refused(folder, name):
    (folder / "odd.yaml").write_text(HEAD + "    top: {Ix: 1.0}\n")
    with pytest.raises(RefusedError) as refusal:
        scene_values(name)
    assert_one_sentence(str(refusal.value))
