"""What tests leave behind outside the environment: nothing is allowed.

A temporary folder of its own shows what stays in it. Shared memory that a running program has
mapped is in use: its own, or that of another program of the machine.
"""

import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

SHARED = Path("/dev/shm")
# What fetches packages writes its cache into the home, and tracing of ROS, if it is installed,
# keeps a lock in shared memory.
ALLOWED = ("pip", ".npm", ".cache", "lttng-ust-wait")
# Empty folders that viewer and browser make and do not remove, and an empty file, which a process
# of a browser leaves if it ends while it makes shared memory; all go with the temporary folder.
OF_OTHERS = ("rerun-data-", "org.chromium.")


def list_places() -> set[Path]:
    """Return what is in the shared memory, and in the folders of the home that programs use."""
    home = Path.home()
    folders = (SHARED, home, home / ".cache", home / ".config", home / ".local/share")
    found = (path for folder in folders if folder.is_dir() for path in folder.iterdir())
    return {path for path in found if not path.name.startswith(ALLOWED)}


def list_mapped() -> set[Path]:
    """Return the files of the shared memory that running programs have mapped."""
    found = set()
    for maps in Path("/proc").glob("[0-9]*/maps"):
        try:
            lines = maps.read_text().splitlines()
        except OSError:  # it has ended, or is another user's
            continue
        found |= {Path(line.split(maxsplit=5)[5]) for line in lines if f" {SHARED}/" in line}
    return found


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

    def find(self) -> Iterator[Path]:
        """Yield what is left."""
        yield from self._list_temporary()
        used = list_mapped()
        # with a segment in use come files of its name, for its lock
        in_use = {path.name.removesuffix("_el") for path in used}
        for path in sorted(list_places() - self.before):
            if not any(name in path.name for name in in_use):
                yield path

    def _list_temporary(self) -> list[Path]:
        found = sorted(self.folder.iterdir())
        return [path for path in found if not is_of_others(path)]

    def close(self) -> None:
        """Remove the temporary folder, unless something is in it to look at."""
        if not self._list_temporary():
            shutil.rmtree(self.folder)
