"""The page of troubleshooting: each message that it quotes is printed by what it names."""

import contextlib
import re
import sys

import pytest
from documents import ROOT
from log_files import Run
from programs import command, environment, execute, run_python, running, running_node, write_without

from workshop.load.domains import share_domain

pytestmark = pytest.mark.untraced
PAGE = (ROOT / "docs/troubleshooting.md").read_text(encoding="utf-8")
QUOTED = {
    line
    for block in re.findall(r"```(?:console|text)\n(.*?)```", PAGE, re.S)
    for line in block.splitlines()
}
DOMAIN = share_domain()


@pytest.mark.slow
def test_a_client_without_a_node_prints_what_the_page_quotes():
    done = execute(command("top_ctl", "hurry"), env=environment(DOMAIN))
    assert done.stderr.rstrip() in QUOTED


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "running_before"),
    [((), True), (("-p", "use_sim_time:=true"), False)],
    ids=["two nodes with one name", "no clock"],
)
def test_a_node_warns_with_what_the_page_quotes(words, running_before):
    with running_node(DOMAIN) if running_before else contextlib.nullcontext():
        start = command("top_node", "--ros-args", "--log-level", "warn", *words)
        with running(start, DOMAIN) as node:
            lines = (line.split("]: ", 1)[-1].strip() for line in node.stderr)
            assert any(line in QUOTED for line in lines)


@pytest.mark.parametrize(
    ("program", "missing"), [("top_node", ("rclpy",)), ("top_replay", ("mcap",))]
)
def test_a_program_without_its_package_prints_what_the_page_quotes(program, missing, tmp_path):
    done = run_python(write_without(missing, program), "run.mcap", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.rstrip() in QUOTED


def test_a_python_without_the_package_prints_what_the_page_quotes(tmp_path):
    (code,) = re.findall(r'\$ python3 -c "(.*)"', PAGE)
    done = execute([sys.executable, "-IS", "-c", code], cwd=tmp_path)
    assert done.stderr.splitlines()[-1] in QUOTED


@pytest.mark.slow
@pytest.mark.parametrize(("program", "words"), [("top_replay", ["run.mcap"]), ("top_live", [])])
def test_a_viewer_without_a_screen_prints_what_the_page_quotes(
    program, words, tmp_path, monkeypatch
):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    if words:
        Run(seconds=0.5).write(tmp_path).rename(tmp_path / "run.mcap")
    done = execute(command(program, *words), env=environment(DOMAIN), cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr.rstrip() in QUOTED
