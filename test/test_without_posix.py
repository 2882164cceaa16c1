"""Programs that need no ROS run without it, without POSIX, and names the encoding of every text."""

import sys

import pytest
from log_files import Run
from programs import execute

# Modules of Python on Linux, of ROS, and what only logs and pictures need are missing; and a text
# without a named encoding is an error.
PROGRAM = """
import os, signal, subprocess, sys, tempfile, warnings
missing = ["fcntl", "grp", "pty", "pwd", "resource", "syslog", "termios", "tty"]
missing += ["rclpy", "std_srvs", "geometry_msgs"]
words = " ".join(sys.argv)
if "--save" in words:
    import rerun  # whose psutil has another file for each system
elif "top_replay" not in words:
    missing += ["rerun", "mcap", "lz4", "zstandard", "matplotlib"]
sys.modules.update(dict.fromkeys(missing))
for name in ("SIGHUP", "SIGKILL", "SIGPIPE", "SIGQUIT", "SIGUSR1", "pthread_sigmask"):
    delattr(signal, name)
for name in ("fork", "geteuid", "getuid", "kill", "sched_setscheduler"):
    delattr(os, name)
warnings.filterwarnings("error", category=EncodingWarning, module="symtop_ros")
from symtop_ros import programs
for command in sys.argv[1:]:
    name, *sys.argv[1:] = command.split()
    try:
        status = getattr(programs, name)()
    except SystemExit as end:  # of --help
        status = end.code
    assert not status, command
"""
TRAJECTORY = "t,w,x,y,z\n" + "".join(f"{k / 2},1,0,0,0\n" for k in range(41))
COMMANDS = (  # of one process each
    (
        "top_panel --write page.html",
        "top_model --format urdf -o top.urdf",
        "top_imu --seconds 0.1 -o größe.csv",
    ),
    (
        "top_judge --help",
        "top_testset",
        "top_testset cusps trajectory.csv",
        "top_judge --scene cusps --estimates trajectory.csv",
    ),
    ("top_replay --check run.mcap", "top_replay run.mcap --repair größe.mcap"),
    ("top_replay run.mcap --save run.rrd",),
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("elsewhere")
    (folder / "trajectory.csv").write_text(TRAJECTORY)
    Run(described=True).write(folder).rename(folder / "run.mcap")
    return folder


@pytest.mark.parametrize("commands", COMMANDS, ids=lambda all_: all_[0])
def test_programs_run_without_posix(commands, folder):
    python = sys.executable, "-X", "warn_default_encoding", "-c", PROGRAM
    done = execute([*python, *commands], cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
