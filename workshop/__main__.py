"""`python -m workshop COMMAND`, in a checkout."""

import sys

from symtop_ros.programs import run

sys.exit(run("workshop", "workshop", interruptible=True))
