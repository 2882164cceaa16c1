"""The lesson does what it says: every command runs, and the pictures are those of the commands."""

import io
import json
import re
import shlex
from itertools import pairwise

import pytest
from documents import ROOT
from programs import running_node
from ros.node.listener import Listener
from shown_pictures import assert_same_picture
from trials import choose
from waiting import until

from symtop_ros.page.panel import main as panel
from symtop_ros.ros.client import main as client
from symtop_ros.ros.client.connection import Connection
from symtop_ros.ros.client.main import parse_values
from symtop_ros.run.simulation.run_file import read_run
from symtop_ros.truth.fit import main as fit
from workshop.lesson.page import PAGE, write_page
from workshop.lesson.pictures import picture_of, run_step
from workshop.lesson.steps import read_lesson
from workshop.load.domains import share_domain

LESSON = PAGE.read_text(encoding="utf-8")
STEPS = read_lesson()
DOMAIN = share_domain()
NAMES = ("/top", "/disc")
BEFORE, *PARTS = re.split(r"^## \d+\. ", LESSON, flags=re.MULTILINE)


def typed(text):
    """The commands of a part of the lesson."""
    return "".join(re.findall(r"```sh\n(.+?)```", text, flags=re.DOTALL)).strip().splitlines()


@pytest.fixture(scope="module")
def tops():
    """Connections to both nodes, which are started as in the lesson, by their names."""
    starts = [shlex.split(line) for line in typed(BEFORE) if "top_node" in line]
    parameters = [[value for word, value in pairwise(words) if word == "-p"] for words in starts]
    assert [words[-1] for words in starts] == ["real_time_factor:=0.1", "__node:=disc"]
    with (
        running_node(DOMAIN, *parameters[0]),
        running_node(DOMAIN, *parameters[1], name="disc"),
        Listener(DOMAIN) as user,
        Listener(DOMAIN, "user_of_disc") as other,
    ):
        nodes = dict(zip(NAMES, (user.node, other.node), strict=True))
        yield {name: Connection(node, name, timeout=300.0) for name, node in nodes.items()}


def do(tops, line):
    """Do what a command of top_ctl does, without a new process for each; return the answer."""
    options = client.make_parser().parse_args(shlex.split(line)[1:])
    values = parse_values(vars(options).get("values", ()))
    granted, text = client.carry_out(options, values, tops[options.node])
    assert granted, text
    return text


def test_the_page_has_the_steps_of_the_data():
    """Otherwise: make -C workshop pictures."""
    assert write_page() == LESSON
    assert [tuple(typed(part)) for part in PARTS] == [tuple(step.commands) for step in STEPS]


def test_the_commands_that_need_no_ros_are_options_of_their_programs():
    assert panel.make_parser().parse_args(["--lesson"]).lesson
    assert typed(BEFORE)[:1] == ["top_panel --lesson"]


WITH_NODES = {k: step for k, step in enumerate(STEPS, start=1) if not step.has_record}


@pytest.mark.parametrize("step", WITH_NODES.values(), ids=WITH_NODES)
def test_the_commands_of_a_step_lead_to_the_motion_of_its_picture(step, tops):
    if step.acts[-1].push:  # which takes a second of the motion
        assert tops["/top"].request("set_parameters_atomically", {"real_time_factor": 10.0})[0]
    for line in step.commands:
        do(tops, line)
    node = "--node /disc " if "/disc" in step.commands[-1] else ""
    drawn = [run.pieces[-1][1] for run in run_step(step).values()]
    # the last of a step with kicks is the motion that was not kicked
    motion = drawn[-1] if step.acts[-1].start else drawn[-2]
    # a kick at a different time is rounded differently
    angles = pytest.approx(motion.turning_angles, abs=1e-12)

    def read():
        state = json.loads(do(tops, f"top_ctl {node}state --json"))
        return state if state["turning_angles"] == angles else None

    state = until(read) if step.acts[-1].push else read()
    assert state
    assert state["kind"] == motion.kind


@pytest.mark.slow
def test_the_commands_of_the_record_lead_to_the_motion_of_its_picture(
    tmp_path, monkeypatch, capsys
):
    (number,) = {*range(1, len(STEPS) + 1)} - {*WITH_NODES}
    step = STEPS[number - 1]
    monkeypatch.chdir(tmp_path)
    for line in step.commands:
        program, *arguments = shlex.split(line)
        assert program == "top_fit"
        assert fit.main(arguments) == 0
    assert capsys.readouterr().err == ""
    (event,), _, points = read_run(tmp_path / "run.json")
    drawn = [run.pieces[0][1] for run in run_step(step).values()]
    # of digits that a fit leaves open: a hundredth of a deviation of 0.0004 rad
    angles = pytest.approx(event.motion.turning_angles, abs=5e-6)
    assert [motion.turning_angles for motion in drawn] == [angles] * 2
    assert len(points) == 240


@pytest.mark.parametrize("number", choose(range(1, 12), (1, 8)))
def test_a_picture_is_what_the_command_draws(number):
    drawn = io.BytesIO(picture_of(STEPS[number - 1]))
    assert_same_picture(ROOT / f"docs/lesson/step_{number:02}.png", drawn)
