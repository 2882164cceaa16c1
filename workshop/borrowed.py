"""Files of other projects for the page: `make -C workshop borrowed` fetches them from npm.

They are kept in the package, because a page needs no network, and few have the tools. Few systems
have a font with the places of indices and lines: 94 letters of STIX Two Math, under the SIL Open
Font License, are in symbols.woff2. The code of a link is drawn by lean-qr, under the MIT License.
"""

import subprocess
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
WEB = ROOT / "symtop_ros/page/web"
SYMBOLS, CODE = WEB / "symbols.woff2", WEB / "js/controls/lean_qr.js"
FONT = "@fontsource/stix-two-math@5.3.0"
DRAWING = "lean-qr@2.7.4"
TYPE = "(text: string) => {toCanvas(canvas: HTMLCanvasElement): void}"
# Letters of symbols, with their slanted forms, which MathML shows: theirs begin at these
# signs. Letters of functions and units are upright.
LETTERS = "EILMUJabdglptuxyz" + "\u03b1\u03b8\u03bb\u03c6\u03c8\u03c9"
SLANTED = {"A": 0x1D434, "a": 0x1D44E, "\u03b1": 0x1D6FC}
SIGNS = "0123456789.,:;?!()+\u2212=<>/\u00b7\u00d7\u2032\u2033\u02d9\u00a8\u00b2\u221a "
SPACES = "\u2009\u2061\u2062"
UPRIGHT = "cefimnoqrskNJ"
# Small letters of indices, and names: with copyright (0), license (13) and its address (14).
OPTIONS = ("--layout-features=ssty", "--name-IDs=0,1,2,3,4,5,6,13,14", "--no-hinting")


def slant(letter: str) -> str:
    """Return the slanted form of a letter."""
    first = max(each for each in SLANTED if each <= letter)
    return chr(SLANTED[first] + ord(letter) - ord(first))


def list_letters() -> str:
    """Return all letters of the font, in their order."""
    return "".join(sorted({*LETTERS, *map(slant, LETTERS), *SIGNS, *SPACES, *UPRIGHT}))


def fetch(package: str, folder: str) -> Path:
    """Return the unpacked files of a package of npm."""
    target = Path(folder, package.partition("@")[0] or "font")
    target.mkdir()
    subprocess.run(["npm", "pack", "--silent", package], cwd=target, check=True)
    (packed,) = target.glob("*.tgz")
    with tarfile.open(packed) as archive:
        archive.extractall(target, filter="data")
    return target / "package"


def write_symbols(files: Path) -> None:
    """Write the font of the letters, and its license."""
    from fontTools import subset  # type: ignore[import-untyped,import-not-found,unused-ignore]

    font = str(files / "files/stix-two-math-latin-400-normal.woff2")
    text = f"--text={list_letters()}"
    subset.main([font, text, "--flavor=woff2", f"--output-file={SYMBOLS}", *OPTIONS])
    SYMBOLS.with_suffix(".LICENSE").write_bytes((files / "LICENSE").read_bytes())


def write_code(files: Path) -> None:
    """Write the module of lean-qr, with its license: a copy of the page is a copy of both."""
    module, _, exports = (files / "nano.mjs").read_text().partition("export{")
    names = dict(each.split(" as ") for each in exports.strip("};\n").split(","))
    (drawing,) = [own for own, name in names.items() if name == "generate"]
    notice = (files / "LICENSE").read_text().strip()
    text = f"// @ts-nocheck\n/*! {DRAWING}\n{notice}\n*/\n{module.strip()}\n"
    CODE.write_text(f"{text}/** @type {{{TYPE}}} */\nexport const generate = {drawing};\n")


def main() -> None:
    """Fetch the packages, and write the files."""
    with tempfile.TemporaryDirectory() as folder:
        write_symbols(fetch(FONT, folder))
        write_code(fetch(DRAWING, folder))
    for path in (SYMBOLS, CODE):
        print(f"{path.relative_to(ROOT)}: {path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
