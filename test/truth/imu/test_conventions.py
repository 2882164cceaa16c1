"""The conventions of filters in docs/filters.md, line by line: a sensor at rest."""

import importlib
import re
from pathlib import Path

import numpy as np
import pytest

from symtop_ros.base.arrays import compose, invert
from symtop_ros.physics import State

PAGE = Path(__file__).parents[3] / "docs/filters.md"
ROW = re.compile(r"^\| (\w+) (\w+) \| (rad|deg) \| (\S+) \| (\w+), (\w+), (\w+) \| (.*) \|$", re.M)
TRUTH = State.from_euler(theta=0.4, phi=0.9, psi=-0.3)
FIELD = (0.0, 20.0, -40.0)  # uT: y is north
COUNT, RATE = 20_000, 100.0  # samples, and Hz: until a filter with small gains has settled
DIRECTIONS = {"east": (1, 0, 0), "north": (0, 1, 0), "up": (0, 0, 1)}
DIRECTIONS |= {"west": (-1, 0, 0), "down": (0, 0, -1)}


def run_ahrs(name, gyr, acc, mag):
    kind = getattr(importlib.import_module("ahrs.filters"), name)
    if name == "Tilt":
        return kind(acc=acc[:1], mag=mag[:1] * 1e3).Q[-1]
    return kind(gyr=gyr, acc=acc, mag=mag * 1e3, frequency=RATE).Q[-1]  # nT


def run_vqf(name, gyr, acc, mag):
    found = getattr(importlib.import_module("vqf"), name)(1 / RATE).updateBatch(gyr, acc, mag)
    return found["quat9D"][-1]


def run_imufusion(name, gyr, acc, mag):
    module = importlib.import_module("imufusion")
    settings, ahrs = module.AhrsSettings(), module.Ahrs()
    settings.convention = getattr(module, f"CONVENTION_{name}")
    settings.sample_rate = RATE
    ahrs.set_settings(settings)
    for parts in zip(gyr, acc, mag, strict=True):
        ahrs.update(*parts)
    return np.array(ahrs.get_quaternion())


RUNS = {"ahrs": run_ahrs, "vqf": run_vqf, "imufusion": run_imufusion}
ROWS = ROW.findall(PAGE.read_text(encoding="utf-8"))


def test_the_page_has_a_line_for_each_package():
    assert {package for package, *_ in ROWS} == {*RUNS}
    assert len(ROWS) == 10


@pytest.mark.long
@pytest.mark.parametrize(("package", "name", "angle", "force", "x", "y", "z", "turns"), ROWS)
def test_a_filter_has_the_conventions_of_its_line(package, name, angle, force, x, y, z, turns):
    pytest.importorskip(package)
    rates = TRUTH.to_body((0.0, 0.0, 1e-9)) * (180 / np.pi if angle == "deg" else 1.0)
    acc = TRUTH.to_body((0.0, 0.0, 1.0 if force == "g" else 9.81))
    parts = [np.tile(each, (COUNT, 1)) for each in (rates, acc, TRUTH.to_body(FIELD))]
    found = RUNS[package](name, *parts)
    found = invert(found) if turns == "world to body" else found
    axes = np.array([DIRECTIONS[each] for each in (x, y, z)], dtype=float)
    # from the filter's world to the node's: its axes are the columns
    turned = compose(
        State.from_matrix(axes.T, (0.0, 0.0, 0.0)).orientation, found / np.linalg.norm(found)
    )
    # an accelerometer and a field at rest decide the attitude; filters stop within some mrad of it
    assert 2 * np.arccos(min(1.0, abs(turned @ TRUTH.orientation))) < 0.02
