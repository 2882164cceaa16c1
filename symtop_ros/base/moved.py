"""Import paths of 0.4 that were documented: they work through 0.5, with a DeprecationWarning."""

import importlib
import sys
import warnings
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from types import CodeType, ModuleType
from typing import Any

PACKAGE = "symtop_ros"
MOVED = {
    "simulation": "run.simulation",
    "judge": "truth.judge",
    "testset": "truth.testset",
    "imu": "truth.imu",
}


class OldNames(MetaPathFinder, Loader):
    """Finds a module by its old name: it is the one that has the new name."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the place of a module that has moved."""
        real = find_spec(rename(fullname)) if rename(fullname) else None
        if not real:
            return None
        spec = ModuleSpec(fullname, self, origin=real.origin)
        spec.submodule_search_locations = real.submodule_search_locations
        spec.has_location = real.has_location  # of the file that `python -m` runs
        return spec

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Import the module by its new name."""
        new = rename(spec.name)
        warnings.warn(f"{spec.name} is {new} now", DeprecationWarning, stacklevel=2)
        module = importlib.import_module(new)
        spec.loader_state = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        """Give the module its own place back, which the import system has replaced."""
        if module.__spec__ and module.__spec__.loader_state:
            module.__spec__ = module.__spec__.loader_state

    def get_code(self, fullname: str) -> CodeType | None:
        """Return the code that `python -m` runs."""
        warnings.warn(f"{fullname} is {rename(fullname)} now", DeprecationWarning, stacklevel=2)
        spec = find_spec(rename(fullname))
        loader: Any = spec and spec.loader
        return loader.get_code(rename(fullname)) if loader else None


def rename(fullname: str) -> str:
    """Return the new name of a module; empty if it has not moved."""
    package, _, rest = fullname.partition(".")
    first, dot, others = rest.partition(".")
    if package != PACKAGE or first not in MOVED:
        return ""
    return f"{PACKAGE}.{MOVED[first]}{dot}{others}"


def accept_old_names() -> None:
    """Find modules by their old names from now on."""
    if not any(isinstance(each, OldNames) for each in sys.meta_path):
        # before others: they would find the parts of a package a second time, by its path
        sys.meta_path.insert(0, OldNames())
