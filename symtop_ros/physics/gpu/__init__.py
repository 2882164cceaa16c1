"""Motions of up to millions of tops on an NVIDIA GPU, with the bits of the CPU.

The device runs the kernel's own headers, one thread for a motion; `device/` has what is added, and
`toolchain.py` compiles it with NVRTC at the first use (up to a minute, then from CuPy's cache),
compares it with the CPU, and refuses to work if any bit differs. Begin with `Motions`. It needs
CuPy (extras `gpu-cuda12` and `gpu-cuda13`), and nothing else of the package imports it.

`python -m symtop_ros.physics.gpu` compares a million motions and prints the speeds.
"""

from symtop_ros.physics.gpu.motions import Motions, States
from symtop_ros.physics.gpu.toolchain import DeviceError

__all__ = ["DeviceError", "Motions", "States"]
