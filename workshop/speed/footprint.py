"""Import time of the library, and its memory with many states, measured in fresh processes."""

import subprocess
import sys
from dataclasses import dataclass

import numpy as np

from workshop.speed.publish import write_chapter

RUNS = 3
IMPORTS = """
import time
began = time.perf_counter()
import numpy
libraries = time.perf_counter() - began
import symtop_ros.physics
print(libraries, time.perf_counter() - began)
"""
# The peak of the process, less what it was before the states: the times are not counted. Not
# ru_maxrss, which a process takes over from the one that started it.
MEMORY = """
from pathlib import Path
import numpy as np
from symtop_ros.physics import Motion
from workshop.speed.reference import Reference
task = Reference.read().article[0].task
motion = Motion(task.top, task.start)
times = np.linspace(0.0, 10.0, {states})
motion.at(times[:10])
def peak():
    return int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0])
before = peak()
states = motion.at(times)
print(peak() - before)
"""


@dataclass(frozen=True)
class Footprint:
    """Cost of the library apart from the time of a state."""

    # import of `symtop_ros.physics`, with NumPy; a median
    import_seconds: float
    libraries_seconds: float  # the part of NumPy in it
    states: int  # number of states for which the memory was measured
    # largest additional memory while they are computed, the states themselves included
    peak_bytes: int


def measure_footprint(states: int) -> Footprint:
    """Measure in fresh processes; on Linux, which gives the peak in KiB."""
    libraries, whole = np.median([_run(IMPORTS) for _ in range(RUNS)], axis=0)
    (peak,) = _run(MEMORY.format(states=states))
    return Footprint(float(whole), float(libraries), states, int(peak) * 1024)


def _run(program: str) -> list[float]:
    command = [sys.executable, "-c", program]
    output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return [float(each) for each in output.split()]


def format_footprint(footprint: Footprint) -> str:
    """Return the paragraph that ends the chapter on arrays."""
    return write_chapter(
        "footprint",
        whole=footprint.import_seconds * 1e3,
        libraries=footprint.libraries_seconds * 1e3,
        states=footprint.states,
        peak=footprint.peak_bytes / 2**20,
        each=footprint.peak_bytes / footprint.states,
    )
