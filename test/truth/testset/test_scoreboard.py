"""All trajectories of the test set scored together."""

import json
from unittest.mock import Mock

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from truth.testset.trajectories import NAMES, write

from symtop_ros.physics import Motion, State, Top
from symtop_ros.truth.testset.folders import write_problem
from symtop_ros.truth.testset.main import main
from symtop_ros.truth.testset.score import find_problem, read_problems
from symtop_ros.truth.testset.scoreboard import Entry

PROBLEMS = ("cusps", "plane_pendulum")


def write_entry(folder, problem, name, error):
    """Write the exact states, turned about the x axis of the body by an angle in rad."""
    facts = find_problem(read_problems(), problem).facts
    q = np.array(facts["orientations"], dtype=float)[:, [1, 2, 3, 0]]
    turned = (Rotation.from_quat(q) * Rotation.from_rotvec([error, 0, 0])).as_quat()
    table = np.column_stack((facts["times"], turned[:, [3, 0, 1, 2]]))
    (folder / problem).mkdir(exist_ok=True)
    (folder / problem / f"{name}.csv").write_text(write(table, NAMES[:5]))


def test_an_entry_that_tries_more_and_solves_nothing_more_is_not_ranked_first(tmp_path, capsys):
    # solved: 2 of 2 tried, 1 of 3 tried with the rest off by 2 rad, 1 of 1 tried
    errors = {
        "careful": {"cusps": 1e-3, "rising": 1e-3},
        "bold": {"cusps": 1e-10, "rising": 2.0, "looping": 2.0},
        "shy": {"cusps": 1e-9},
    }
    for name, of in errors.items():
        for problem, error in of.items():
            write_entry(tmp_path, problem, name, error)
    assert main(["all", str(tmp_path), "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["ranking"]["2"]
    found = [(row["entry"], row["solved"], row["tried"], row["of"]) for row in rows]
    assert found == [("careful", 2, 2, 10), ("bold", 1, 3, 10), ("shy", 1, 1, 10)]


def test_engines_that_tried_few_and_solved_nothing_are_ranked_by_errors(tmp_path, capsys):
    # the order of their names is another one
    errors = {
        "a": {"cusps": 2.0, "rising": 2.0},
        "b": {"cusps": 1.0, "rising": 1.0},
        "c": {"cusps": 0.5},
        "d": {"cusps": 2.5, "rising": 2.5, "looping": 2.5},
    }
    for name, of in errors.items():
        for problem, error in of.items():
            write_entry(tmp_path, problem, name, error)
    assert main(["all", str(tmp_path), "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["ranking"]["2"]
    assert [row["entry"] for row in rows] == ["d", "b", "a", "c"]


FAULT = 3e-4  # rad, as g = 9.80665 in place of 9.81 leaves
WRONG = {
    "at once": ({"0.01": FAULT, "1e-3": FAULT, "1e-4": FAULT}, FAULT),
    "after the step": ({"0.1": 0.1, "0.01": 1e-3 + FAULT, "1e-3": FAULT, "1e-4": FAULT}, FAULT),
    "with worse rounding": ({"0.01": FAULT, "1e-3": 1.01 * FAULT}, 1.01 * FAULT),
}


@pytest.mark.parametrize(("errors", "left"), WRONG.values(), ids=WRONG)
def test_a_fault_that_no_step_removes_is_said_not_to_converge(errors, left, tmp_path, capsys):
    for step, error in errors.items():
        write_entry(tmp_path, "cusps", f"rk4-{step}", error)
    assert main(["all", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    said = f"rk4 in cusps does not converge to this motion: smaller steps leave {left:.1e} rad\n"
    assert said in text
    assert "order of rk4" not in text
    assert main(["all", str(tmp_path), "--json"]) == 0
    (order,) = json.loads(capsys.readouterr().out)["orders"]
    assert order["left"] == pytest.approx(left, rel=1e-9)


FAULTS = {"g = 9.80665": ((1.0, 9.80665 / 9.81), False), "Iz off by 1e-6": ((1 + 1e-6, 1.0), True)}


@pytest.mark.parametrize(("factors", "is_small"), FAULTS.values(), ids=FAULTS)
def test_the_motion_of_another_top_does_not_converge_to_this_one(
    factors, is_small, tmp_path, capsys
):
    facts = find_problem(read_problems(), "cusps").facts
    top = Top(facts["Ix"], facts["Iz"] * factors[0], facts["Mgl"] * factors[1])
    motion = Motion(top, State(facts["orientation"], facts["angular_velocity"]))
    table = np.column_stack((facts["times"], motion.at(facts["times"]).orientation))
    (tmp_path / "cusps").mkdir()
    for step in ("1e-3", "1e-4"):
        (tmp_path / "cusps" / f"rk4-{step}.csv").write_text(write(table, NAMES[:5]))
    assert main(["all", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert "rk4 in cusps does not converge to this motion" in text
    assert ("single precision" in text) == is_small


def test_what_single_precision_leaves_may_be_that(tmp_path, capsys):
    for step in ("0.01", "1e-3"):
        write_entry(tmp_path, "cusps", f"rk4-{step}", 1e-6)
    assert main(["all", str(tmp_path)]) == 0
    said = "does not converge to this motion, or computes in single precision: smaller steps leave"
    assert said in capsys.readouterr().out


COARSE = {
    "first order": {"0.01": 0.2, "1e-3": 0.02},
    "steps that are near each other": {"0.010": 0.2, "0.009": 0.18},
    # of a*h - b*h^2 at h = 0.01
    "an error that vanishes at one step": {"0.02": 0.2, "0.01": 1e-4, "0.005": 0.025},
    "the last step has rounding alone": {"0.01": 1e-6, "0.005": 9e-7, "1e-3": 1e-13},
}


@pytest.mark.parametrize("errors", COARSE.values(), ids=COARSE)
def test_a_method_that_is_coarse_is_not_said_to_be_wrong(errors, tmp_path, capsys):
    for step, error in errors.items():
        write_entry(tmp_path, "cusps", f"rk4-{step}", error)
    assert main(["all", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert "order of rk4 in cusps: " in text
    assert "converge" not in text


STEPS = {"rk4-1e-3": ("rk4", 0.001), "euler-2-1": ("euler-2", 1.0), "rk4": None, "rk4-0": None}


@pytest.mark.parametrize(("name", "step"), STEPS.items())
def test_the_step_of_an_entry_is_the_number_at_its_end(name, step):
    assert Entry(name, Mock()).step == step


@pytest.mark.slow
def test_the_same_is_given_as_json(tmp_path, capsys):
    for problem in PROBLEMS:
        for step in ("0.1", "0.01", "1e-3"):
            write_entry(tmp_path, problem, f"rk4-{step}", 0.5 * float(step) ** 4)
    write_entry(tmp_path, "cusps", "euler-0.01", 3.0)
    (tmp_path / "cusps" / "states.csv").write_text("name,t\n")  # the exact motion of the set
    assert main(["all", str(tmp_path), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert len(facts["scores"]) == 7
    scores = {(each["problem"], each["entry"]): each for each in facts["scores"]}
    score = scores["plane_pendulum", "rk4-0.01"]
    # 2e-15: the quaternions of the file are doubles
    assert np.array(score["errors"]) == pytest.approx(5e-9, abs=2e-15)
    assert [each["order"] for each in facts["orders"]] == pytest.approx([4.0, 4.0], abs=1e-3)
    assert facts["ranking"]["1"][0]["entry"] == "rk4-1e-3"


def test_descriptions_of_one_body_are_compared_and_are_no_further_problems(tmp_path, capsys):
    for description, error in (("", 0.02), (".turned", 0.02), (".nested", 3.0)):
        write_entry(tmp_path, f"cusps{description}", "engine", error)
    write_entry(tmp_path, "cusps", "other", 1e-9)
    write_entry(tmp_path, "cusps.offset", "other", 1.2e-9)
    assert main(["all", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert "descriptions of cusps differ in engine: plain 0.02, turned 0.02, nested 3 rad" in text
    assert "differ in other" not in text
    assert "2. engine: solved 0 of 10, tried 1," in text
    assert main(["all", str(tmp_path), "--json"]) == 0
    (difference,) = json.loads(capsys.readouterr().out)["differences"]
    assert difference["errors"] == pytest.approx({"plain": 0.02, "turned": 0.02, "nested": 3.0})


def test_a_folder_without_trajectories_is_refused_in_one_line(tmp_path, capsys):
    assert main(["all", str(tmp_path)]) == 1
    reason = "must have trajectories PROBLEM/NAME.csv, got none"
    assert capsys.readouterr().err == f"top_testset: {tmp_path} {reason}\n"


def test_what_is_wrong_with_a_start_is_said_of_each_entry(tmp_path, capsys):
    facts = find_problem(read_problems(), "cusps").facts
    q = np.array([facts["orientation"], *facts["orientations"]], dtype=float) * [1, -1, -1, -1]
    table = np.column_stack(([0.0, *facts["times"]], q / np.linalg.norm(q, axis=1)[:, np.newaxis]))
    (tmp_path / "cusps").mkdir()
    (tmp_path / "cusps" / "engine.csv").write_text(write(table, NAMES[:5]))
    write_entry(tmp_path, "cusps", "good", 1e-3)
    assert main(["cusps", str(tmp_path / "cusps" / "engine.csv")]) == 0
    alone = capsys.readouterr().out.splitlines()[0].partition("; ")[2]
    assert alone.startswith("the row at t = 0 is not the start: ")
    assert main(["all", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line for line in lines if "t = 0" in line] == [f"cusps, engine: {alone}"]


def test_a_trajectory_with_the_name_of_a_table_of_the_set_is_scored(tmp_path, capsys):
    write_problem(read_problems(), "cusps", tmp_path / "cusps")
    write_entry(tmp_path, "cusps", "world", 1e-3)
    capsys.readouterr()
    assert main(["all", str(tmp_path), "--json"]) == 0
    assert [each["entry"] for each in json.loads(capsys.readouterr().out)["scores"]] == ["world"]
