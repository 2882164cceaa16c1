"""Programs that end with the process that starts them, also if that one is killed."""

from __future__ import annotations

import shutil
from collections.abc import Sequence

SETPRIV = shutil.which("setpriv")  # of util-linux; it becomes the program, with the same id


def bound(command: Sequence[str]) -> list[str]:
    """Return a command line of which Linux ends the process when its parent ends.

    SIGTERM, and not SIGKILL, so that a program can end what it has started itself.
    """
    return [SETPRIV, "--pdeathsig", "TERM", *command] if SETPRIV else list(command)
