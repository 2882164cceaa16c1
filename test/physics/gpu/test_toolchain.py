"""The device's source in NVIDIA's compilers: no product is fused, no register is spoiled.

They come from PyPI, into a separate environment: `make set-up-gpu`. No GPU is needed.
"""

import os
import re

import pytest
from documents import ROOT
from physics.gpu.registers import find_suspects
from programs import execute

from symtop_ros.physics.gpu import toolchain

PYTHON = ROOT / ".venv/gpu/bin/python"
pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(not PYTHON.exists(), reason="make set-up-gpu fetches NVIDIA's compilers"),
]
COMPILERS = {"13.0": ("cu13/lib", "cu13/bin"), "12.9": ("cuda_nvrtc/lib", "cuda_nvcc/bin")}
# Ampere, Ada, Hopper, Blackwell of data centres, and of workstations.
ARCHITECTURES = ("80", "89", "90", "100", "120")
# Compiles a file with NVRTC: source, target, options.
NVRTC = """
import ctypes, glob, sys
source, target, library, *options = sys.argv[1:]
nvrtc, program, size = ctypes.CDLL(glob.glob(library)[0]), ctypes.c_void_p(), ctypes.c_size_t()
text = open(source, "rb").read()
nvrtc.nvrtcCreateProgram(ctypes.byref(program), text, source.encode(), 0, None, None)
words = (ctypes.c_char_p * len(options))(*(each.encode() for each in options))
status = nvrtc.nvrtcCompileProgram(program, len(options), words)
nvrtc.nvrtcGetProgramLogSize(program, ctypes.byref(size))
log = ctypes.create_string_buffer(size.value)
nvrtc.nvrtcGetProgramLog(program, log)
if status:
    sys.exit(log.value.decode())
nvrtc.nvrtcGetPTXSize(program, ctypes.byref(size))
ptx = ctypes.create_string_buffer(size.value)
nvrtc.nvrtcGetPTX(program, ptx)
open(target, "wb").write(ptx.value)
"""


def find_nvidia():
    (folder,) = PYTHON.parents[1].glob("lib/python*/site-packages/nvidia")
    return folder


def compile_ptx(version, architecture, folder, options=None):
    """Compile motions.cu; return the path of the PTX."""
    library = find_nvidia() / COMPILERS[version][0]
    target = folder / f"{version}-{architecture}.ptx"
    words = [PYTHON, "-c", NVRTC, toolchain.MAIN, target, f"{library}/libnvrtc.so.1?"]
    options = [f"-arch=compute_{architecture}", *(options or toolchain.list_options())]
    execute([*words, *options], check=True, env={**os.environ, "LD_LIBRARY_PATH": str(library)})
    return target


@pytest.mark.parametrize("version", COMPILERS)
def test_only_the_three_products_that_the_source_names_are_fused(version, tmp_path):
    """Twice in arithmetic of two doubles that is exact with it, and once in its rest."""
    text = compile_ptx(version, "90", tmp_path).read_text()
    assert len(re.findall(r"\bfma\.rn\.f64\b", text)) == 3
    assert ".extern .func" not in text
    called = set(
        re.findall(r"^\s*(?:call[^;]*?\s)\(?[\w, ]*\)?,?\s*(\w+),?\s*$", text, re.MULTILINE)
    )
    assert {name for name in called if not name.startswith(("_Z", "param", "retval"))} == set()


def test_the_count_finds_products_that_are_fused(tmp_path):
    options = [each.replace("--fmad=false", "--fmad=true") for each in toolchain.list_options()]
    text = compile_ptx("13.0", "90", tmp_path, options).read_text()
    assert len(re.findall(r"\bfma\.rn\.f64\b", text)) > 100


@pytest.mark.parametrize("architecture", ARCHITECTURES)
@pytest.mark.parametrize("version", COMPILERS)
def test_no_uniform_register_is_overwritten_in_another_arm(version, architecture, tmp_path):
    ptx = compile_ptx(version, architecture, tmp_path)
    cubin = tmp_path / "motions.cubin"
    programs = find_nvidia() / COMPILERS[version][1]
    execute([programs / "ptxas", f"-arch=sm_{architecture}", ptx, "-o", cubin], check=True)
    newest = find_nvidia() / COMPILERS["13.0"][1]  # cuobjdump reads the code of all
    path = {**os.environ, "PATH": f"{newest}:{os.environ['PATH']}"}
    sass = execute([newest / "cuobjdump", "-sass", cubin], check=True, env=path).stdout
    found = find_suspects(sass)
    assert found.keys() == {*toolchain.FUNCTIONS}
    assert not any(found.values()), found
