"""Find files that tests leave outside the environment: none is allowed.

The user's other programs work meanwhile, and what is new may be theirs. The temporary folder of the
run is its own. In shared memory the ports of Fast DDS count, in domains that the run has claimed;
which program made other files is not known. In the home only names count that the tests, or the
programs that they start, may write.
"""

import contextlib
import re
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from workshop.load.domains import is_of_run

SHARED = Path("/dev/shm")
# What fetches packages writes its cache into the home, and tracing of ROS, if it is installed,
# keeps a lock in shared memory.
ALLOWED = ("pip", ".npm", ".cache", "lttng-ust-wait")
# Folders that viewer and browser make and do not remove; and shared memory of the browser, which
# Chromium makes as a file of that name and unlinks only when it has its size, so that a process
# that is ended in between leaves it. All go with the temporary folder.
OF_OTHERS = ("rerun-data-", "org.chromium.")
# Parts of the names that the tests and their programs could write in the home: this package, ROS,
# Rerun, browsers, and the tools of Python and of documents.
OF_TESTS = (
    *("symtop", "top_", ".ros", "fastdds", "fastrtps", "rerun", "colcon", "lttng"),
    *("chromium", "chrome", "mozilla", "firefox", "webkit", "playwright", "wine", "zig"),
    *("pytest", "hypothesis", "coverage", "matplotlib", "jupyter", "ipython", "numba", "mypy"),
)
# Fast DDS has a file for each port of a domain; the ports are those of the RTPS specification.
PORT = re.compile(r"(?:sem\.)?fastrtps_port(\d+)(?:_\w+)?")
FIRST_PORT, PORTS = 7400, 250


def list_places() -> set[Path]:
    """Return what is in the shared memory, and in the folders of the home that programs use."""
    home = Path.home()
    folders = (SHARED, home, home / ".cache", home / ".config", home / ".local/share")
    found = (path for folder in folders if folder.is_dir() for path in folder.iterdir())
    return {path for path in found if not path.name.startswith(ALLOWED) and may_be_of_tests(path)}


def may_be_of_tests(path: Path) -> bool:
    """Return True for all in shared memory, and for a name in the home that tests may write."""
    return path.parent == SHARED or any(part in path.name.lower() for part in OF_TESTS)


def find_domain(path: Path) -> int:
    """Return the domain of a port of Fast DDS in shared memory; -1 for another file."""
    found = PORT.fullmatch(path.name)
    return (int(found[1]) - FIRST_PORT) // PORTS if found else -1


def remove_ports(domain: int) -> None:
    """Remove what a killed program keeps: the ports of readers to which it had sent."""
    for path in SHARED.iterdir() if SHARED.is_dir() else ():
        if find_domain(path) == domain:
            path.unlink(missing_ok=True)


def list_used() -> set[str]:
    """Return the names of the shared memory that this process has mapped; it removes it later."""
    maps = Path("/proc/self/maps")
    lines = maps.read_text().splitlines() if maps.exists() else []
    return {Path(line.split(maxsplit=5)[5]).name for line in lines if f" {SHARED}/" in line}


def is_of_others(path: Path) -> bool:
    """Return True for what viewer and browser leave, by its name."""
    return path.name.lstrip(".").startswith(OF_OTHERS)


class Traces:
    """Return the paths that are new since this was made."""

    def __init__(self) -> None:
        self.before = list_places()
        self.folder = Path(tempfile.mkdtemp(prefix="symtop_ros-"))
        self.folder.chmod(0o1777)  # tests may run as another user
        self.variables = {"TMPDIR": str(self.folder)}
        # Playwright's Node would keep its compiled code there
        self.variables["NODE_DISABLE_COMPILE_CACHE"] = "1"

    def find(self) -> Iterator[Path]:
        """Yield what is left."""
        yield from self._list_temporary()
        used = list_used()
        for path in sorted(list_places() - self.before):
            is_used = any(name in path.name for name in used)
            if path.parent != SHARED or (self._is_own_port(path) and not is_used):
                yield path

    def _is_own_port(self, path: Path) -> bool:
        """Return True for a port that was made in a domain while this run had it."""
        domain = find_domain(path)
        with contextlib.suppress(FileNotFoundError):  # another program has just removed it
            return is_of_run(self.folder, domain, path.stat().st_ctime)
        return False

    def _list_temporary(self) -> list[Path]:
        found = sorted(self.folder.iterdir())
        return [path for path in found if not is_of_others(path)]

    def close(self) -> None:
        """Remove the temporary folder, unless something is in it to look at."""
        if not self._list_temporary():
            shutil.rmtree(self.folder)
