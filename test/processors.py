"""Variables under which libraries compute as on another processor.

python test/processors.py PROCESSOR COMMAND... runs a command under them.

What NumPy, OpenBLAS and the C library compute in the last bits depends on the instructions that
they find. An instruction that is missing cannot be added: each variable takes some away.
"""

import os
import sys
from pathlib import Path

try:
    from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__
except ImportError:  # NumPy 1
    from numpy.core._multiarray_umath import __cpu_dispatch__, __cpu_features__

CPUINFO = Path("/proc/cpuinfo")
# Names of glibc 2.33 and later, and those before.
GLIBC = [f"-{name}{end}" for name in ("AVX2", "AVX", "FMA", "FMA4") for end in ("", "_Usable")]
WIDE = ("AVX512", "X86_V4")  # how NumPy's features with 512 bits begin


def without_features(*beginnings: str) -> dict[str, str]:
    """Return the variable that takes features of some beginnings from NumPy; all for ""."""
    found = [name for name in __cpu_dispatch__ if __cpu_features__[name]]
    less = [name for name in found if name.startswith(beginnings)]
    return {"NPY_DISABLE_CPU_FEATURES": " ".join(less)} if less else {}


def old_processor() -> dict[str, str]:
    """Return the variables of a processor of 2008: SSE4 in NumPy and OpenBLAS, SSE2 in glibc."""
    tunables = f"glibc.cpu.hwcaps={','.join(GLIBC)}"
    less = {"OPENBLAS_CORETYPE": "Nehalem", "GLIBC_TUNABLES": tunables}
    return less | without_features("")


def list_processors() -> dict[str, dict[str, str]]:
    """Return the variables of each processor, by the name that OpenBLAS has for it."""
    flags = CPUINFO.read_text().split() if CPUINFO.exists() else []
    processors = {"Nehalem": old_processor()}
    for name in ("Haswell", "Zen"):
        processors[name] = {"OPENBLAS_CORETYPE": name, **without_features(*WIDE)}
    if "avx512f" in flags:
        processors["SkylakeX"] = {"OPENBLAS_CORETYPE": "SkylakeX"}
    return processors


if __name__ == "__main__":
    os.execvpe(sys.argv[2], sys.argv[2:], {**os.environ, **list_processors()[sys.argv[1]]})
