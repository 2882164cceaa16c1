"""The files of the test set, as its program writes them."""

import pytest

from symtop_ros.truth.testset.main import main


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    """Return the folder of the whole set."""
    path = tmp_path_factory.mktemp("set")
    assert main(["-o", str(path)]) == 0
    return path
