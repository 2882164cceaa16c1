"""The command line of top_testset: what it lists, writes and scores, and what cites a score."""

import hashlib
import json
import platform
import re
import sys

import numpy as np
import pytest
from documents import ROOT
from programs import execute
from truth.testset.trajectories import make_table, write

from symtop_ros import __version__
from symtop_ros.run.models import name_file
from symtop_ros.truth.testset.forms import FORMS
from symtop_ros.truth.testset.main import main
from symtop_ros.truth.testset.score import VERSION
from symtop_ros.truth.testset.score import main as score


def test_the_test_set_is_listed_copied_and_scored(tmp_path, capsys):
    assert main([]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 71
    assert main(["cusps", "-o", str(tmp_path)]) == 0
    described = ("turned", "inertial", "nested_half", "offset", "nested")
    # what the formats cannot say
    left_out = {
        f"cusps.{each}" for each in ("offset.urdf", "nested.sdf", "nested.usda", "inertial.usda")
    }
    forms = ("urdf", "sdf", "mjcf", "usda")
    models = {f"cusps.{each}.{form}" for each in described for form in forms}
    models |= {name_file(f"cusps.{each}", form) for each, form in FORMS}
    assert {path.name for path in tmp_path.iterdir()} == models - left_out | {
        *(f"cusps.{suffix}" for suffix in ("json", *forms)),
        *(f"{name}.csv" for name in ("problems", "states", "forces", "world")),
        "score.py",
        "README.md",
        "LICENSE",
        "SHA256SUMS",
    }
    readme = (tmp_path / "README.md").read_text()
    assert "[symtop_ros]" not in readme.replace("[symtop_ros](", "")
    path = tmp_path / "mine.csv"
    path.write_text(write(make_table("cusps")))
    capsys.readouterr()
    assert main(["cusps", str(path), "--max-error", "1e-15"]) == 0
    assert capsys.readouterr().out.startswith("cusps: attitude ")
    assert main(["cusps", str(path), "--max-error", "1e-17"]) == 1
    assert capsys.readouterr().err.endswith("rad, limit 1e-17 rad\n")
    assert main(["cusps", str(path), "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["errors"]) == 20
    assert main(["none", str(path)]) == 1
    assert "top_testset: problem must be one of gentle_cusps, " in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["cusps"], "PROBLEM with a TRAJECTORY to score, or with -o FOLDER to write it, is needed"),
        (
            ["cusps", "mine.csv", "-o", "."],
            "TRAJECTORY (to score) must be given without -o (to write)",
        ),
        (["cusps", "-o", ".", "--json"], "--json and --max-error must be used with a TRAJECTORY"),
        (["--max-error", "1"], "--json and --max-error must be used with a TRAJECTORY"),
    ],
)
def test_what_does_not_go_together_is_status_2(words, reason, capsys):
    with pytest.raises(SystemExit) as end:
        main(words)
    assert end.value.code == 2
    assert capsys.readouterr().err.endswith(f"top_testset: error: {reason}\n")


def test_the_help_says_in_three_lines_what_an_author_of_an_engine_types(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    said = capsys.readouterr().out.split("\n\n")[1]
    lines = said.splitlines()
    assert len(lines) == 3
    assert max(map(len, lines)) < 80
    commands = [re.split("  +", line.strip())[0].split() for line in lines[1:]]
    assert commands == [
        ["top_testset", "cusps", "-o", "cusps"],
        ["top_testset", "cusps", "cusps/mine.csv"],
    ]


STATED = "# written by hand\n#Engine:  MuJoCo 4.0.0, RK4 \n"


@pytest.mark.parametrize(("head", "engine"), [(STATED, "MuJoCo 4.0.0, RK4"), ("", None)])
def test_a_score_can_be_cited(head, engine, tmp_path, capsys):
    assert main(["-o", str(tmp_path / "set")]) == 0
    problems = (tmp_path / "set/problems.json").read_bytes()
    path = tmp_path / "mine.csv"
    path.write_text(head + write(make_table("cusps")))
    for program, name in ((main, f"symtop_ros {__version__}"), (score, f"score.py {VERSION}")):
        capsys.readouterr()
        assert program(["cusps", str(path), "--json"]) == 0
        record = json.loads(capsys.readouterr().out)
        assert record["engine"] == engine
        assert record["platform"] == {
            "system": platform.system(),
            "machine": platform.machine(),
            "python": platform.python_version(),
            "numpy": np.__version__,
        }
        assert program(["cusps", str(path)]) == 0
        _, stated, cited = capsys.readouterr().out.splitlines()
        assert stated.partition("; ")[0] == f"engine: {engine or 'not stated'}"
        pattern = rf"test set {VERSION} \(SHA-256: problems.json (\w+)\), scored by {name} on "
        found = re.match(pattern, cited)
        assert hashlib.sha256(problems).hexdigest().startswith(found[1])
        assert len(found[1]) == 12
        place = record["platform"]
        assert cited[found.end() :] == (
            f"{place['system']} {place['machine']}, Python {place['python']}, "
            f"NumPy {place['numpy']}"
        )


def test_the_line_that_is_wanted_of_an_author_is_read(tmp_path, capsys):
    path = tmp_path / "mine.csv"
    path.write_text(write(make_table("cusps")))
    assert main(["cusps", str(path)]) == 0
    line, engine = re.search(
        r"a first line such as (# engine: (.+)) states", capsys.readouterr().out
    ).groups()
    path.write_text(f"{line}\n{path.read_text()}")
    assert main(["cusps", str(path)]) == 0
    assert capsys.readouterr().out.splitlines()[1] == f"engine: {engine}"


def test_what_a_file_says_of_its_engine_is_one_printable_line(tmp_path, capsys):
    path = tmp_path / "mine.csv"
    path.write_text("# engine: \x1b[31m\u0416" + "x" * 1000 + "\n" + write(make_table("cusps")))
    assert main(["cusps", str(path)]) == 0
    line = capsys.readouterr().out.splitlines()[1]
    assert line.isascii()
    assert line.isprintable()
    assert len(line) < 80


def test_scores_say_the_engine_of_each_entry(tmp_path, capsys):
    for name, engine in (
        ("old", "# engine: MuJoCo 3.12.0\n"),
        ("new", "# engine: MuJoCo 4.0.0\n"),
        ("x", ""),
    ):
        (tmp_path / "cusps").mkdir(exist_ok=True)
        (tmp_path / "cusps" / f"{name}.csv").write_text(engine + write(make_table("cusps")))
    assert main(["all", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "old, engine: MuJoCo 3.12.0" in lines
    assert "new, engine: MuJoCo 4.0.0" in lines
    assert [line for line in lines if line.startswith("x, engine: not stated")]
    assert lines[-1].startswith(f"test set {VERSION} (SHA-256: problems.json ")


def test_the_citation_names_the_set_with_its_version_and_digest(tmp_path):
    assert main(["-o", str(tmp_path)]) == 0
    listed = (ROOT / "CITATION.cff").read_text()
    _, _, entry = listed.partition('title: "A test set of heavy tops"')
    assert f'version: "{VERSION}"' in entry
    digest = hashlib.sha256((tmp_path / "SHA256SUMS").read_bytes()).hexdigest()
    assert f"sha256:{digest}" in entry


def test_a_copied_folder_may_have_other_json_files(tmp_path):
    assert main(["cusps", "-o", str(tmp_path)]) == 0
    (tmp_path / "mine.csv").write_text(write(make_table("cusps")))
    # the shell makes the file before the scorer looks for the problem
    (tmp_path / "score.json").write_text("")
    (tmp_path / "settings.json").write_text('{"step": 1e-3}')
    done = execute([sys.executable, "score.py", "cusps", "mine.csv"], cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert f"test set {VERSION} (SHA-256: cusps.json " in done.stdout
