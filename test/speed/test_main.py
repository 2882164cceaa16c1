import sys
from pathlib import Path

import pytest
from programs import execute

from workshop import main as report

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["maps", "--points", "1"], "--points: must be 2 to 4000, got 1"),
        (["speed", "--limit", "nan"], "--limit: must be above 0 and at most 3600 s, got nan"),
        (["filters", "--docs", "nowhere"], "must be a folder next to a README.md, got nowhere"),
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
