"""Programs that end with the process that starts them, also if that one is killed.

They heed SIGHUP, also when the tests themselves ignore it, under nohup.
"""

import shutil
from collections.abc import Sequence

ENV = shutil.which("env")
SETPRIV = shutil.which("setpriv")  # of util-linux; it becomes the program, with the same id


def bound(command: Sequence[str]) -> list[str]:
    """Return a command line of which Linux ends the process when its parent ends.

    SIGTERM, and not SIGKILL, so that a program can end what it has started itself.
    """
    if not (SETPRIV and ENV):
        return list(command)
    return [ENV, "--default-signal=HUP", SETPRIV, "--pdeathsig", "TERM", *command]
