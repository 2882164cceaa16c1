"""Type what the documents say, as a new user does: python test/newcomer.py [TRIAL...].

The trials, each in a clone of the last commit, in a folder with a blank and an umlaut, with an
empty home and without the variables of this machine:

documents    the set-up of the README, then every shell line of all documents, then `make lint`
pythonX.Y    the set-up of the README with that Python, where there is one
later        a pull of Python, of the kernel, a moved folder, another Python, without a network

The user is not root if the account nobody can run this machine's Python. A line must end with the
status 0; what runs until it is stopped is stopped by Ctrl-C. What is not typed is listed with its
reason.
"""

import argparse
import contextlib
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))
from documents import FIRST, blocks, commands
from elsewhere import NOBODY, give_up_rights

from workshop.matrix import find_python

ROOT = Path(__file__).parents[1]
DOCUMENTS = [path.relative_to(ROOT) for path in sorted(ROOT.glob("docs/*.md"))]
PYTHONS = ("3.11", "3.13", "3.14")
# By these pip and npm reach packages.
KEPT = r"PIP_.*|npm_config_.*|SSL_CERT_\w+|\w+_CA_BUNDLE|NODE_EXTRA_CA_CERTS|\w+_proxy"
RUN = ["ros2", "run", "symtop_ros"]
# What is not typed, by the first words of a line.
NOT_TYPED = {
    ("ros2",): "the wheels of PyPI have no ros2",
    ("export",): "of SROS2, for which the wheels have no plugins",
    **{
        ("make", "-C", "workshop", name): "measures for minutes or hours; a part of make test-long"
        for name in ("report", "filters", "stress", "soak", "node-cost", "starts", "links")
    },
    ("pip", "install", "-e", ".[gpu-cuda13]"): "for a GPU, 2 GB",
    ("make", "test"): "typed in the README's order",
    ("top_judge", "--live", "--topic", "/imu/data"): "there is no such filter",
    (
        "make",
        "-C",
        "workshop",
        "language",
        "ARGS=it",
    ): "names the texts that a translator begins with",
}
ENCLAVE = "--enclave"
# A command of these runs until Ctrl-C, but with an option that ends it.
SERVERS = {"top_node": (), "top_panel": ("--write",), "top_live": ()}
HEED_INTERRUPTS = ("env", "--default-signal=INT")  # which the background of a shell ignores
SERVING = 8.0  # s until what serves is stopped
# Without a screen these end with a line that says so.
NEED_A_SCREEN = (["top_replay", "run.mcap"], ["top_replay", "run.json"])
NO_NETWORK = {"PIP_CONFIG_FILE": os.devnull, "PIP_INDEX_URL": "http://127.0.0.1:9/simple"}
NO_NETWORK |= {"PIP_RETRIES": "0", "PIP_NO_CACHE_DIR": "1"}
# What a page takes for granted: a log with estimates, a run of the page, a trajectory.
PREPARE = """
import json, sys
from pathlib import Path
sys.path[:0] = ["test"]
from truth.judge.cases import encode, make_estimates, truth_and_stamps, write_log
from log_files import Run
from run.simulation.page_runs import make_run
from symtop_ros.run.simulation.run_file import write_run
from symtop_ros.truth.testset.score import read_problems
if sys.argv[1] == "logs":
    Run(seconds=2.0).write(Path.cwd()).rename("run.mcap")
if sys.argv[1] == "truth":
    estimates = encode("sensor_msgs/msg/Imu", make_estimates(*truth_and_stamps(200)))
    write_log(Path("run.mcap"), {"/imu/data": estimates})
Path("run.json").write_text(json.dumps(write_run(make_run(), 3_000_000_000)))
facts = read_problems()["cusps"].facts
states = zip(facts["times"], facts["orientations"])
Path("cusps").mkdir(exist_ok=True)
rows = ["t,w,x,y,z", *(",".join(map(str, (t, *q))) for t, q in states)]
Path("cusps/trajectory.csv").write_text("\\n".join(rows))
"""


@dataclass
class User:
    """Somebody who types lines in a folder, and what came of them."""

    folder: Path
    variables: dict[str, str]
    before: tuple[str, ...] = ()  # each command: how root gives up its rights
    failures: list[str] = field(default_factory=list)
    typed: int = 0

    def type(self, line: str, *, expected: tuple[int, ...] = (0,), **variables: str) -> str:
        """Run a line in a shell; return what it prints."""
        print(f"$ {line}", flush=True)
        began = time.monotonic()
        words = [*self.before, "bash", "-c", line]
        done = subprocess.run(
            words,
            cwd=self.folder,
            env={**self.variables, **variables},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
        self.note(line, done.returncode, expected, done.stdout, time.monotonic() - began)
        return done.stdout

    def note(
        self, line: str, status: int, expected: tuple[int, ...], text: str, seconds: float
    ) -> None:
        """Count a line, and print its end if its status is not the expected one."""
        self.typed += 1
        print(f"  {status} after {seconds:.0f} s", flush=True)
        if status not in expected or "Traceback (most recent call last)" in text:
            self.failures.append(line)
            print("\n".join(f"  | {each}" for each in text.splitlines()[-40:]), flush=True)

    @contextlib.contextmanager
    def serving(self, line: str) -> Iterator[None]:
        """Run a line until the block ends, then press Ctrl-C."""
        print(f"$ {line}  # until Ctrl-C", flush=True)
        with tempfile.TemporaryFile("w+") as output:
            process = subprocess.Popen(
                [*self.before, *HEED_INTERRUPTS, "bash", "-c", f"exec {line}"],
                cwd=self.folder,
                env=self.variables,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=output,
                start_new_session=True,
            )
            began = time.monotonic()
            try:
                yield
            finally:
                process.send_signal(signal.SIGINT)
                status = process.wait(timeout=60)
                output.seek(0)
                text = output.read()
                self.note(line, status, (0, 130), text, time.monotonic() - began)

    def activate(self) -> None:
        """Do what `source .venv/bin/activate` does."""
        self.variables["PATH"] = f"{self.folder}/.venv/bin:{self.variables['PATH']}"


@contextlib.contextmanager
def new_user(python: str = "") -> Iterator[User]:
    """Provide a user with a clone; `python3` is the one that is named, or that of the system."""
    with tempfile.TemporaryDirectory(prefix="newcomer-") as name:
        place = Path(name)
        place.chmod(0o755)
        home, programs, desk = place / "home", place / "programs", place / "My Größe"
        for folder in (home, programs, desk):
            folder.mkdir()
            folder.chmod(0o777)
        path = os.pathsep.join([str(programs), "/usr/local/bin", "/usr/bin", "/bin"])
        if python:
            (programs / "python3").symlink_to(python)
        before: tuple[str, ...] = ()
        if os.geteuid() == 0:
            before = give_up_rights(Path(python or shutil.which("python3", path=path) or ""))
        kept = {name: text for name, text in os.environ.items() if re.fullmatch(KEPT, name, re.I)}
        variables = {**kept, "HOME": str(home), "PATH": path}
        user = User(desk, variables, before)
        try:
            yield user
        finally:
            subprocess.run(["chmod", "-R", "u+w", name], check=False)


def clone(user: User) -> None:
    """Clone the last commit for a user, and enter it as the README does."""
    bare, folder = user.folder / "upstream", user.folder / "symtop_ros"
    subprocess.run(["git", "clone", "--quiet", "--bare", ROOT, bare], check=True)
    if any(NOBODY in word for word in user.before):
        subprocess.run(["chown", "-R", NOBODY, bare], check=True)
    user.type(f"git clone --quiet upstream {folder.name}")
    user.folder = folder


def list_set_up() -> list[str]:
    """Return the lines of the README's set-up after `cd`."""
    (block, _), *_ = blocks(FIRST[0], "sh")
    lines = block.splitlines()
    return lines[[line.startswith("cd ") for line in lines].index(True) + 1 :]


def try_documents(user: User) -> None:
    """Type the README, then all that the other documents have."""
    clone(user)
    for line in list_set_up():
        user.type(line)
    user.activate()
    with user.serving("top_node --ros-args -p scene:=hurry_slow -p record.enabled:=true"):
        user.type("top_ctl --timeout 60 state")
        user.type("top_ctl hurry")
    user.type("top_replay logs/top_*.mcap --save run.rrd")  # to a file, as there is no screen
    for page in [*(path.relative_to(ROOT) for path in FIRST[1:]), *DOCUMENTS]:
        if page.stem != "lesson":  # whose lines test_lesson.py types, one step after the other
            type_page(user, page)
    user.type("make lint")
    if left := user.type("git status --porcelain").splitlines():
        user.failures.append(f"not ignored: {left}")


def type_page(user: User, page: Path) -> None:
    """Type the lines of a page, while a node runs if the page needs one."""
    lines = [words for words, _ in commands(ROOT / page)]
    if not lines:
        return
    print(f"\n{page}", flush=True)
    user.type(f".venv/bin/python -c {shlex.quote(PREPARE)} {page.stem}")
    with contextlib.ExitStack() as stack:
        if any(word in ("top_ctl", "/top") for words in lines for word in words):
            stack.enter_context(user.serving("top_node"))
            user.type("top_ctl --timeout 60 state")
        for words in lines:
            type_words(user, words)
    for name in ("run.mcap", "run.json", "run.rrd", "run.html", "whole.mcap"):
        (user.folder / name).unlink(missing_ok=True)


def type_words(user: User, words: list[str]) -> None:
    """Type one line of a page, unless it cannot be typed here."""
    words = words[3:] if words[:3] == RUN else words
    reason = next((t for each, t in NOT_TYPED.items() if (*words[: len(each)],) == each), "")
    if reason or ENCLAVE in words or "source" in words:
        print(f"# {shlex.join(words)}: {reason or 'not typed'}", flush=True)
        return
    line = " ".join(each if each.startswith("~/") else shlex.quote(each) for each in words)
    program, *rest = words
    if words in NEED_A_SCREEN:
        text = user.type(line, expected=(1,))
        if len(text.splitlines()) != 1:
            user.failures.append(f"{line}: not one line")
    elif "--web" in rest or (program in SERVERS and not {*SERVERS[program]} & {*rest}):
        with user.serving(line):
            time.sleep(SERVING)
    else:
        user.type(line)


def try_python(user: User) -> None:
    """Type the README's set-up."""
    clone(user)
    for line in list_set_up():
        user.type(line)


def try_later(user: User) -> None:
    """Change things after the set-up: each time it works, or a line says what to do."""
    clone(user)
    user.type("make panel")
    user.type("make demo")
    author = user.folder.with_name("author")
    user.type(f"git clone --quiet ../upstream ../{author.name}")

    def pull(path: str) -> None:
        """Pull a commit that adds a comment to a file."""
        comment = "# changed" if path.endswith(".py") else "// changed"
        name = "-c user.name=A -c user.email=a@example.org"
        commit = f"git {name} commit --quiet --all --message=change && git push --quiet"
        home, user.folder = user.folder, author
        user.type(f"echo '{comment}' >> {path} && {commit}")
        user.folder = home
        user.type("git pull --quiet")

    def demand(line: str, *said: str, expected: tuple[int, ...] = (0,), **variables: str) -> None:
        """Type a line of make, which prints these lines on set-ups and no other."""
        text = user.type(line, expected=expected, **variables)
        told = [each for each in text.splitlines() if each.startswith(("make: ", "Setting up"))]
        found = [each for each in told if not each.startswith("make: ***")]
        if len(found) != len(said) or any(a not in b for a, b in zip(said, found, strict=True)):
            user.failures.append(f"{line}: said {found}, expected {said}")

    built = "make: sources of the package have changed: it is built anew"
    demand("make panel")
    pull("symtop_ros/base/command.py")
    demand("make panel")
    demand("make demo")
    pull("symtop_ros/physics/kernel/symtop.h")
    demand("make demo", built)
    demand("make demo", **NO_NETWORK)
    pull("symtop_ros/physics/kernel/symtop.cpp")
    demand("make demo", built, **NO_NETWORK)
    user.type(".venv/bin/pip install --quiet '.[playback]'")
    demand("make demo", "make: the package was installed as a copy", **NO_NETWORK)
    user.folder = user.folder.rename(user.folder.with_name("moved place"))
    moved = (
        "is made anew",
        "Setting up .venv: Python",
        "Setting up .venv: NumPy",
        "make: pip could",
    )
    demand("make panel", *moved, expected=(2,), **NO_NETWORK)
    demand("make panel", "Setting up .venv: NumPy")
    if other := find_python("3.13"):
        demand(f"make PYTHON={other} panel", "and PYTHON is Python 3.13", *moved[1:3])
        demand("make panel")


def run_trial(name: str) -> list[str]:
    """Run a trial; return the lines that failed."""
    version = name.removeprefix("python")
    python = find_python(version) if name != version else None
    if name == "later":
        python = find_python(PYTHONS[0])  # not the one that it changes to
    if name != version and not python:
        print(f"{name}: there is no such Python here: not tried", flush=True)
        return []
    trials = {"documents": try_documents, "later": try_later}
    with new_user(python or "") as user:
        trials.get(name, try_python)(user)
        print(f"{name}: {user.typed - len(user.failures)} passed, {len(user.failures)} failed")
    return [f"{name}: {each}" for each in user.failures]


def main() -> int:
    """Run the trials that are named, or all; return 1 if any failed."""
    names = ("documents", *(f"python{each}" for each in PYTHONS), "later")
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trials", nargs="*", metavar="TRIAL", help="all if none is named")
    chosen = parser.parse_args().trials
    if unknown := [name for name in chosen if name not in names]:
        parser.error(f"TRIAL must be one of {', '.join(names)}, got {unknown[0]}")
    failures = [each for name in chosen or names for each in run_trial(name)]
    print("\n".join(failures) or "all lines passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
