"""The design notes name each experiment with its command."""

from documents import ROOT

NOTES = (ROOT / "design/README.md").read_text(encoding="utf-8")


def test_each_experiment_is_named_with_its_command():
    names = [path.stem for path in (ROOT / "design").glob("[a-z]*.py")]
    assert len(names) >= 6
    assert [name for name in names if f"`python -m design.{name}`" not in NOTES] == []
