"""Run tests of the node on CycloneDDS: topics, services, events, parameters, clocks and logs.

python test/cyclone.py FOLDER

The folder has libddsc.so and librmw_cyclonedds_cpp.so, built for the ROS 2 of this environment
(docs/ros.md). The wheels' librmw_implementation is linked to Fast DDS, so the other middleware is
preloaded.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

NAME = "rmw_cyclonedds_cpp"
LIBRARY = f"lib{NAME}.so"
SUBJECTS = ("topics", "recording", "parameters", "time", "odd_calls", "faults", "simulator")
ASK = "from rclpy import get_rmw_implementation_identifier as ask; print(ask())"
TESTS = ("test/ros/client", *(f"test/ros/node/test_{each}.py" for each in SUBJECTS))


def list_variables(folder: Path) -> dict[str, str]:
    """Return the environment in which a Python of this environment uses the libraries of a folder.

    The preloaded one is looked up before the wheels have set where their libraries are.
    """
    here = Path(sys.prefix, "lib")
    wheels = sorted(here.glob("python*/site-packages/ros_*.libs"))
    paths = os.pathsep.join(map(str, (here, folder, *wheels)))
    preloaded = str(folder / LIBRARY)
    return {"LD_LIBRARY_PATH": paths, "LD_PRELOAD": preloaded, "RMW_IMPLEMENTATION": NAME}


def main() -> int:
    """Run the tests; return the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", type=Path, help=f"with libddsc.so and {LIBRARY}")
    folder = parser.parse_args().folder.absolute()
    variables = {**os.environ, **list_variables(folder)}
    ask = [sys.executable, "-c", ASK]
    used = subprocess.run(ask, env=variables, capture_output=True, check=False)
    if used.stdout.decode().strip() != NAME:
        print(f"cyclone.py: CYCLONE must be a folder with {LIBRARY}, got {folder}", file=sys.stderr)
        return 1
    run = [sys.executable, "-m", "pytest", "-q", "-m", "not realtime and not long", *TESTS]
    return subprocess.run(run, env=variables, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
