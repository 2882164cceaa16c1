"""Read a PDF that Chromium has printed: letters of each page with their places, and pictures."""

import re
import zlib
from typing import NamedTuple

import numpy as np

OBJECT = re.compile(rb"(\d+) 0 obj\s(.*?)\sendobj", re.DOTALL)
REFERENCE = rb"/%s (\d+) 0 R"
TOKEN = re.compile(r"<[0-9A-Fa-f]*>|/\w+|[-+.\d]+|[\w*']+")
PAIR = re.compile(r"<(\w+)>\s*<(\w+)>")
RANGE = re.compile(r"<(\w+)>\s*<(\w+)>\s*<(\w+)>")
SECTION = re.compile(r"beginbf(char|range)(.*?)endbf", re.DOTALL)
CORNERS = np.array([[0, 0, 1], [1, 1, 1]])


class Letters(NamedTuple):
    """Letters that are written together, with the place of their first one in points."""

    text: str
    x: float
    y: float


class Page(NamedTuple):
    """A page: its size in points, its letters in order, and the boxes of its pictures."""

    size: tuple[float, float]
    letters: list[Letters]
    pictures: list[np.ndarray]

    @property
    def text(self) -> str:
        """All letters, without the spaces."""
        return squeeze("".join(each.text for each in self.letters))


def squeeze(text: str) -> str:
    """Return a text without spaces, of any kind."""
    return re.sub(r"\s", "", text)


def read_pages(data: bytes) -> list[Page]:
    """Read all pages of a PDF."""
    objects = {int(found[1]): found[2] for found in OBJECT.finditer(data)}
    pages = [each for each in objects.values() if re.search(rb"/Type\s*/Page\b", each)]
    return [_read_page(page, objects) for page in pages]


def _read_page(page: bytes, objects: dict[int, bytes]) -> Page:
    box = [float(each) for each in _find(rb"/MediaBox \[([^\]]*)\]", page).split()]
    content = _unpack(objects[int(_find(REFERENCE % b"Contents", page))])
    fonts = {
        name.decode(): _read_letters(objects[int(number)], objects)
        for name, number in re.findall(rb"/(F\d+) (\d+) 0 R", page)
    }
    drawing = Drawing(fonts)
    drawing.follow(content)
    return Page((box[2], box[3]), drawing.letters, drawing.pictures)


def _find(pattern: bytes, text: bytes) -> bytes:
    found = re.search(pattern, text)
    assert found, pattern
    return found[1]


def _unpack(stream: bytes) -> str:
    body = stream.split(b"stream\n", 1)[1].rsplit(b"\nendstream", 1)[0]
    return zlib.decompress(body).decode("latin-1")


def _read_letters(font: bytes, objects: dict[int, bytes]) -> dict[int, str]:
    """Return the letters of the signs of a font."""
    found = re.search(REFERENCE % b"ToUnicode", font)
    if not found:
        return {}
    letters: dict[int, str] = {}
    for kind, body in SECTION.findall(_unpack(objects[int(found[1])])):
        if kind == "char":
            letters |= {int(a, 16): _decode(b) for a, b in PAIR.findall(body)}
            continue
        for low, high, first in RANGE.findall(body):
            start = int(low, 16)
            signs = range(start, int(high, 16) + 1)
            *before, last = _decode(first)
            letters |= {k: "".join(before) + chr(ord(last) + k - start) for k in signs}
    return letters


def _decode(text: str) -> str:
    return bytes.fromhex(text).decode("utf-16-be")


class Drawing:
    """The drawing of a page: its matrices and what is cut away, letters and pictures."""

    def __init__(self, fonts: dict[str, dict[int, str]]) -> None:
        self.fonts, self.font = fonts, {}
        self.letters: list[Letters] = []
        self.pictures: list[np.ndarray] = []
        self.now, self.line, self.box = np.eye(3), np.eye(3), np.eye(3)
        self.seen = np.array([[-np.inf, -np.inf], [np.inf, np.inf]])  # corners
        self.kept: list[tuple[np.ndarray, np.ndarray]] = []
        self.acts = {
            "q": lambda _: self.kept.append((self.now, self.seen)),
            "Q": lambda _: self._restore(),
            "W": lambda _: self._cut(),
            "W*": lambda _: self._cut(),
            "cm": lambda given: self._set("now", _make_matrix(given[-6:]) @ self.now),
            "re": self._take_box,
            "Tm": lambda given: self._set("line", _make_matrix(given[-6:])),
            "Td": lambda given: self._set("line", _move(given[-2:]) @ self.line),
            "Tf": lambda given: self._set("font", self.fonts[given[-2][1:]]),
            "Tj": self._write,
            "Do": lambda _: self.pictures.append((CORNERS @ self.now)[:, :2]),
        }

    def follow(self, content: str) -> None:
        given: list[str] = []
        for token in TOKEN.findall(content):
            if not token[0].isalpha():
                given.append(token)
                continue
            if token in self.acts:
                self.acts[token](given)
            given = []

    def _set(self, name: str, value: object) -> None:
        setattr(self, name, value)

    def _restore(self) -> None:
        self.now, self.seen = self.kept.pop()

    def _take_box(self, given: list[str]) -> None:
        x, y, width, height = given[-4:]
        self.box = _make_matrix([width, "0", "0", height, x, y]) @ self.now

    def _cut(self) -> None:
        """Show nothing outside of the last box from now on."""
        low, high = np.sort((CORNERS @ self.box)[:, :2], axis=0)
        self.seen = np.stack([np.maximum(self.seen[0], low), np.minimum(self.seen[1], high)])

    def _write(self, given: list[str]) -> None:
        place = (self.line @ self.now)[2, :2]
        if np.all(self.seen[0] <= place) and np.all(place <= self.seen[1]):
            signs = [int(each, 16) for each in re.findall("....", given[-1][1:-1])]
            text = "".join(self.font.get(each, "?") for each in signs)
            self.letters.append(Letters(text, *place))


def _move(numbers: list[str]) -> np.ndarray:
    return _make_matrix(["1", "0", "0", "1", *numbers])


def _make_matrix(numbers: list[str]) -> np.ndarray:
    a, b, c, d, e, f = map(float, numbers)
    return np.array([[a, b, 0], [c, d, 0], [e, f, 1]])
