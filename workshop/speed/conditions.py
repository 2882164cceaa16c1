"""The machine, the day and the versions of a measurement."""

import os
import platform
from collections.abc import Iterable
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from symtop_ros import __version__


def describe_conditions(*packages: str) -> str:
    """Return the machine, the date, and the versions of this package and of others."""
    versions = {"symtop_ros": __version__, **find_versions(packages)}
    named = ", ".join(f"{name} {number}" for name, number in versions.items())
    return f"{find_machine()}, {find_date()}; {named}"


def find_machine() -> str:
    """Return the name of the processor, and the system."""
    names = [platform.processor(), platform.machine()]
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.is_file():
        lines = cpuinfo.read_text(encoding="utf-8").splitlines()
        names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return f"{next(filter(None, names), 'an unnamed processor')}, {platform.system()}"


def find_load() -> str:
    """Return how many programs wanted a processor in the last quarter of an hour."""
    return f"{os.getloadavg()[2]:.1f} on {os.cpu_count()} processors"


def find_date() -> str:
    """Return the present day."""
    return datetime.now(tz=UTC).date().isoformat()


def find_versions(packages: Iterable[str]) -> dict[str, str]:
    """Return the versions of packages, of those that are installed."""
    versions = {}
    for package in packages:
        try:
            versions[package] = version(package)
        except PackageNotFoundError:
            continue
    return versions
