"""Run the tests of physics, runs, logs and estimates as on other machines.

python test/elsewhere.py [MACHINE...]

A machine is a processor (test/processors.py), a country, or the account of a stranger: a checkout
with blanks and umlauts in its path that may not be written to, a user who is not root, an empty
HOME, rustup without a toolchain, no compiler and no npm.
"""

import argparse
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from processors import list_processors

ROOT = Path(__file__).parents[1]
RUN = ("run/simulation", "run/session", "run/log", "run/check")
FOLDERS = tuple(f"test/{folder}" for folder in ("physics", *RUN, "truth/judge"))
# A read-only checkout has no place for the cache.
PYTEST = (sys.executable, "-m", "pytest", "-q", "-n", "3", "--dist", "loadfile")
OPTIONS = ("-p", "no:cacheprovider", "-m", "not realtime and not long")
# Decimal commas, a dotless i, and times at which it is another day.
COUNTRIES = {"tr_TR": "Pacific/Kiritimati", "de_DE": "Pacific/Pago_Pago"}
NOT_COPIED = (".git", ".venv", ".hypothesis", "__pycache__", "report", "site", "build")
# A stranger has none of these.
TOOLS = ("c++", "g++", "gcc", "cc", "clang", "clang++", "rustc", "cargo", "node", "npm", "npx")
RUSTUP = "#!/bin/sh\necho 'error: rustup could not choose a version of rustc to run' >&2\nexit 1\n"
NOBODY = "65534"


@dataclass(frozen=True)
class Command:
    """A run of the tests, and the checkout in which it runs."""

    words: tuple[str, ...]
    folder: Path = ROOT


def make_command(
    variables: Mapping[str, str], *before: str, folder: Path = ROOT, plugins: tuple[str, ...] = ()
) -> Command:
    """Return the command that runs the tests of the folders under some variables."""
    environment = ("env", *(f"{name}={value}" for name, value in variables.items()), *before)
    options = tuple(word for plugin in plugins for word in ("-p", plugin))
    return Command((*environment, *PYTEST, *OPTIONS, *options, *FOLDERS), folder)


def make_country(locale: str, zone: str, folder: Path) -> Command:
    """Return the command for a country: its locale, its time, a random hash and a umask of 077."""
    place = folder / "locales" / f"{locale}.UTF-8"
    place.parent.mkdir(exist_ok=True)
    define = ["localedef", "-i", locale, "-f", "UTF-8", str(place)]
    subprocess.run(define, check=False, capture_output=True)  # it warns, and says so by its status
    variables = {"LC_ALL": f"{locale}.UTF-8", "LOCPATH": str(place.parent), "TZ": zone}
    umask = ("sh", "-c", 'umask 077; exec "$@"', "sh")
    return make_command(
        {**variables, "PYTHONHASHSEED": "random"}, *umask, plugins=("foreign_locale",)
    )


def copy_checkout(folder: Path) -> Path:
    """Copy the checkout, with a link to its environment, and return where it may only be read."""
    copy = folder / "größe top"
    shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(*NOT_COPIED))
    (copy / ".venv").symlink_to(ROOT / ".venv")
    subprocess.run(["chmod", "-R", "a-w,a+rX", str(copy)], check=True)
    return copy


def copy_path(folder: Path) -> str:
    """Return a PATH of links to all programs but tools, with a rustup that has no toolchain."""
    programs = folder / "programs"
    programs.mkdir()
    for path in os.get_exec_path():
        for program in Path(path).glob("*"):
            if not program.name.startswith(TOOLS):
                with contextlib.suppress(FileExistsError):
                    (programs / program.name).symlink_to(program)
    for name in ("rustc", "cargo"):
        (programs / name).write_text(RUSTUP)
        (programs / name).chmod(0o755)
    return str(programs)


def make_stranger(folder: Path) -> Command:
    """Return the command for a user who is not root, and has next to nothing."""
    copy = copy_checkout(folder)
    home = folder / "home"
    home.mkdir()
    home.chmod(0o777)
    variables = {"HOME": str(home), "PATH": copy_path(folder), "PYTHONPATH": str(copy)}
    return make_command(variables, *(give_up_rights() if os.geteuid() == 0 else ()), folder=copy)


def give_up_rights(python: Path = Path(sys.executable)) -> tuple[str, ...]:
    """Return what makes root a user without rights: nobody, if that user may run the Python."""
    places = python.resolve().parents
    if all(place.stat().st_mode & 0o001 for place in places):
        return "setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"
    # A Python in the home of root: permissions of files then count for root, too.
    return "setpriv", "--bounding-set=-dac_override,-dac_read_search"


@contextlib.contextmanager
def machines() -> Iterator[dict[str, Command]]:
    """Provide the commands of each machine, by its name."""
    with tempfile.TemporaryDirectory(prefix="elsewhere-") as name:
        folder = Path(name)
        folder.chmod(0o755)
        found = {name: make_command(each) for name, each in list_processors().items()}
        found |= {name: make_country(name, zone, folder) for name, zone in COUNTRIES.items()}
        found["stranger"] = make_stranger(folder)
        try:
            yield found
        finally:
            subprocess.run(["chmod", "-R", "u+w", name], check=False)


def run(name: str, command: Command) -> bool:
    """Run the tests as on a machine; return True if none failed."""
    print(f"\nAs on {name}", flush=True)
    return not subprocess.run(command.words, cwd=command.folder, check=False).returncode


def main() -> int:
    """Run the tests on the machines that are named, or on all; return 1 if any failed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("machines", nargs="*", metavar="MACHINE", help="all if none is named")
    chosen = parser.parse_args().machines
    with machines() as found:
        if unknown := [name for name in chosen if name not in found]:
            parser.error(f"MACHINE must be one of {', '.join(found)}, got {unknown[0]}")
        failed = [name for name in chosen or found if not run(name, found[name])]
    print(f"failed on: {', '.join(failed)}" if failed else "passed on all")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
