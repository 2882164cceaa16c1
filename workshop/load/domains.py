"""ROS domains for tests: each is held by one process at a time, also among several test runs."""

import atexit
import contextlib
import fcntl
import os
import tempfile
import time
from functools import cache
from pathlib import Path
from typing import IO

# Domain 0 is the user's, `make demo` takes 60 to 89, and beyond 101 the ports of a domain reach
# those that Linux hands out to other programs.
DOMAINS: tuple[int, ...] = (*range(1, 60), *range(90, 102))
FOLDER = Path("/tmp/symtop_ros_domains")  # also of runs that have temporary folders of their own
TIMEOUT, PERIOD = 60.0, 0.1  # s, while all are held
_held: dict[int, IO[str]] = {}
_next = os.getpid()  # a released domain is used again as late as possible


def claim_domain() -> int:
    """Return a domain that no other process holds; it is held until the process ends.

    If all are held, wait for one. RuntimeError if none is released.
    """
    FOLDER.mkdir(exist_ok=True)
    with contextlib.suppress(PermissionError):  # of another user, who has done the same
        FOLDER.chmod(0o777)
    deadline = time.monotonic() + TIMEOUT
    while (number := _find_free()) is None:
        if time.monotonic() > deadline:
            raise RuntimeError(f"all {len(DOMAINS)} domains are held")
        time.sleep(PERIOD)
    return number


@cache
def share_domain() -> int:
    """Return the domain of this process, for all tests that leave nobody behind in it."""
    return claim_domain()


def _find_free() -> int | None:
    """Take the next domain that no other process holds."""
    global _next  # noqa: PLW0603
    for _ in DOMAINS:
        _next += 1
        number = DOMAINS[_next % len(DOMAINS)]
        if number not in _held and (file := _lock(number)):
            _held[number] = file
            _sign(number)
            return number
    return None


def _sign(number: int) -> None:
    """Write whose domain it is from now on: the temporary folder of the run of tests."""
    with contextlib.suppress(OSError):  # of another user
        Path(FOLDER, str(number)).write_text(tempfile.gettempdir(), encoding="utf-8")


def is_of_run(folder: Path, number: int, since: float) -> bool:
    """Return True if a domain was of the run with a temporary folder at a time, and is still."""
    path = FOLDER / str(number)
    try:
        return path.read_text(encoding="utf-8") == str(folder) and path.stat().st_mtime <= since
    except OSError:
        return False


def release_domain(number: int) -> None:
    """Let others claim a domain again."""
    _held.pop(number).close()


@atexit.register
def _release_all() -> None:
    """Close the files before Python finds them open at its end, and says so."""
    for number in list(_held):
        release_domain(number)


def _lock(number: int) -> IO[str] | None:
    path = FOLDER / str(number)
    if not path.exists():
        path.touch()
        path.chmod(0o644)  # whatever the umask is: a lock of another user only needs to be read
    file = path.open()
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        file.close()
        return None
    return file
