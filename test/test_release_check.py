"""The check of a release, on a checkout whose places agree, and on those where one does not."""

import re
import subprocess

import pytest
from documents import ROOT

from workshop.release import collect, list_faults
from workshop.speed.provenance import digest_sources, write_seal
from workshop.wheels import TARGETS

VERSION = "1.2.3"
CONTENT = "| error | time |\n|---|---|\n| 1e-16 | 0.5 ms |"
# Text of each place, and what it is changed to.
CHANGES = {
    "symtop_ros/__init__.py": ('"1.2.3"', '"1.2.3.dev0"'),
    "package.xml": ("1.2.3", "1.2.2"),
    "CITATION.cff": ("version: 1.2.3", "version: 1.2.4"),
    "docs/top.html": ("1.2.3", "1.1.0"),
    "CHANGELOG.rst": ("1.2.3 (2027-01-31)\n------------------", "Forthcoming\n-----------"),
}


def git(root, *words):
    subprocess.run(["git", *words], cwd=root, check=True, capture_output=True)


def replace(path, old, new):
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def commit(root):
    git(root, "add", "--all")
    git(root, "-c", "user.name=a", "-c", "user.email=a@b.c", "commit", "-qm", "all")


@pytest.fixture(name="checkout")
def _checkout(tmp_path):
    """A checkout with the places of ours, which agree."""
    root = tmp_path / "My Größe"
    for name in ("symtop_ros", "docs", "dist", "symtop_ros/truth/testset"):
        (root / name).mkdir(parents=True)
    (root / "symtop_ros/__init__.py").write_text(f'__version__ = "{VERSION}"\n')
    manifest = (ROOT / "package.xml").read_text(encoding="utf-8")
    manifest = re.sub("<version>.*</version>", f"<version>{VERSION}</version>", manifest)
    (root / "package.xml").write_text(manifest)
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    citation = re.sub("(?m)^version: .*$", f"version: {VERSION}", citation)
    citation = re.sub("(?m)^date-released: .*$", 'date-released: "2027-01-31"', citation)
    (root / "CITATION.cff").write_text(citation, encoding="utf-8")
    page = f'<!doctype html><meta name="generator" content="symtop_ros {VERSION}">'
    (root / "docs/top.html").write_text(page)
    head = "^^^\nChangelog for package symtop_ros\n^^^\n\n"
    sections = "1.2.3 (2027-01-31)\n------------------\n\n- A change.\n\n"
    sections += "1.2.2 (2027-01-01)\n------------------\n\n- An older one.\n"
    (root / "CHANGELOG.rst").write_text(head + sections)
    (root / "README.md").write_text("# symtop_ros\n")
    end = write_seal(digest_sources("summary", root), CONTENT)
    table = f"<!-- figures: summary -->\n{CONTENT}\n\n{end}\n<!-- end of figures -->\n"
    (root / "docs/accuracy.md").write_text(table)
    (root / ".gitignore").write_text("dist\n")
    for platform in TARGETS:
        tag = re.sub(r"[-.]", "_", platform)
        (root / f"dist/symtop_ros-{VERSION}-py3-none-{tag}.whl").touch()
    git(root, "init", "-q")
    commit(root)
    return root


def test_a_checkout_whose_places_agree_may_be_released(checkout):
    assert [*list_faults(checkout)] == []


@pytest.mark.parametrize("name", CHANGES)
def test_a_place_that_disagrees_is_named(checkout, name):
    replace(checkout / name, *CHANGES[name])
    commit(checkout)
    faults = [*list_faults(checkout)]
    if name == "symtop_ros/__init__.py":  # all others disagree with it
        assert str(faults[0]) == f"{name} must have a version of three numbers, got 1.2.3.dev0"
    else:
        assert [each.place for each in faults] == [name]


def test_a_date_that_disagrees_is_named(checkout):
    replace(checkout / "CITATION.cff", "2027-01-31", "2027-01-30")
    commit(checkout)
    (fault,) = map(str, list_faults(checkout))
    assert fault == ("CITATION.cff must have the date of the changelog, 2027-01-31, got 2027-01-30")


def test_a_table_that_a_hand_changed_is_named(checkout):
    replace(checkout / "docs/accuracy.md", "0.5 ms", "0.4 ms")
    commit(checkout)
    (fault,) = map(str, list_faults(checkout))
    assert fault.startswith("docs/accuracy.md, table summary must have the text that its command")


def test_a_table_of_other_sources_is_named_with_its_command(checkout):
    (checkout / "symtop_ros/physics").mkdir()
    (checkout / "symtop_ros/physics/top.py").write_text("Ix = 1\n")
    commit(checkout)
    (fault,) = map(str, list_faults(checkout))
    assert "table summary must have figures of these sources (make -C workshop report)" in fault


def test_changes_that_are_in_no_commit_a_tag_and_missing_wheels_are_named(checkout):
    (checkout / "new.txt").touch()
    git(checkout, "tag", f"v{VERSION}")
    next((checkout / "dist").glob("*.whl")).unlink()
    assert [each.place for each in list_faults(checkout)] == ["the checkout", "git", "dist"]


@pytest.mark.slow
def test_what_is_uploaded_is_collected_with_its_sums(checkout):
    folder = collect(checkout)
    names = {path.name for path in folder.iterdir()}
    assert names >= {"CHANGES.rst", "SHA256SUMS", "symtop_ros-1.2.3.tar.gz", "top.html"}
    assert len([name for name in names if name.endswith(".whl")]) == len(TARGETS)
    assert any(name.endswith(".zip") for name in names)
    assert (folder / "CHANGES.rst").read_text() == "- A change.\n"
    done = subprocess.run(
        ["sha256sum", "--check", "--quiet", "SHA256SUMS"], cwd=folder, check=False
    )
    assert done.returncode == 0
