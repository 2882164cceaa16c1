import subprocess
import sys

import pytest

from symtop_ros.client.main import UsageError, parse_values


def test_words_become_numbers_lists_and_text():
    assert parse_values(["a=9", "b=-1e-3", "c=0,0,1e-4", "d=[1, 2]", "e=slow"]) == {
        "a": 9.0,
        "b": -1e-3,
        "c": [0.0, 0.0, 1e-4],
        "d": [1.0, 2.0],
        "e": "slow",
    }


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["precession_rate"], "argument must be NAME=VALUE, got 'precession_rate'"),
        (["=3"], "argument must be NAME=VALUE, got '=3'"),
        (["a=1", "a=2"], "a must be given once"),
    ],
)
def test_invalid_words_are_refused(words, sentence):
    with pytest.raises(UsageError) as error:
        parse_values(words)
    assert sentence in str(error.value)


def test_it_is_imported_where_there_are_no_terminals():
    """As on Windows: only `top_ctl keys` needs them."""
    code = "import sys; sys.modules.update(termios=None, tty=None); import symtop_ros.client.main"
    subprocess.run([sys.executable, "-c", code], check=True)
