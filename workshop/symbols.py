"""The letters of the page's formulas: `make -C workshop symbols` writes symbols.woff2.

Few systems have a font with the places of indices and lines, and a page without a network can ask
for none. These are a hundred letters of STIX Two Math, under the SIL Open Font License. They are
kept in the package, because few have the tools; npm has the font.
"""

import subprocess
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TARGET = ROOT / "symtop_ros/page/web/symbols.woff2"
FONT = "@fontsource/stix-two-math@5.3.0"
PLACE = "package/files/stix-two-math-latin-400-normal.woff2"
LICENSE = "package/LICENSE"
# Letters of symbols, with their slanted forms, which MathML shows: theirs begin at these signs.
# Letters of functions and units are upright.
LETTERS = "EILMUJabdglptuxyz" + "\u03b1\u03b8\u03bb\u03c6\u03c8\u03c9"
SLANTED = {"A": 0x1D434, "a": 0x1D44E, "\u03b1": 0x1D6FC}
SIGNS = "0123456789.,:;?!()+\u2212=<>/\u00b7\u00d7\u2032\u2033\u02d9\u00a8\u00b2\u221a "
SPACES = "\u2009\u2061\u2062"
UPRIGHT = "cefimnoqrskNJ"
# Small letters for indices, and names: with copyright (0), license (13) and its address (14).
OPTIONS = ("--layout-features=ssty", "--name-IDs=0,1,2,3,4,5,6,13,14", "--no-hinting")


def slant(letter: str) -> str:
    """Return the slanted form of a letter."""
    first = max(each for each in SLANTED if each <= letter)
    return chr(SLANTED[first] + ord(letter) - ord(first))


def list_letters() -> str:
    """Return all letters, in their order."""
    return "".join(sorted({*LETTERS, *map(slant, LETTERS), *SIGNS, *SPACES, *UPRIGHT}))


def main() -> None:
    """Write the font of these letters, and its license."""
    from fontTools import subset  # type: ignore[import-untyped,import-not-found,unused-ignore]

    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["npm", "pack", "--silent", FONT], cwd=folder, check=True)
        (packed,) = Path(folder).glob("*.tgz")
        with tarfile.open(packed) as archive:
            archive.extractall(folder, filter="data")
        font = str(Path(folder, PLACE))
        subset.main(
            [
                font,
                f"--text={list_letters()}",
                "--flavor=woff2",
                f"--output-file={TARGET}",
                *OPTIONS,
            ]
        )
        TARGET.with_suffix(".LICENSE").write_bytes(Path(folder, LICENSE).read_bytes())
    print(f"{TARGET.relative_to(ROOT)}: {TARGET.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
