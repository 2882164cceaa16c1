"""The programs in C++ and Rust that use the kernel, as docs/engines.md shows them."""

import itertools
import re
import shutil

import numpy as np
import pytest
from documents import ROOT, console
from log_files import ARTICLE, CUSPS
from programs import execute, find_fault

from symtop_ros.physics import Motion

pytestmark = pytest.mark.long  # test_documents.py compiles other programs of the same page
needs_compiler = pytest.mark.skipif(not shutil.which("g++"), reason="no C++ compiler")
needs_rust = pytest.mark.skipif(bool(find_fault("rustc")), reason=find_fault("rustc"))


def run_block(name, folder):
    """Run the commands of the block that names a program; return its output, and what is shown."""
    commands, shown = console(ROOT / "docs/engines.md", name)
    for part in ("symtop_ros", "examples"):
        (folder / part).symlink_to(ROOT / part)
    output = ""
    for command in commands:
        output += execute(["sh", "-c", command], cwd=folder, check=True, timeout=300).stdout
    return output, shown


@needs_compiler
def test_an_integrator_in_cpp_is_compared_with_the_library(tmp_path):
    output, promised = run_block("integrator_error", tmp_path)
    assert output == promised
    errors = [float(each) for each in re.findall(r"attitude (\S+) rad", output)]
    # Halved steps of order 4 have a sixteenth of the error; two digits of each are printed.
    assert all(15 < before / after < 32 for before, after in itertools.pairwise(errors))


@needs_compiler
@needs_rust
def test_a_program_in_rust_prints_the_doubles_of_python(tmp_path):
    output, promised = run_block("exact_top", tmp_path)
    assert output == promised
    motion = Motion(ARTICLE, CUSPS)
    smallest, largest = motion.turning_angles
    assert f"theta is between {smallest:.6f} and {largest:.6f} rad" in output
    for t, row in re.findall(r"t = +(\d+) s: \[(.*)\]", output):
        assert np.array(row.split(", "), float).tolist() == motion.at(float(t)).orientation.tolist()
