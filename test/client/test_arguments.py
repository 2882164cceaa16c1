import pytest

from symtop_ros.client.arguments import UsageError, named_values


def test_words_become_numbers_lists_and_text():
    assert named_values(["a=9", "b=-1e-3", "c=0,0,1e-4", "d=[1, 2]", "e=slow"]) == {
        "a": 9.0,
        "b": -1e-3,
        "c": [0.0, 0.0, 1e-4],
        "d": [1.0, 2.0],
        "e": "slow",
    }


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["precession_rate"], "'precession_rate': allowed is name=value"),
        (["=3"], "'=3': allowed is name=value"),
        (["a=1", "a=2"], "a: got it more than once"),
    ],
)
def test_words_that_cannot_be_read_are_refused(words, sentence):
    with pytest.raises(UsageError) as error:
        named_values(words)
    assert sentence in str(error.value)
