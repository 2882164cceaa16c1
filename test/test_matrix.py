import pytest

from workshop import matrix


def test_there_are_cells_for_each_distribution_that_can_be_installed():
    text = (matrix.ROOT / "setup.py").read_text()
    assert {cell.distribution for cell in matrix.cells()} == set(matrix.DISTRIBUTIONS)
    assert all(f'"{name}": {name.upper()}' in text for name in matrix.DISTRIBUTIONS)
    assert matrix.Cell("jazzy", "3.12", "1") in matrix.cells()  # Ubuntu 24.04 with apt


@pytest.mark.parametrize(
    ("result", "good"),
    [
        ("50 passed, 1 deselected", True),
        ("not tried: no such Python on this machine", True),
        ("1 failed, 49 passed", False),
        ("49 passed, 1 error", False),
        ("cannot be installed: nothing", False),
    ],
)
def test_a_cell_is_good_if_all_its_tests_passed(result, good):
    assert matrix.is_good(matrix.row(next(matrix.cells()), {}, result)) == good


def test_a_python_that_is_not_there_is_reported(tmp_path, monkeypatch):
    monkeypatch.setattr(matrix, "find_python", lambda _: None)
    line = matrix.try_cell(matrix.Cell("kilted", "3.14", "2"), tmp_path)
    assert line == "| Kilted | 3.14 | 2 |  |  | not tried: no such Python on this machine |"


def test_the_files_of_a_cell_exist():
    assert all((matrix.ROOT / each).is_file() for each in matrix.TESTS)
