"""The lesson does what it says: every command runs, and the pictures are those of the commands."""

import json
import re
import shlex
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import rclpy
from domains import claim_domain
from PIL import Image
from programs import running_node

from symtop_ros.article.lesson import STEPS, save_step
from symtop_ros.client import main as client
from symtop_ros.client.arguments import parse_values
from symtop_ros.client.connection import Connection
from symtop_ros.live import main as live
from symtop_ros.report import main as report

ROOT = Path(__file__).parents[1]
LESSON = (ROOT / "docs/lesson.md").read_text(encoding="utf-8")
DOMAIN = claim_domain()
NAMES = ("/top", "/disc")
BEFORE, *PARTS = re.split(r"^## \d+\. ", LESSON, flags=re.MULTILINE)
LIVE = [word.rstrip("`") for word in re.findall(r"top_live --[^`\n]+", LESSON)]


def typed(text):
    """The commands of a part of the lesson."""
    return re.search(r"```sh\n(.+?)```", text, flags=re.DOTALL)[1].strip().splitlines()


@pytest.fixture(scope="module")
def tops():
    """Connections to both nodes, which are started as in the lesson, by their names."""
    starts = [shlex.split(line) for line in typed(BEFORE) if "top_node" in line]
    parameters = [[value for word, value in pairwise(words) if word == "-p"] for words in starts]
    assert [words[-1] for words in starts] == ["real_time_factor:=0.2", "__node:=disc"]
    with (
        running_node(DOMAIN, *parameters[0]),
        running_node(DOMAIN, *parameters[1], name="disc"),
    ):
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=DOMAIN)
        try:
            users = {name: rclpy.create_node(f"of_{name[1:]}", context=context) for name in NAMES}
            yield {name: Connection(user, name, timeout=20.0) for name, user in users.items()}
        finally:
            rclpy.shutdown(context=context)


def do(tops, line):
    """Do what a command of top_ctl does, without a new process for each; return the answer."""
    options = client._parser().parse_args(shlex.split(line)[1:])
    values = parse_values(getattr(options, "values", ()))
    granted, text = client._run(options, values, tops[options.node])
    assert granted, text
    return text


def test_the_steps_of_the_lesson_are_those_of_its_pictures():
    for number, (part, step) in enumerate(zip(PARTS, STEPS, strict=True), start=1):
        assert tuple(typed(part)) == step.commands
        assert f"(lesson/step_{number:02}.png)" in part


@pytest.mark.parametrize("step", STEPS, ids=range(1, 11))
def test_the_commands_of_a_step_lead_to_the_motion_of_its_picture(step, tops):
    for line in step.commands:
        do(tops, line)
    node = "--node /disc " if "/disc" in step.commands[-1] else ""
    state = json.loads(do(tops, f"top_ctl {node}state --json"))
    drawn = [run.pieces[-1][1] for run in step.runs().values()]
    motion = drawn[0] if "hurry" in step.commands[-1] else drawn[-1]
    assert state["kind"] == motion.kind
    # a kick at a different time is rounded differently
    assert state["turning_angles"] == pytest.approx(motion.turning_angles, abs=1e-12)


@pytest.mark.parametrize("line", sorted({*LIVE, *(x for x in typed(BEFORE) if "top_live" in x)}))
def test_every_view_is_one_that_there_is(line):
    """test/live runs the program."""
    options = live._parser().parse_args(shlex.split(line)[1:])
    assert options.node in NAMES


@pytest.mark.parametrize(
    "number", [1, 8, *(pytest.param(k, marks=pytest.mark.long) for k in (2, 3, 4, 5, 6, 7, 9, 10))]
)
def test_a_picture_is_what_the_command_draws(number, tmp_path):
    name = f"step_{number:02}.png"
    save_step(STEPS[number - 1], tmp_path / name)
    pictures = []
    for folder in (ROOT / "docs/lesson", tmp_path):
        with Image.open(folder / name) as picture:
            pictures.append(np.asarray(picture.convert("L"), dtype=float))
    assert pictures[0].shape == pictures[1].shape
    # versions of Matplotlib smooth the edges of letters differently
    assert np.abs(pictures[0] - pictures[1]).mean() < 2.0


def test_a_folder_that_cannot_be_written_is_refused_in_one_line(tmp_path, capsys):
    (tmp_path / "file").write_text("in the way")
    assert report.main(["lesson", str(tmp_path / "file")]) == 1
    assert capsys.readouterr().err == f"top_report: {tmp_path / 'file'}: File exists\n"
