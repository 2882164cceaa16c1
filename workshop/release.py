"""Check that a release is possible, name its tag, and collect what is uploaded.

    make -C workshop release

Version, changelog, package.xml, CITATION.cff, the tables of the documentation and docs/top.html
have to agree, and the checkout has to be that of its commit. All that does not is listed, a line
each. Otherwise `dist/release/` gets the wheels of `make wheels`, the sources, the kernel for C and
C++, the page, the section of the changelog and SHA256SUMS; nothing is tagged or sent.
"""

import hashlib
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from workshop.drop_in.write import write as write_drop_in
from workshop.speed.provenance import TABLES, digest_sources, find_pages, list_tables
from workshop.wheels import TARGETS

ROOT = Path(__file__).resolve().parents[1]
NUMBER = re.compile(r"\d+\.\d+\.\d+")
# Where the version stands besides symtop_ros/__init__.py, as one number in a line.
PLACES = {
    "package.xml": re.compile(r"<version>(.+?)</version>"),
    "CITATION.cff": re.compile(r"^version: (.+)$", re.MULTILINE),
    "docs/top.html": re.compile(r'<meta name="generator" content="symtop_ros ([^"]+)">'),
}
VERSION = re.compile(r'^__version__ = "(.+)"$', re.MULTILINE)
DATE = re.compile(r'^date-released: "(.+)"$', re.MULTILINE)
TITLE = r"^(Forthcoming|\d+\.\d+\.\d+ \(([\d-]+)\))\n-+\n"
SECTION = re.compile(rf"{TITLE}(.*?)(?={TITLE}|\Z)", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Fault:
    """A place that does not agree, and what it must have."""

    place: str
    wanted: str
    got: str

    def __str__(self) -> str:
        """Return it as a refusal."""
        return f"{self.place} must have {self.wanted}, got {self.got}"


def read_version(root: Path) -> str:
    """Return the version of the package in a checkout."""
    return _find(VERSION, root / "symtop_ros/__init__.py")


def list_faults(root: Path) -> Iterator[Fault]:
    """Yield what keeps a checkout from being released."""
    version = read_version(root)
    if not NUMBER.fullmatch(version):
        yield Fault("symtop_ros/__init__.py", "a version of three numbers", version)
    for place, pattern in PLACES.items():
        if (found := _find(pattern, root / place)) != version:
            yield Fault(place, f"the version {version}", found or "none")
    yield from _check_changelog(root, version)
    yield from _check_tables(root)
    yield from _check_commit(root, version)
    wheels = find_wheels(root, version)
    if len(wheels) != len(TARGETS):
        yield Fault("dist", f"{len(TARGETS)} wheels of {version} (make wheels)", str(len(wheels)))


def _check_changelog(root: Path, version: str) -> Iterator[Fault]:
    """Yield what is wrong with the newest section of the changelog, or the date of the citation."""
    title, date, _ = read_changelog(root)
    if title.partition(" ")[0] != version:
        yield Fault("CHANGELOG.rst", f"the section {version} (DATE) first", title or "none")
    elif (cited := _find(DATE, root / "CITATION.cff")) != date:
        yield Fault("CITATION.cff", f"the date of the changelog, {date}", cited or "none")


def _check_tables(root: Path) -> Iterator[Fault]:
    """Yield tables that were changed by hand, or measured with other sources."""
    for table in list_tables(find_pages(root / "docs")):
        place = f"{table.page.relative_to(root)}, table {table.name}"
        if not table.is_whole:
            yield Fault(place, "the text that its command wrote", "another one")
        elif table.sources != digest_sources(table.name, root):
            command = f"make -C workshop {TABLES[table.name][0]}"
            yield Fault(place, f"figures of these sources ({command})", "those of others")


def _check_commit(root: Path, version: str) -> Iterator[Fault]:
    """Yield files that are not those of a commit, and a tag that is there."""
    if changed := _git(root, "status", "--porcelain"):
        yield Fault("the checkout", "no change since its commit", changed.splitlines()[0].strip())
    if _git(root, "tag", "--list", f"v{version}"):
        yield Fault("git", f"no tag v{version} yet", "one")


def read_changelog(root: Path) -> tuple[str, str, str]:
    """Return title, date and text of the newest section."""
    found = SECTION.search((root / "CHANGELOG.rst").read_text(encoding="utf-8"))
    return (found[1], found[2] or "", found[3].strip()) if found else ("", "", "")


def collect(root: Path) -> Path:
    """Write what is uploaded into a folder, and return it."""
    version, folder = read_version(root), root / "dist/release"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for wheel in find_wheels(root, version):
        shutil.copy(wheel, folder)
    sources = f"symtop_ros-{version}"
    to = ("-o", str(folder / f"{sources}.tar.gz"))
    _git(root, "archive", "--format=tar.gz", f"--prefix={sources}/", *to, "HEAD")
    drop_in = write_drop_in(root / "dist")
    shutil.make_archive(str(folder / drop_in.name), "zip", drop_in.parent, drop_in.name)
    shutil.copy(root / "docs/top.html", folder)
    (folder / "CHANGES.rst").write_text(read_changelog(root)[2] + "\n", encoding="utf-8")
    sums = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n"
        for path in sorted(folder.iterdir())
    ]
    (folder / "SHA256SUMS").write_text("".join(sums), encoding="utf-8")
    return folder


def find_wheels(root: Path, version: str) -> list[Path]:
    """Return the wheels of all platforms; those of another version are passed over."""
    return sorted((root / "dist").glob(f"symtop_ros-{version}-py3-none-*.whl"))


def main() -> int:
    """Check, then collect; return 0, or 1 if the release is refused."""
    faults = [*list_faults(ROOT)]
    for fault in faults:
        print(f"release: {fault}", file=sys.stderr)
    if faults:
        return 1
    folder = collect(ROOT)
    print(f"tag: v{read_version(ROOT)}")
    print(f"to upload, from {folder.relative_to(ROOT)}:")
    print("\n".join(f"  {path.name}" for path in sorted(folder.iterdir())))
    return 0


def _find(pattern: re.Pattern[str], path: Path) -> str:
    found = pattern.search(path.read_text(encoding="utf-8"))
    return found[1] if found else ""


def _git(root: Path, *words: str) -> str:
    done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True, check=True)
    return done.stdout


if __name__ == "__main__":
    sys.exit(main())
