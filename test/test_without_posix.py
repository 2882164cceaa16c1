"""What needs no ROS runs without Python's POSIX modules, and names the encoding of every text."""

import sys

import pytest
from log_files import Run
from programs import execute

# Of Python's library on Linux only; and a text without a named encoding is an error.
PROGRAM = """
import os, signal, subprocess, sys, tempfile, warnings
if sys.argv[1] == "top_replay" and "--save" in sys.argv:
    import rerun  # whose psutil has another file for each system
for name in ("fcntl", "grp", "pty", "pwd", "resource", "syslog", "termios", "tty"):
    sys.modules[name] = None
for name in ("SIGHUP", "SIGKILL", "SIGPIPE", "SIGQUIT", "SIGUSR1", "pthread_sigmask"):
    delattr(signal, name)
for name in ("fork", "geteuid", "getuid", "kill", "sched_setscheduler"):
    delattr(os, name)
warnings.filterwarnings("error", category=EncodingWarning, module="symtop_ros")
from symtop_ros import programs
name, *sys.argv[1:] = sys.argv[1:]
sys.exit(getattr(programs, name)())
"""
TRAJECTORY = "t,w,x,y,z\n" + "".join(f"{k / 2},1,0,0,0\n" for k in range(41))
COMMANDS = (
    "top_panel --write page.html",
    "top_model --format urdf -o top.urdf",
    "top_imu --seconds 0.1 -o größe.csv",
    "top_judge --testset cusps trajectory.csv",
    "top_replay --check run.mcap",
    "top_replay run.mcap --save run.rrd",
    "top_replay run.mcap --repair größe.mcap",
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("elsewhere")
    (folder / "trajectory.csv").write_text(TRAJECTORY)
    Run(described=True).write(folder).rename(folder / "run.mcap")
    return folder


@pytest.mark.parametrize("command", COMMANDS)
def test_a_program_runs_without_posix(command, folder):
    python = sys.executable, "-X", "warn_default_encoding", "-c", PROGRAM
    done = execute([*python, *command.split()], cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
