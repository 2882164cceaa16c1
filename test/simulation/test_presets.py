"""Invalid scene files are refused in one sentence, quickly and in little memory."""

import os
import sys
import time
from pathlib import Path

import pytest
from odd_values import assert_one_sentence

from symtop_ros.simulation import presets
from symtop_ros.simulation.presets import CONFIG, load_scene
from symtop_ros.simulation.validation import RefusedError

HEAD = "/**:\n  ros__parameters:\n"
LAUGHS = "".join(
    f"    a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9) if k else 1}]\n" for k in range(12)
)
MAPS = "".join(
    f"    a{k}: &a{k} {{x: {f'*a{k - 1}' if k else 1}, y: {f'*a{k - 1}' if k else 1}}}\n"
    for k in range(40)
)
NO_ALIASES = "got aliases or more than 8 levels"
REFUSED = {
    "lists of lists of aliases": (HEAD + LAUGHS, NO_ALIASES),
    "maps of maps of aliases": (HEAD + MAPS, NO_ALIASES),
    "an alias of itself": ("&a /**: *a", NO_ALIASES),
    "deep lists": (HEAD + "    x: " + "[" * 30_000 + "]" * 30_000, NO_ALIASES),
    "deep maps": (HEAD + "    x: " + "{a: " * 9_000 + "1" + "}" * 9_000, NO_ALIASES),
    "a tag of Python": (
        HEAD + '    x: !!python/object/apply:os.system ["exit 1"]',
        "could not determine a constructor for the tag",
    ),
    "nothing": ("", "must be a ROS parameter file for /**, got no parameters"),
    "a list": ("[1, 2]", "must be a ROS parameter file for /**, got no parameters"),
    "no parameters": ("/**: {}", "must be a ROS parameter file for /**, got no parameters"),
    "control characters": ("\0\1\2", "special characters are not allowed"),
    "a number for a name": (HEAD + "    1: 2", "got a name that is not text"),
    "a date": (
        HEAD + "    publish_rate: 2020-01-01",
        "'publish_rate' must be a number, a text, true, false, or a list of them, got datetime",
    ),
    "a set": (HEAD + "    publish_rate: !!set {a}", "a list of them, got {'a'}"),
    "an integer of 70 bits": (HEAD + f"    publish_rate: {2**70}", "a list of them, got 1180591"),
    "an integer of 6000 digits": (HEAD + "    publish_rate: " + "9" * 6000, "Exceeds the limit"),
    "nine levels": (f"{HEAD}    x: {'[' * 6}1{']' * 6}\n", NO_ALIASES),
    "eight levels, three of maps": (f"{HEAD}    x: {'[' * 5}1{']' * 5}\n", "a list of them"),
    "more than 64 KiB": (HEAD.ljust(65_536, "#") + "\n", "65537 bytes (limit 65536)"),
    "bytes that are no text": (b"\xff\xfe\xfa", "'utf-8' codec can't decode"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    scenes = tmp_path / CONFIG
    scenes.mkdir(parents=True)
    return scenes


@pytest.mark.parametrize(("content", "sentence"), REFUSED.values(), ids=REFUSED)
def test_an_invalid_scene_is_refused_quickly_and_in_one_sentence(folder, content, sentence):
    data = content if isinstance(content, bytes) else content.encode()
    (folder / "odd.yaml").write_bytes(data)
    began = time.process_time()
    with pytest.raises(RefusedError) as refusal:
        load_scene("odd")
    assert time.process_time() - began < 2.0
    assert sentence in str(refusal.value)
    assert_one_sentence(str(refusal.value))


def test_a_scene_may_have_64_kib(folder):
    text = HEAD + "    top: {Mgl: 0.05}\n"
    (folder / "odd.yaml").write_text(text.ljust(65_535, "#") + "\n")
    assert load_scene("odd") == {"top.Mgl": 0.05}


@pytest.mark.parametrize("make", [os.mkdir, os.mkfifo])
def test_a_scene_that_is_not_a_file_is_refused(folder, make):
    make(folder / "odd.yaml")
    with pytest.raises(
        RefusedError, match=(r"odd\.yaml must be a ROS parameter file for /\*\*, " r"got no file")
    ):
        load_scene("odd")


@pytest.mark.parametrize("name", ["none", "../odd", "", 5, None, ["odd"], "x" * 100_000, "\x1b\n"])
def test_an_unknown_scene_is_refused(folder, name):
    (folder / "odd.yaml").write_text(HEAD + "    top: {Ix: 1.0}\n")
    with pytest.raises(RefusedError) as refusal:
        load_scene(name)
    assert_one_sentence(str(refusal.value))


def test_a_folder_of_another_package_has_no_scenes(tmp_path, monkeypatch):
    (tmp_path / "config").mkdir()
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    monkeypatch.setattr(presets, "__file__", str(tmp_path / "symtop_ros/simulation/presets.py"))
    assert presets.config_folder() == Path(sys.prefix, CONFIG)
