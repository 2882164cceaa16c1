"""The functions of this folder are called in the context of 50 digits, as `Motion` does."""

from decimal import localcontext

import pytest

from symtop_ros.physics.exact.precise import PRECISE


@pytest.fixture(autouse=True)
def _precise():
    with localcontext(PRECISE):
        yield
