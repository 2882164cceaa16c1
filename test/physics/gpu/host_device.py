"""The device's source, compiled for the host, behind the part of CuPy that the package uses."""

import ctypes
import subprocess
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from symtop_ros.physics.gpu import toolchain
from symtop_ros.physics.kernel.library import FOLDER

HOST = Path(__file__).with_name("host.cpp")
# SYMTOP_NO_LANES: states one by one, as on the device.
OPTIONS = ("-O2", "-std=c++17", "-ffp-contract=off", "-fPIC", "-shared", "-Wall", "-Wextra")
OPTIONS = (*OPTIONS, "-Werror", "-Wno-psabi", "-DSYMTOP_NO_LANES")
MEMORY = 2**30  # bytes of the device


def compile_host(folder):
    """Compile the device's source for the host; return its functions."""
    library = folder / "libhost.so"
    includes = (f"-I{toolchain.SOURCES}", f"-I{FOLDER}")
    subprocess.run(["g++", *OPTIONS, *includes, str(HOST), "-o", str(library)], check=True)
    return ctypes.CDLL(str(library))


class Array(np.ndarray):
    """An array "on the device"."""

    def get(self):
        """Return it as an array of the host."""
        return np.array(self)


def wrap(make):
    return lambda *given, **named: make(*given, **named).view(Array)


def launch(function, grid, block, arguments):
    """Run a function for all threads, as a RawKernel does."""
    function(ctypes.c_int64(grid[0]), ctypes.c_int64(block[0]), *map(pass_on, arguments))


def pass_on(argument):
    if isinstance(argument, np.ndarray):
        return ctypes.c_void_p(argument.ctypes.data)
    return {np.int64: ctypes.c_int64, np.float64: ctypes.c_double}[type(argument)](argument)


class RawModule:
    """The compiled functions by their names."""

    library = None

    def __init__(self, code, options, backend):
        assert code in {path.read_text() for path in toolchain.SOURCES.glob("*.cu")}
        assert backend == "nvrtc"
        self.options = options

    def get_function(self, name):
        return partial(launch, getattr(self.library, f"run_{name}"))


def make_cupy(library):
    """Return the module `cupy` of a device that is this host."""
    module = type("Module", (RawModule,), {"library": library})
    memory = SimpleNamespace(id=0, mem_info=(MEMORY, MEMORY), synchronize=lambda: None)
    runtime = SimpleNamespace(
        getDeviceCount=lambda: 1,
        getDeviceProperties=lambda _: {"name": b"host"},
        runtimeGetVersion=lambda: 0,
        driverGetVersion=lambda: 0,
    )
    return SimpleNamespace(
        ndarray=Array,
        linspace=wrap(np.linspace),
        zeros=wrap(np.zeros),
        empty=wrap(np.empty),
        asarray=wrap(np.asarray),
        ascontiguousarray=wrap(np.ascontiguousarray),
        from_dlpack=wrap(np.from_dlpack),
        RawModule=module,
        cuda=SimpleNamespace(Device=lambda: memory, runtime=runtime),
        get_default_memory_pool=lambda: SimpleNamespace(free_bytes=lambda: 0),
    )
