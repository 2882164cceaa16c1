"""The documents name files that exist, and the scenes by what their files say."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
PATH = re.compile(r"(?<![\w/])((?:test|symtop_ros|config|docs)/[\w./]+\.(?:py|yaml|xml|md|json))")


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_and_paths_in_a_document_lead_to_files(document):
    text = document.read_text(encoding="utf-8")
    links = {link for link in LINK.findall(text) if not link.startswith("http")}
    missing = {link for link in links if not (document.parent / link).exists()}
    assert missing | {path for path in PATH.findall(text) if not (ROOT / path).exists()} == set()


def test_the_documents_are_found():
    names = {path.name for path in DOCUMENTS}
    assert {"README.md", "CHANGELOG.md", "architecture.md", "reliability.md"} <= names


@pytest.mark.parametrize("scene", sorted(ROOT.glob("config/*.yaml")), ids=lambda path: path.stem)
def test_a_scene_is_described_as_in_its_file(scene):
    comments = [line[2:] for line in scene.read_text().splitlines() if line.startswith("# ")]
    row = f"| `{scene.stem}` | {' '.join(comments)} |"
    assert row in (ROOT / "docs/ros.md").read_text()
