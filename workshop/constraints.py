"""Pin the tools of the tests to what is installed: python -m workshop.constraints.

A linter or a type checker that is newer finds what nobody changed. So a checkout is tested with the
versions of test/constraints.txt, until this writes it anew. What the package itself runs on (NumPy,
SciPy, Rerun, ROS 2) is not pinned: `setup.py` has lower bounds, and users have any version above.
"""

import re
from importlib.metadata import metadata, version
from pathlib import Path

FILE = Path(__file__).resolve().parents[1] / "test/constraints.txt"
EXTRAS = "test", "lint"
REQUIREMENT = re.compile(r"([\w.-]+)[^;]*; extra == \"(\w+)\"")
HEAD = "# Versions of the tools of the tests; written by python -m workshop.constraints\n"


def write_constraints() -> str:
    """Return the lines of the file: each tool of the extras with its installed version."""
    found = metadata("symtop_ros").get_all("Requires-Dist") or []
    named = [match for each in found if (match := REQUIREMENT.match(each.replace("'", '"')))]
    tools = {match[1].lower() for match in named if match[2] in EXTRAS}
    return HEAD + "".join(f"{name}=={version(name)}\n" for name in sorted(tools))


if __name__ == "__main__":
    FILE.write_text(write_constraints(), encoding="utf-8")
    print(f"wrote {FILE}")
