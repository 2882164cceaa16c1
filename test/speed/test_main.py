import dataclasses
import sys
from pathlib import Path

import pytest
from programs import execute

from workshop import main as report
from workshop.article import maps, retell
from workshop.lesson import pictures as lesson
from workshop.speed import benchmarks, filters, measure, testset

LONGER = dataclasses.replace(benchmarks.QUICK, limit=9.0)
DOCS = Path("docs")
ROOT = Path(__file__).parents[2]
COMMAND = "make -C workshop report"
PARTS = {
    "speed": (measure, "measure", "report", benchmarks.QUICK, COMMAND, None),
    "speed --full": (
        measure,
        "measure",
        "report",
        benchmarks.FULL,
        f"{COMMAND} ARGS=--full",
    ),
    "speed --docs docs": (*(measure, "measure", "report", benchmarks.QUICK, COMMAND, DOCS),),
    "speed --limit 9": (measure, "measure", "report", LONGER, "python -m workshop speed --limit 9"),
    "testset": (testset, "score_testset", "report", None, 0.2),
    "testset here --limit 9 --docs docs": (testset, "score_testset", "here", DOCS, 9.0),
    "filters --docs docs": (filters, "judge_filters", "report", DOCS),
    "article": (retell, "retell", "report"),
    "lesson there": (lesson, "write_lesson", "there", False),
    "lesson --sheets": (lesson, "write_lesson", "report", True),
    "maps": (maps, "write_maps", "report", 1000),
    "maps here --points 9": (maps, "write_maps", "here", 9),
}


@pytest.mark.parametrize("words", PARTS)
def test_a_command_chooses_the_part_that_runs(words, monkeypatch):
    module, name, folder, *rest = PARTS[words]
    called = []
    monkeypatch.setattr(module, name, lambda *arguments: called.append(arguments) or 0)
    assert report.main(words.split()) == 0
    ((first, *others),) = called
    assert str(first) == folder
    assert others[: len(rest)] == rest


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["maps", "--points", "1"], "--points: must be 2 to 4000, got 1"),
        (["maps", "--points", "4001"], "--points: must be 2 to 4000, got 4001"),
        (["maps", "--points", "many"], "--points: must be 2 to 4000, got many"),
        (["maps", "--points", "9" * 5000], "--points: must be 2 to 4000, got 999"),
        (["speed", "--limit", "0"], "--limit: must be above 0 and at most 3600 s, got 0"),
        (["speed", "--limit", "nan"], "--limit: must be above 0 and at most 3600 s, got nan"),
        (["testset", "--limit", "long"], "--limit: must be above 0 and at most 3600 s, got long"),
        (["filters", "--docs", "nowhere"], "must be a folder next to a README.md, got nowhere"),
        (["article", "--full"], "unrecognized arguments: --full"),
        ([], "the following arguments are required: COMMAND"),
    ],
)
def test_a_wrong_option_is_refused_as_usage(words, message, capsys):
    with pytest.raises(SystemExit) as stopped:
        report.main(words)
    assert stopped.value.code == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("module", "command", "extra"),
    [
        ("matplotlib", "article", "report"),
        ("rerun", "maps", "playback"),
        ("tqdm", "speed", "report"),
    ],
)
def test_a_missing_package_is_named_with_the_extra_that_brings_it(module, command, extra, tmp_path):
    hidden = f"import sys; sys.path.insert(0, {str(ROOT)!r}); sys.modules[{module!r}] = None; "
    program = "from symtop_ros.programs import run; sys.exit(run('workshop', 'workshop.main'))"
    result = execute([sys.executable, "-c", hidden + program, command], cwd=tmp_path)
    assert result.returncode == 1
    remedy = f"pip install '.[{extra}]' in the checkout"
    assert result.stderr == f"workshop: {module} is missing: {remedy}\n"
    assert list(tmp_path.iterdir()) == []
