"""The documents: links resolve, programs and commands run, lists of names agree with the code."""

import contextlib
import importlib
import io
import json
import re
import shlex
import shutil
import sys
from pathlib import Path

import pytest
import rclpy
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from documents import PAGES, ROOT, blocks, broken_links, commands, console, names, rows, same
from geometry_msgs.msg import WrenchStamped
from log_files import Run
from programs import PATIENT, execute, find_fault, running_node
from ros.node.listener import Listener, fill
from ros.node.running_top import RunningTop
from run.simulation.page_runs import make_run
from test_command_lines import MAINS
from truth.judge.cases import encode, make_estimates, truth_and_stamps, write_log

import workshop.main
from symtop_ros.ros.client.connection import Connection
from symtop_ros.run.simulation.run_file import write_run
from symtop_ros.truth.testset.main import main as run_testset
from symtop_ros.truth.testset.score import read_problems
from workshop.load.domains import claim_domain, release_domain, share_domain

pytestmark = pytest.mark.untraced
DOMAIN = share_domain()
ROS_PAGE = ROOT / "docs/ros_reference.md"
LAUNCH_FILE = ROOT / "launch/top.launch.py"
QUOTED = {"fit_imu_record": "fit", "particle_filter": "many"}
WITH_PYTHON = [page for page in PAGES if blocks(page, "python")]
PARSED = ("top_panel", "top_live")  # their options are; separate tests run them
# These need a network, a shell, or a ROS 2 with security.
NOT_RUN = (
    ["git", "clone"],
    ["cd"],
    ["ros2", "security"],
    ["export"],
    ["python3", "-m", "venv"],
    ["~/symtop_venv/bin/pip"],
    ["source"],
)
# test_lesson.py runs the commands of the lesson, one step after the other, and
# node/test_simulator.py those with messages that must be built first.
COMMANDS = [
    pytest.param(
        words, output, id=f"{page.stem}: {line}", marks=[pytest.mark.wording] * bool(output)
    )
    for page in PAGES
    if page.name != "lesson.md"
    for words, output in commands(page)
    if not any(words[: len(each)] == each for each in NOT_RUN)
    and "simulation_interfaces/" not in (line := " ".join(words))
]


INNER = [*PAGES, *sorted(ROOT.glob("symtop_ros/**/*.md"))]


@pytest.mark.parametrize("page", INNER, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_and_paths_lead_to_files_and_headings(page):
    assert [*broken_links(page)] == []


@pytest.fixture
def own_domain(monkeypatch, signals_as_before):
    """A domain for a program of a page that starts nodes of its own."""
    domain = claim_domain()
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    yield
    rclpy.try_shutdown()  # a page that fails would keep all others from beginning
    release_domain(domain)


@pytest.mark.parametrize("page", WITH_PYTHON, ids=lambda page: page.stem)
def test_the_python_of_a_page_prints_what_the_page_shows(page, own_domain):
    variables = {}
    for code, output in blocks(page, "python"):
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            exec(code, variables)
        assert same(printed.getvalue(), output, code), printed.getvalue()


@pytest.mark.parametrize(("name", "page"), QUOTED.items())
def test_a_page_quotes_a_program_of_the_examples_to_the_letter(name, page):
    _, _, code = (ROOT / f"examples/{name}.py").read_text().partition('"""\n\n')
    assert f"```python\n{code}```" in (ROOT / f"docs/{page}.md").read_text()


@pytest.fixture
def testset(tmp_path, monkeypatch):
    """A folder with the states of a problem, in which the commands of a page run."""
    monkeypatch.chdir(tmp_path)
    # rustc looks for the jobs of the make that runs the tests, and warns that they are not its own
    for name in ("MAKEFLAGS", "MFLAGS"):
        monkeypatch.delenv(name, raising=False)
    assert run_testset(["cusps", "-o", "."]) == 0
    return tmp_path


def write_block(language, source, program):
    """Write the program of docs/engines.md in a language; return the output that the page shows."""
    if fault := find_fault(program):
        pytest.skip(fault)
    ((code, output),) = blocks(ROOT / "docs/engines.md", language)
    source.write_text(code)
    return output


@pytest.mark.parametrize(
    ("language", "compiler"),
    [("cpp", "g++ -O2 -std=c++17 -Wall -Wextra"), ("rust", "rustc --edition=2021")],
)
def test_a_program_of_the_page_compiles_and_prints_what_it_shows(language, compiler, testset):
    program, *options = compiler.split()
    output = write_block(language, testset / f"top.{language}", program)
    for words in ([program, *options, f"top.{language}", "-o", "top"], ["./top"]):
        done = execute(words)
        assert (done.returncode, done.stderr) == (0, ""), done.stderr
    assert same(done.stdout, output)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("language", "name", "program"), [("cpp", "top.cpp", "g++"), ("js", "top.mjs", "node")]
)
def test_the_commands_of_the_page_give_a_first_score(language, name, program, testset):
    write_block(language, testset / name, program)
    words, shown = console(ROOT / "docs/engines.md", f" {name} ")
    for line in words:
        command = line.replace("python ", f"{shlex.quote(sys.executable)} ")
        printed = execute(["sh", "-c", command], check=True).stdout
    # the same numbers up to the last of two digits, which the order of sums may change
    assert printed.startswith("cusps: attitude 3.")
    texts = (re.findall(r"\d\.\de[-+]\d\d", text) for text in (printed, shown))
    found, wanted = ([*map(float, each)] for each in texts)
    assert found == pytest.approx(wanted, rel=0.1)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the files that the commands name, while a node runs."""
    folder = tmp_path_factory.mktemp("folder")
    problem = read_problems()["cusps"].facts
    states = zip(problem["times"], problem["orientations"], strict=True)
    lines = ["t,w,x,y,z", *(",".join(map(str, (t, *q))) for t, q in states)]
    (folder / "cusps").mkdir()
    (folder / "cusps/trajectory.csv").write_text("\n".join(lines))
    (folder / "run.json").write_text(json.dumps(write_run(make_run(), 3_000_000_000)))
    with running_node(DOMAIN, "scene:=hurry_slow", f"record.directory:={folder}/logs"):
        yield folder


@pytest.mark.parametrize(("words", "output"), COMMANDS)
@pytest.mark.usefixtures("signals_as_before")
def test_a_command_works(words, output, folder, monkeypatch):
    monkeypatch.chdir(folder)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
    if words[:3] == ["ros2", "run", "symtop_ros"]:
        words = words[3:]
    program, *rest = words
    program = program.removeprefix(".venv/bin/")
    printed = find_runner(program, rest)(program, rest)
    assert not output or same(printed, output), printed


def find_runner(program, words):
    """Return the function that tries a command."""
    if program in PARSED or {"--enclave", "--live", "--web"} & set(words):
        return parse
    others = {"make": check_target, "pip": check_extra, "ros2": call_ros2, "top_ctl": call_node}
    others |= {"top_judge": judge, "top_node": start_node, "top_replay": replay}
    return others.get(program, run)


def check_target(_, words):
    """Find a target, and let the workshop read its options."""
    folder, (target, *others) = (words[1], words[2:]) if words[0] == "-C" else (".", words)
    rule = rf"^{target}:.*\n(?:\t\$\(WORKSHOP\) (\w+) )?"
    found = re.search(rule, (ROOT / folder / "Makefile").read_text(), re.MULTILINE)
    assert found
    if others:
        options = " ".join(others).removeprefix("ARGS=").split()
        with contextlib.chdir(ROOT):
            workshop.main.make_parser().parse_args([found[1], *options])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_target_of_make_that_a_sentence_names_exists(page):
    rule = r"`make ((?:-C workshop )?[a-z][a-z-]*)(?= |`)"
    for found in re.findall(rule, " ".join(page.read_text(encoding="utf-8").split())):
        check_target("make", found.split())


def check_extra(_, words):
    (extra,) = re.findall(r"\[([\w-]+)\]", words[-1])
    assert f'"{extra}": ' in (ROOT / "setup.py").read_text()


def parse(program, words):
    """Read the options of a program, but not those of ROS."""
    if program != "top_node":  # which has no options
        module = importlib.import_module(MAINS[program].__module__)
        with contextlib.chdir(ROOT):
            module.make_parser().parse_args(" ".join(words).partition("--ros-args")[0].split())


def run(program, words):
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        assert MAINS[program](words) == 0
    return printed.getvalue()


def call_node(program, words):
    return run(program, [*PATIENT, *words])


def judge(program, words):
    if words[0] == "run.mcap":
        truth, stamps = truth_and_stamps(200)
        estimates = encode("sensor_msgs/msg/Imu", make_estimates(truth, stamps))
        write_log(Path("run.mcap"), {"/imu/data": estimates})
    return run(program, words)


def start_node(_, words):
    RunningTop(realtime=True, arguments=words).close()


def replay(program, words):
    read, *options = (each.replace("*", "run") for each in words)  # as a shell does
    log = Path(read).with_suffix(".mcap")
    log.parent.mkdir(exist_ok=True)
    shutil.move(Run(seconds=0.5).write(Path.cwd()), log)
    # without an option it would open a window: there is no screen
    return run(program, [read, *(options or ["--save", "run.rrd"])])


def call_ros2(_, words):
    """Do what `ros2 service`, `ros2 topic` or `ros2 launch` would; ros2cli is not on PyPI."""
    ways = {"service": call_service, "topic": publish_torque, "launch": check_arguments}
    ways[words[0]](*words[2:])


def call_service(name, kind, text="{}"):
    package, _, message = kind.split("/")
    service = getattr(importlib.import_module(f"{package}.srv"), message)
    node, _, short = name.rpartition("/")
    with Listener(DOMAIN) as listener:
        connection = Connection(listener.node, node, timeout=300.0)
        request = fill(service.Request(), yaml.safe_load(text))
        answer = str(connection.call(service, short, request))
    assert "success=True" in answer or "successful=True" in answer


def publish_torque(_, __, topic, kind, text):
    assert kind == "geometry_msgs/msg/WrenchStamped"
    message = fill(WrenchStamped(), yaml.safe_load(text))
    with Listener(DOMAIN) as listener:
        events = listener.collect(DiagnosticArray, "/top/events")
        publisher = listener.node.create_publisher(WrenchStamped, topic, 10)
        listener.spin_until(publisher.get_subscription_count)
        listener.spin_until(lambda: "0.0 0.0 0.0005" in str(events) or publisher.publish(message))


def check_arguments(_, *arguments):
    for each in arguments:
        assert f'("{each.partition(":=")[0]}", ' in LAUNCH_FILE.read_text()


@pytest.fixture(scope="module")
def top():
    """A node with all its topics."""
    sensors = (f"{name}__enabled" for name in ("imu", "magnetic_field", "odometry"))
    switches = ("publish_clock", "publish_markers", *sensors)
    with RunningTop(realtime=True, **dict.fromkeys(switches, True)) as running:
        yield running.top


def listed(section, kind):
    """Names and types in the first two columns of a table of docs/ros_reference.md."""
    types = {name: row[1] for row in rows(ROS_PAGE, section) for name in names(row[0])}
    pairs = ((name.replace("~", "/top"), text.split(",")[0]) for name, text in types.items())
    return {(name, text.replace("/", f"/{kind}/")) for name, text in pairs}


def test_the_topics_of_the_page_on_ros_are_those_of_the_node(top):
    pairs = [*top.get_publisher_names_and_types_by_node("top", "/")]
    pairs += [*top.get_subscriber_names_and_types_by_node("top", "/")]
    of_ros = ("/rosout", "/parameter_events")
    found = {(name, kind) for name, (kind,) in pairs if name not in of_ros}
    transforms = {(name, "tf2_msgs/msg/TFMessage") for name in ("/tf", "/tf_static")}
    # without tf2_msgs they are not published
    assert listed("Topics", "msg") == found | transforms


def test_the_services_of_the_page_on_ros_are_those_of_the_node(top):
    pairs = top.get_service_names_and_types_by_node("top", "/")
    foreign = re.compile("parameter|type_description")
    found = {(name, kind) for name, (kind,) in pairs if not foreign.search(name)}
    assert listed("Services", "srv") == found


def test_the_parameters_of_the_page_on_ros_are_those_of_the_node(top):
    shown = {name for row in rows(ROS_PAGE, "Parameters") for name in names(row[0])}
    found = set(top.get_parameters_by_prefix("")) - {"start_type_description_service"}
    assert shown <= found
    assert [name for name in found - shown if not name.startswith("qos_overrides.")] == []


def test_the_programs_and_scenes_of_the_page_on_ros_are_those_of_the_package():
    for section, pattern in (("Programs", "resource/top_*"), ("Scenes", "config/*.yaml")):
        shown = [name for row in rows(ROS_PAGE, section) for name in names(row[0])]
        assert sorted(shown) == sorted(path.stem for path in ROOT.glob(pattern))
