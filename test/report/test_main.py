import dataclasses
import subprocess
import sys
from pathlib import Path

import pytest

from symtop_ros.article import maps, retell
from symtop_ros.report import benchmarks, measure
from symtop_ros.report import main as report

PARTS = {
    (): (measure, "measure", "report", benchmarks.QUICK),
    ("--full",): (measure, "measure", "report", benchmarks.FULL),
    ("--docs", "docs"): (
        measure,
        "measure",
        "report",
        benchmarks.QUICK,
        "top_report",
        Path("docs"),
    ),
    ("--limit", "9"): (
        *(measure, "measure", "report"),
        *(dataclasses.replace(benchmarks.QUICK, limit=9.0), "top_report --limit 9"),
    ),
    ("--article",): (retell, "retell", "report"),
    ("--map",): (maps, "write_maps", "report", 1000),
    ("here", "--map", "--points", "9"): (maps, "write_maps", "here", 9),
}


@pytest.mark.parametrize("words", PARTS, ids=" ".join)
def test_an_option_chooses_the_part_that_runs(words, monkeypatch):
    module, name, folder, *rest = PARTS[words]
    called = []
    monkeypatch.setattr(module, name, lambda *arguments: called.append(arguments) or 0)
    assert report.main(list(words)) == 0
    ((first, *others),) = called
    assert str(first) == folder
    assert others[: len(rest)] == rest


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--map", "--points", "1"], "--points: must be 2 to 4000, got 1"),
        (["--map", "--points", "4001"], "--points: must be 2 to 4000, got 4001"),
        (["--map", "--points", "many"], "--points: must be 2 to 4000, got many"),
        (["--map", "--points", "9" * 5000], "--points: must be 2 to 4000, got 999"),
        (["--limit", "0"], "--limit: must be above 0 and at most 3600 s, got 0"),
        (["--limit", "nan"], "--limit: must be above 0 and at most 3600 s, got nan"),
        (["--limit", "long"], "--limit: must be above 0 and at most 3600 s, got long"),
        (["--docs", "nowhere"], "--docs: must be a folder next to a README.md, got nowhere"),
        (["--article", "--map"], "not allowed with argument"),
    ],
)
def test_a_wrong_option_is_refused_as_usage(words, message, capsys):
    with pytest.raises(SystemExit) as stopped:
        report.main(words)
    assert stopped.value.code == 2
    assert message in capsys.readouterr().err


def test_an_interrupt_is_status_130(monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(retell, "retell", interrupt)
    assert report.main(["--article"]) == 130


@pytest.mark.parametrize(
    ("module", "option"), [("matplotlib", "--article"), ("rerun", "--map"), ("tqdm", "--full")]
)
def test_a_missing_package_is_named_with_the_extra_that_brings_it(module, option, tmp_path):
    hidden = f"import sys; sys.modules[{module!r}] = None; "
    program = f"from symtop_ros.report.main import main; sys.exit(main([{option!r}]))"
    result = subprocess.run(
        [sys.executable, "-c", hidden + program],
        cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert result.returncode == 1
    (line,) = result.stderr.splitlines()
    assert line.startswith("top_report: needs the extra `report`: pip install '.[report]'")
    assert module in line
    assert list(tmp_path.iterdir()) == []
