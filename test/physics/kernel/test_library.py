"""Where the compiled kernel is found: in a checkout, next to an installed copy, or not at all."""

import shutil
import sys
from pathlib import Path

import pytest
from documents import ROOT
from programs import execute

from symtop_ros.physics.kernel.library import FILE, load_library

TYPED = "from symtop_ros.physics import Motion, State, Top; print(Motion.__module__)"
PLACE = FILE.relative_to(ROOT)
BUILT = Path(load_library()._name)  # after colcon in another folder


@pytest.fixture(name="checkout")
def _checkout(tmp_path):
    """A checkout in which nothing was built."""
    return copy(tmp_path / "symtop ros", "setup.py")


def copy(folder, *files):
    """Copy what the library needs of the package, without the compiled kernel."""
    ignored = shutil.ignore_patterns(FILE.name, "__pycache__")
    for part in ("__init__.py", "py.typed", "base", "physics"):
        source, target = ROOT / "symtop_ros" / part, folder / "symtop_ros" / part
        if source.is_dir():
            shutil.copytree(source, target, ignore=ignored)
        else:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)
    for name in files:
        (folder / name).touch()
    return folder


def type_there(folder, *others):
    """Type the import in a folder, next to other entries of sys.path; return what is printed."""
    code = f"import sys; sys.path[1:1] = {[*map(str, others)]}; {TYPED}; Motion(Top(1, 2, 3), "
    code += "State.from_euler(theta=1))"
    # without the path of the editable installation of the tests
    done = execute([sys.executable, "-c", code], cwd=folder)
    return done.returncode, (done.stderr if done.returncode else done.stdout).splitlines()[-1]


def install(folder):
    """Copy the package with its compiled kernel."""
    copy(folder)
    shutil.copy(BUILT, folder / PLACE)
    return folder


def change(folder):
    """Change the sources of the kernel."""
    with (folder / PLACE.parent / "symtop.h").open("a") as file:
        file.write("// changed\n")


def test_a_checkout_takes_the_kernel_of_an_installed_copy_of_the_same_sources(checkout, tmp_path):
    assert type_there(checkout, install(tmp_path / "site")) == (0, "symtop_ros.physics.motion")


def test_a_copy_of_other_sources_is_named_and_not_taken(checkout, tmp_path):
    site = install(tmp_path / "site")
    change(site)
    change(checkout)
    status, line = type_there(checkout, site)
    assert status == 1
    assert line == (
        f"ImportError: no compiled kernel is in {checkout / PLACE.parent}, and the compiled kernel "
        f"{site / PLACE} was built from other sources: `pip install -e .` in {checkout} builds it"
    )


def test_where_nothing_was_built_that_is_what_is_said(checkout):
    change(checkout)  # else that of these tests would fit
    status, line = type_there(checkout, "/nowhere")
    assert status == 1
    assert line.startswith(f"ImportError: no compiled kernel is in {checkout / PLACE.parent}")
    assert line.endswith(f": `pip install -e .` in {checkout} builds it")


def test_a_kernel_of_other_sources_is_refused_in_its_own_folder(checkout):
    shutil.copy(BUILT, checkout / PLACE)
    change(checkout)
    status, line = type_there(checkout)
    assert status == 1
    assert line == (
        f"ImportError: the compiled kernel {checkout / PLACE} was built from other sources: "
        f"`pip install -e .` in {checkout} builds it"
    )


def test_an_installed_kernel_that_is_damaged_is_installed_again(tmp_path):
    site = copy(tmp_path / "site")
    (site / PLACE).write_bytes(BUILT.read_bytes()[:100])
    status, line = type_there(site)
    assert status == 1
    assert line.startswith(f"ImportError: the compiled kernel {site / PLACE} cannot be loaded (")
    assert line.endswith("): install symtop_ros again, from a checkout by `pip install -e .`")
