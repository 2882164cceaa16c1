"""The map on Dask: each of its points is the motion alone, whatever the number of workers."""

import re
import sys

import numpy as np
import pytest
from documents import ROOT
from programs import execute

from symtop_ros.physics import Motion, State

pytest.importorskip("distributed", reason="no distributed: pip install distributed")
from examples.map_on_dask import SPINS, TILTS, TOP, compute_rows

SIZE = 200


def test_a_block_has_the_tilts_of_its_rows():
    whole = compute_rows(0, 6, 6, 10.0)
    assert (compute_rows(2, 4, 6, 10.0) == whole[2:4]).all()
    for row, theta in enumerate(np.linspace(*TILTS, 6)):
        for column, spin in enumerate(np.linspace(*SPINS, 6)):
            motion = Motion(TOP, State.from_euler(theta=theta, psi_dot=spin))
            assert whole[row, column] == np.float32(motion.at(10.0).euler_angles.theta)


@pytest.mark.long
@pytest.mark.parametrize("workers", [1, 2])
def test_a_cluster_of_workers_computes_the_map(workers, tmp_path):
    path = tmp_path / "map.npy"
    words = [sys.executable, "examples/map_on_dask.py"]
    words += ["--motions", SIZE**2, "--workers", workers, "-o", path]
    text = execute(words, timeout=300, check=True, cwd=ROOT).stdout
    assert re.match(rf"{SIZE**2} motions in [\d.]+ s on {workers} workers", text)
    tilts = np.load(path)
    assert tilts.shape == (SIZE, SIZE)
    assert (tilts[150:160] == compute_rows(150, 160, SIZE, 10.0)).all()
