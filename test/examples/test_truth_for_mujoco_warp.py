import os
import re

import pytest
from documents import ROOT
from programs import execute

PYTHON = ROOT / ".venv/gpu/bin/python"
pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(not PYTHON.exists(), reason="make set-up-gpu fetches MuJoCo Warp"),
]


def test_tops_of_mujoco_warp_are_where_its_steps_and_digits_let_them_be():
    words = [PYTHON, "examples/truth_for_mujoco_warp.py", "--tops", 64, "--steps", 50]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = execute([*words, "--seconds", 0.05], check=True, cwd=ROOT, env=environment, timeout=900)
    median, largest = map(float, re.findall(r"(?:median|largest) (\S+) rad", done.stdout))
    # 24 bits, 50 steps of 1 ms in which the top turns by up to 0.3 rad: Euler's second order
    assert 1e-8 < median < largest < 1e-2
