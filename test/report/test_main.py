import subprocess
import sys

import pytest

from symtop_ros.report import main as report
from symtop_ros.report.article import main as article
from symtop_ros.report.perry import main as perry
from symtop_ros.report.precision import chapters
from symtop_ros.report.precision import main as precision

ONE_EACH = {
    "--full": (precision, "measure", "report", chapters.FULL),
    "--article": (article, "retell", "report"),
    "--map": (perry, "chart", "report", 1000),
}


@pytest.mark.parametrize("option", ONE_EACH)
def test_an_option_chooses_what_is_done(option, monkeypatch):
    module, name, folder, *rest = ONE_EACH[option]
    called = []
    monkeypatch.setattr(module, name, lambda *arguments: called.append(arguments) or 0)
    assert report.main([option]) == 0
    assert str(called[0][0]) == folder
    assert list(called[0][1 : 1 + len(rest)]) == rest


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--map", "--points", "1"], "--points: got 1, allowed is 2 ... 4000"),
        (["--map", "--points", "many"], "--points: got many, allowed is 2 ... 4000"),
        (["--node", "--seconds", "0"], "--seconds: got 0, allowed is more than 0, up to 1e+06"),
        (["--node", "--seconds", "nan"], "--seconds: got nan, allowed is more than 0"),
        (["--node", "--map"], "not allowed with argument"),
    ],
)
def test_a_wrong_option_is_refused_as_usage(words, told, capsys):
    with pytest.raises(SystemExit) as stopped:
        report.main(words)
    assert stopped.value.code == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(
    ("module", "option"), [("matplotlib", "--article"), ("rerun", "--map"), ("tqdm", "--full")]
)
def test_what_is_missing_is_named_with_the_extra_that_brings_it(module, option, tmp_path):
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
