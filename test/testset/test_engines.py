"""The figures of docs/benchmarks.md for the MuJoCo that is installed here, measured again."""

import re
from pathlib import Path

import numpy as np
import pytest

from symtop_ros.testset.score import read_problems

PAGE = (Path(__file__).parents[2] / "docs/benchmarks.md").read_text()


def read_table(name):
    """Rows of a table of the page, without its head."""
    text = PAGE.partition(f"<!-- engines: {name} -->\n")[2].partition("<!-- end")[0]
    rows = [[cell.strip() for cell in row.strip("| ").split("|")] for row in text.splitlines()]
    return rows[0], rows[2:]


def integrate(mujoco, models, problem, form, integrator, steps):
    """Return the largest error in rad, and the rate across the axis at the end in rad/s."""
    model = mujoco.MjModel.from_xml_path(str(models / f"{problem.facts['name']}.{form}"))
    model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    model.opt.timestep = problem.times[0] / steps
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    found = []
    for _ in problem.times:
        mujoco.mj_step(model, data, nstep=steps)
        found.append(data.qpos[-4:].copy())
    return problem.score(found).angles.max(), np.hypot(*data.qvel[-3:-1])


def is_shown(value, text):
    """Return True if a number is one of two or three digits of the page; rounding may differ."""
    return value == pytest.approx(float(re.match(r"[-+.\de]+", text)[0]), rel=0.06)


@pytest.fixture(scope="module")
def mujoco():
    return pytest.importorskip("mujoco")


def rows_of(name, first, mujoco):
    """The rows of a table that begin with the version that is installed, if there are any."""
    rows = [row for row in read_table(name)[1] if row[0] == first]
    return rows or pytest.skip(f"no numbers of MuJoCo {mujoco.__version__}")


def test_free_bodies_are_damped_as_the_page_says(folder, mujoco):
    problem = read_problems()["free_rod_fast"]
    rows = rows_of("free", mujoco.__version__, mujoco)
    for _, integrator, error, rate in rows:
        found = integrate(mujoco, folder / "models", problem, "free.mjcf", integrator, 256)
        assert is_shown(found[0], error), (integrator, found)
        part = found[1] / problem.facts["angular_velocity"][0]
        # "1.00 of the start", or the number alone; its last digit is half a percent of the start
        assert part == pytest.approx(float(rate.split()[0]), rel=0.03, abs=0.005), integrator


def test_rk4_has_the_order_that_the_page_says(folder, mujoco):
    problem = read_problems()["gentle_cusps"]
    ((_, *errors, order),) = rows_of("order", f"MuJoCo {mujoco.__version__}, RK4", mujoco)
    found = [
        integrate(mujoco, folder / "models", problem, "mjcf", "RK4", steps)[0]
        for steps in (64, 128, 256)
    ]
    assert all(map(is_shown, found, errors)), found
    assert np.log2(found[0] / found[1]) == pytest.approx(float(order), abs=0.1)


def test_a_tumbling_top_is_integrated_as_the_page_says(folder, mujoco):
    if f"MuJoCo {mujoco.__version__}:\n" not in PAGE:
        pytest.skip(f"no numbers of MuJoCo {mujoco.__version__}")
    problem = read_problems()["tumbling"]
    for integrator, coarse, fine in read_table("tumbling")[1]:
        for steps, text in ((256, coarse), (2048, fine)):
            found, _ = integrate(mujoco, folder / "models", problem, "mjcf", integrator, steps)
            assert is_shown(found, text), (integrator, found)
