"""Records in JSON: each says first what it is, and docs/json.md explains every key."""

import json
import math
import re
from hashlib import sha256

import pytest
from documents import ROOT
from log_files import Run
from truth.fit.cases import make_axis, write_table
from truth.judge.cases import Made, write_rows
from truth.judge.test_noise import EVEN, make_noisy
from truth.testset.trajectories import make_table, write

from symtop_ros import __version__
from symtop_ros.replay.main import main as replay
from symtop_ros.truth.fit.main import main as fit
from symtop_ros.truth.judge.main import main as judge
from symtop_ros.truth.judge.truth import scene_truth
from symtop_ros.truth.testset.main import main as run_testset
from symtop_ros.truth.testset.score import VERSION
from symtop_ros.truth.testset.score import main as score

TRUTH = scene_truth("cusps")
HEADER = ("t", "w", "x", "y", "z", "wx", "wy", "wz")
TEXT = (ROOT / "docs/json.md").read_text(encoding="utf-8")
# Names in records that are no keys of the schema: of topics, numbers and files.
OF_DATA = re.compile(r"/|\.json$|\d+$")
VALUES = {"values", "errors", "laws"}  # their keys are names of quantities, descriptions and laws


def list_keys(record, inside=""):
    """Return all keys of a record."""
    if isinstance(record, list):
        return {key for each in record for key in list_keys(each, inside)}
    if not isinstance(record, dict):
        return set()
    own = set() if inside in VALUES else {*record}
    return own.union(*(list_keys(value, key) for key, value in record.items()))


def assert_explained(record, kind, path):
    """Assert that a record says what it is of, and that the page has its keys."""
    assert [*record][:3] == ["schema", "version", "files"]
    assert record["schema"] == f"symtop_ros/{kind}/1"
    digest = sha256(path.read_bytes()).hexdigest()
    assert record["files"] == [{"name": str(path), "sha256": digest}]
    keys = {key for key in list_keys(record) if not OF_DATA.search(key)}
    assert {key for key in keys if f"`{key}`" not in TEXT} == set()


@pytest.fixture
def table(tmp_path):
    """Estimates with errors that last, and with a delay."""
    noisy = make_noisy(200, 10, 0.005, EVEN, False, 3)
    late = Made(delay=5e-3, noise=1e-2).make(TRUTH, noisy.stamps[::8])
    path = tmp_path / "estimates.csv"
    path.write_text(write_rows(late, order=range(7), header=HEADER))
    return path


MODES = {"judge": (), "judge of a model": ("--aligned", "world+delay")}


@pytest.mark.slow
@pytest.mark.parametrize("mode", MODES)
def test_a_judgement_says_what_it_is(mode, table, tmp_path, capsys):
    options = ["--scene", "cusps", "--estimates", str(table), "-o", str(tmp_path), *MODES[mode]]
    assert judge([*options, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert_explained(record, "judge", table)
    assert record == json.loads((tmp_path / "judge.json").read_text())
    fitted = record["found"] or record["fitted"]
    assert fitted["begin"] == 1_000_000_000
    assert fitted["delay"] == pytest.approx(5e-3, abs=5 * fitted["deviations"]["delay"])


def test_a_clock_says_what_it_is(table, capsys):
    assert judge(["--scene", "cusps", "--clock", str(table), "--json"]) == 0
    (record,) = json.loads(capsys.readouterr().out)
    assert_explained(record, "clock", table)


def test_scores_say_of_which_test_set_they_are(tmp_path, capsys):
    path = tmp_path / "set" / "cusps" / "rk4-0.01.csv"
    assert run_testset(["-o", str(tmp_path / "set")]) == 0
    whole = sha256((tmp_path / "set" / "problems.json").read_bytes()).hexdigest()
    path.parent.mkdir()
    for step, error in (("0.01", 1e-6), ("0.1", 1e-3)):
        path.with_stem(f"rk4-{step}").write_text(write(make_table("cusps", error)))
    capsys.readouterr()
    records = []
    for program, options in (
        (run_testset, ["cusps", str(path), "--json"]),
        (score, ["cusps", str(path), "--json"]),
    ):
        assert program(options) == 0
        record = json.loads(capsys.readouterr().out)
        assert_explained(record, "score", path)
        assert record.pop("version") == (__version__ if program is run_testset else VERSION)
        records.append(record)
    assert records[0] == records[1]
    assert records[0]["testset"] == {"version": VERSION, "sha256": {"problems.json": whole}}
    assert run_testset(["all", str(tmp_path / "set"), "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["testset"] == records[0]["testset"]
    assert {str(path)} < {each["name"] for each in record["files"]}
    assert_explained(record | {"files": records[0]["files"]}, "scores", path)


def test_the_scorer_alone_has_a_limit_for_continuous_integration(tmp_path, capsys):
    path = tmp_path / "trajectory.csv"
    path.write_text(write(make_table("cusps", 1e-4)))
    assert score(["cusps", str(path), "--max-error", "1e-2"]) == 0
    assert score(["cusps", str(path), "--max-error", "1e-9"]) == 1
    error = re.fullmatch(
        r"the attitude is off by (\S+) rad, limit 1e-09 rad\n", capsys.readouterr().err
    )
    # each component is off by 1e-4 at random: an angle of twice the norm of three of them
    assert 1e-4 < float(error[1]) < 2e-3


def test_a_check_says_what_it_is(tmp_path, capsys):
    path = Run().write(tmp_path)
    assert replay([str(path), "--check", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert_explained(record, "check", path)
    assert (record["good"], record["samples_agree"], record["mismatches"]) == (True, True, [])
    assert record["topics"]["/top/orientation"]["samples"] > 0
    with pytest.raises(SystemExit):
        replay([str(path), "--json"])


def test_a_number_that_is_not_finite_is_null_in_the_record_of_a_check(tmp_path, capsys):
    run = Run()
    for name in ("torque", "angular_momentum"):
        run.change(run.places(name)[100], lambda numbers: numbers + math.inf)
    assert replay([str(run.write(tmp_path)), "--check", "--json"]) == 1
    record = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert not record["laws_hold"]


def test_a_plan_says_what_it_is(capsys):
    assert fit(["--plan", "cusps", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["schema"] == "symtop_ros/fit_plan/1"
    assert {key for key in list_keys(record) if f"`{key}`" not in TEXT} == set()


def test_a_fit_says_what_it_is(tmp_path, capsys):
    path = write_table(tmp_path / "axis.csv", make_axis())
    assert fit([str(path), "--json"]) == 0
    assert_explained(json.loads(capsys.readouterr().out), "fit", path)
