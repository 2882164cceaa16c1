"""Public is what is documented: one list of modules and names, in three places.

The quality declaration has the modules, docs/site/api.md the names, and `__all__` of each module
has the same names. Documents import nothing else.
"""

import ast
import importlib
import re
from collections import defaultdict

import pytest
from documents import PAGES, ROOT, blocks
from types_of_examples import list_examples, write_page

API = (ROOT / "docs/site/api.md").read_text()
DECLARED = (ROOT / "QUALITY_DECLARATION.md").read_text().partition("## Public API")[2]
MODULES = re.findall(r"^- `(symtop_ros[\w.]+)`$", DECLARED.partition("\n## ")[0], re.M)


def list_described():
    """Names that the reference describes, by their modules."""
    found = defaultdict(set)
    for path in re.findall(r"auto(?:class|function|data):: (\S+)|^`(symtop_ros\S+)`", API, re.M):
        module, _, name = "".join(path).rpartition(".")
        found[module].add(name)
    return found


@pytest.mark.parametrize("name", MODULES)
def test_the_reference_describes_what_a_module_exports(name):
    assert list_described()[name] == set(importlib.import_module(name).__all__)


def test_the_reference_describes_the_modules_that_are_declared_public():
    assert set(list_described()) == set(MODULES)


def list_imports(code):
    """Yield what Python code imports of the package: modules with a name."""
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.ImportFrom) and node.module.startswith("symtop_ros"):
            yield from ((node.module, each.name) for each in node.names)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_documents_import_public_names_alone(page):
    for code, _ in [*blocks(page, "python"), *blocks(page, "py")]:
        for module, name in list_imports(code):
            is_module = f"{module}.{name}" in MODULES
            assert is_module or name in importlib.import_module(module).__all__, (module, name)
            assert module in MODULES


@pytest.mark.parametrize("name", MODULES)
def test_the_types_of_each_public_name_are_asserted(name):
    tree = ast.parse((ROOT / "test/public_types.py").read_text())
    nodes = [node for node in ast.walk(tree) if isinstance(node, ast.Attribute)]
    called = "p" if name == "symtop_ros.physics" else name.rpartition(".")[2]
    seen = {node.attr for node in nodes if ast.unparse(node.value) == called}
    assert seen == set(importlib.import_module(name).__all__)


def test_examples_stand_at_their_lines_when_types_are_checked():
    page = ROOT / "docs/library.md"
    shown = page.read_text().splitlines()
    lines = write_page(page).splitlines()
    assert [shown[n] for n, line in enumerate(lines) if line] == [*filter(None, lines)]
    assert "motion = Motion(top, start)" in lines
    path = ROOT / "symtop_ros/physics/potential.py"
    shown = path.read_text().splitlines()
    for _, code in list_examples(path):
        for n, line in enumerate(code.splitlines()):
            assert shown[n].endswith(line)
