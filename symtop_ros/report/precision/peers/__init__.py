"""What the package is measured beside: one file for each, and the package's own engines."""

from __future__ import annotations

from importlib import import_module

from symtop_ros.report.precision.peers.peer import Peer

ALWAYS = ("own", "scipy_peer")
OPTIONAL = {  # what has to be installed, and the file here
    "heyoka": "heyoka_peer",
    "mujoco": "mujoco_peer",
    "pydrake": "drake_peer",
    "pinocchio": "pinocchio_peer",
    "exudyn": "exudyn_peer",
    "diffrax": "diffrax_peer",
}


def installed() -> tuple[list[Peer], list[str]]:
    """Return the peers that can be imported, our own first, and the names of those that cannot."""
    modules, missing = [import_module(f"{__name__}.{file}") for file in ALWAYS], []
    for name, file in OPTIONAL.items():
        try:
            modules.append(import_module(f"{__name__}.{file}"))
        except ImportError:
            missing.append(name)
    return [peer for module in modules for peer in module.PEERS], missing
