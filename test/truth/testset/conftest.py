"""The files of the test set, as its command writes them."""

import pytest


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    """Return the folder of the whole set."""
    from symtop_ros.truth.testset.main import main

    path = tmp_path_factory.mktemp("set")
    assert main(["-o", str(path)]) == 0
    return path
