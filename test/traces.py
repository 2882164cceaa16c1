"""What tests leave behind outside the environment: nothing is allowed.

The user's other programs work meanwhile, and what is new may be theirs. A temporary folder of its
own holds nothing else. Of a file in shared memory nobody knows who made it, but while a program
uses it, it has it mapped: files that a program of others has mapped are its own, also later. In the
home only names are looked for that the tests, or the programs that they start, may write.
"""

import os
import shutil
import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path

SHARED = Path("/dev/shm")
# What fetches packages writes its cache into the home, and tracing of ROS, if it is installed,
# keeps a lock in shared memory.
ALLOWED = ("pip", ".npm", ".cache", "lttng-ust-wait")
# Empty folders that viewer and browser make and do not remove, and an empty file, which a process
# of a browser leaves if it ends while it makes shared memory; all go with the temporary folder.
OF_OTHERS = ("rerun-data-", "org.chromium.")
# Parts of the names that the tests and their programs could write in the home: this package, ROS,
# Rerun, browsers, and the tools of Python and of documents.
OF_TESTS = (
    *("symtop", "top_", ".ros", "fastdds", "fastrtps", "rerun", "colcon", "lttng"),
    *("chromium", "chrome", "mozilla", "firefox", "webkit", "playwright", "wine", "zig"),
    *("pytest", "hypothesis", "coverage", "matplotlib", "jupyter", "ipython", "numba", "mypy"),
)
PERIOD = 1.0  # s between two looks at the programs that run


def list_places() -> set[Path]:
    """Return what is in the shared memory, and in the folders of the home that programs use."""
    home = Path.home()
    folders = (SHARED, home, home / ".cache", home / ".config", home / ".local/share")
    found = (path for folder in folders if folder.is_dir() for path in folder.iterdir())
    return {path for path in found if not path.name.startswith(ALLOWED) and may_be_of_tests(path)}


def may_be_of_tests(path: Path) -> bool:
    """Return True for all in shared memory, and for a name in the home that tests may write."""
    return path.parent == SHARED or any(part in path.name.lower() for part in OF_TESTS)


def list_mapped() -> Iterator[tuple[Path, set[Path]]]:
    """Yield running programs in /proc, and the files of the shared memory that each has mapped."""
    for process in Path("/proc").glob("[0-9]*"):
        try:
            lines = (process / "maps").read_text().splitlines()
        except OSError:  # it has ended, or is another user's
            continue
        if found := {Path(line.split(maxsplit=5)[5]) for line in lines if f" {SHARED}/" in line}:
            yield process, found


def is_child(process: Path) -> bool:
    """Return True for a program in /proc that this one has started, directly or by another."""
    number = int(process.name)
    while number > 1 and number != os.getpid():
        number = int(Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[1])
    return number == os.getpid()


def is_of_others(path: Path) -> bool:
    """Return True for what viewer and browser leave: a folder, or an empty file."""
    is_named = path.name.lstrip(".").startswith(OF_OTHERS)
    return is_named and (path.is_dir() or path.stat().st_size == 0)


class Traces:
    """Return the paths that are new since this was made."""

    def __init__(self) -> None:
        self.before = list_places()
        self.folder = Path(tempfile.mkdtemp(prefix="symtop_ros-"))
        self.folder.chmod(0o1777)  # tests may run as another user
        self.variables = {"TMPDIR": str(self.folder)}
        # Playwright's Node would keep its compiled code there
        self.variables["NODE_DISABLE_COMPILE_CACHE"] = "1"
        self._of_others: set[Path] = set()  # which programs of others have had mapped
        self._ended = threading.Event()
        self._watching = threading.Thread(target=self._watch, daemon=True)
        self._watching.start()

    def find(self) -> Iterator[Path]:
        """Yield what is left."""
        yield from self._list_temporary()
        used = self._look() | self._of_others
        # with a segment in use come files of its name, for its lock
        in_use = {path.name.removesuffix("_el") for path in used}
        for path in sorted(list_places() - self.before):
            if not any(name in path.name for name in in_use):
                yield path

    def _watch(self) -> None:
        while not self._ended.wait(PERIOD):
            self._look()

    def _look(self) -> set[Path]:
        """Return what is mapped now, and note what others have mapped."""
        used = set()
        for process, mapped in list_mapped():
            used |= mapped
            if not self._is_own(process):
                self._of_others |= mapped
        return used

    def _is_own(self, process: Path) -> bool:
        """Return True for a program of the tests: by its environment, or started by one of them."""
        try:
            variables = (process / "environ").read_bytes().split(b"\0")
            return f"TMPDIR={self.folder}".encode() in variables or is_child(process)
        except OSError:  # it has just ended, and may have been one of the tests
            return True

    def _list_temporary(self) -> list[Path]:
        found = sorted(self.folder.iterdir())
        return [path for path in found if not is_of_others(path)]

    def close(self) -> None:
        """Remove the temporary folder, unless something is in it to look at."""
        self._ended.set()
        self._watching.join()
        if not self._list_temporary():
            shutil.rmtree(self.folder)
