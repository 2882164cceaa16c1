"""The installed programs as processes in a given ROS domain, and lines of Python."""

import contextlib
import os
import subprocess
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from workshop.load.endings import bound

Done = subprocess.CompletedProcess[str]
RESOURCE = Path(__file__).parents[1] / "resource"
# Options of top_ctl: a node that is starting on a loaded machine may take longer than 5 s.
PATIENT = "--timeout", "300"


def command(name: str, *arguments: object) -> list[str]:
    """Command line of a program, with the Python of the tests."""
    return bound([sys.executable, str(RESOURCE / name), *map(str, arguments)])


# top_judge, which looks for a topic as long as it takes.
JUDGE = """
import sys
from symtop_ros import programs
from symtop_ros.truth.judge import live
live.PATIENCE = 300.0
sys.exit(programs.top_judge())
"""


def judge_live(*arguments: object) -> list[str]:
    """Command line of `top_judge --live`."""
    return bound([sys.executable, "-c", JUDGE, "--live", *map(str, arguments)])


def environment(domain: int) -> dict[str, str]:
    """Environment of a program."""
    return {**os.environ, "ROS_DOMAIN_ID": str(domain)}


def execute(
    words: Iterable[object], check: bool = False, timeout: float = 300, **more: Any
) -> Done:
    """Run a command to its end; its output is text."""
    options = {"capture_output": True, "text": True, **more}
    return subprocess.run([*map(str, words)], check=check, timeout=timeout, **options)


def find_fault(program: str) -> str:
    """Return why a compiler cannot be used, "" if it can.

    It may be found and not start: rustup without a toolchain has a rustc.
    """
    try:
        done = execute([program, "--version"])
    except OSError:
        return f"no {program}"
    reason = done.stderr.partition("\n")[0]
    return f"{program} --version: {reason}" if done.returncode else ""


def run(name: str, *arguments: str, domain: int) -> Done:
    """Run a program to its end."""
    return execute(command(name, *arguments), env=environment(domain))


@contextlib.contextmanager
def running(words: Iterable[object], domain: int, **options: Any) -> Iterator[Any]:
    """Run a command with its output in pipes by default, and end it."""
    usual = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    usual["env"] = environment(domain)
    with subprocess.Popen([*map(str, words)], **{**usual, **options}) as process:
        try:
            yield process
        finally:
            process.terminate()
            try:
                process.communicate(timeout=300)
            finally:
                process.kill()


def set_parameters(*parameters: str) -> list[str]:
    """Options of ROS that set parameters such as publish_rate:=1000, and log warnings only."""
    words = [word for parameter in parameters for word in ("-p", parameter)]
    return ["--ros-args", *words, "--log-level", "warn"]


@contextlib.contextmanager
def running_node(domain: int, *parameters: str, name: str = "top") -> Iterator[Any]:
    """Run top_node with parameters such as publish_rate:=1000, and end it."""
    words = command("top_node", *set_parameters(*parameters), "-r", f"__node:={name}")
    with running(words, domain, stdout=None, stderr=None) as node:
        yield node


def run_python(code: str, *arguments: object, cwd: Path | None = None, **variables: str) -> Done:
    """Run some lines of Python to their end, in a separate process."""
    words = [sys.executable, "-c", code, *arguments]
    return execute(words, timeout=120, cwd=cwd, env={**os.environ, **variables})


def write_without(modules: tuple[str, ...], program: str) -> str:
    """Return the Python that runs a program as where some modules are not installed."""
    code = f"import sys; sys.modules.update(dict.fromkeys({modules})); "
    return code + f"from symtop_ros import programs; sys.exit(programs.{program}())"
