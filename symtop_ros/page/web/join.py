"""The page as one file: its modules, the kernel, scenes, lesson and wording, joined without Node.

A page that is opened from a disk can import no module and fetch no file. So each module becomes a
function of one script, which takes what it imports from those before it.
"""

import base64
import dataclasses
import functools
import gzip
import hashlib
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from symtop_ros import __version__
from symtop_ros.physics import BODIES, Part
from symtop_ros.run.simulation.fields import TABLE
from symtop_ros.run.simulation.presets import describe_scenes, scene_names
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.words.templates import read_templates

FOLDER = Path(__file__).parent
MODULES = FOLDER.resolve() / "js"
# The page, and what its script does in a thread of its own, where there is no document.
START, WORKER = MODULES / "start.js", MODULES / "fit" / "worker.js"
LOADER = MODULES / "loader.js"
IMPORT = re.compile(r'^import \{([^}]*)\} from "(\.[./\w]*)\.js";\n', re.M)
# What the page takes of a button and of a step of the lesson, and what stands for what is left out.
ACT = {
    **dict.fromkeys(("start", "hurry", "push", "clamp", "run")),
    "hold": "spin_rate",
}
STEP = {"name": "", "scene": "cusps", "charts": (), "layers": (), "ask": None, "table": None}
PART = re.compile(r"/\*([A-Z]+)\*/")  # of page.html
EXPORT = re.compile(r"^export (const|class) (\w+)", re.M)
# Nothing is loaded from anywhere, and no script or style acts but those of the file, by hash. Data
# are no script: the hashes stay the same in a page that saves itself with a run. A page of a node
# has its server.
# A film is a file that was opened, and a thread runs the page's own script: both are blobs.
POLICY = (
    "default-src 'none'; script-src {scripts} 'wasm-unsafe-eval'; style-src {style}; "
    "img-src data: blob:; media-src blob:; worker-src blob:; font-src data:; connect-src {server}; "
    "base-uri 'none'; form-action 'none'"
)
RECORD = FOLDER / "record.json"  # a run with measured points, which workshop.lesson.example writes
LESS = ","  # in place of < in packed data
TEXTS = FOLDER / "texts"
LANGUAGES = tuple(sorted(path.stem for path in TEXTS.glob("*.json")))
TERMS = "terms"  # those of the textbooks of a language, for its translators


def write_file(
    run: Mapping[str, Any] | None = None,
    opening: str = "",
    node: str = "",
    language: str | None = None,
) -> str:
    """Return the page as one document.

    It may hold a run (run.json), open what a fragment of its address would (`lesson=1`), belong to
    a running node, given by its name, and have a fixed language instead of the browser's.
    """
    page, style = (
        (FOLDER / name).read_text(encoding="utf-8") for name in ("page.html", "page.css")
    )
    style = re.sub(r"^ *(/\* (?:(?!\*/).)*\*/\n)?", "", style, flags=re.M | re.S)
    style = style.replace("/*SYMBOLS*/", _encode((FOLDER / "symbols.woff2").read_bytes()))
    script, loader = join_page(), join_loader()
    parts = {
        "VERSION": __version__,
        "POLICY": POLICY.format(
            scripts=f"{_sign(loader)} {_sign(script)}",
            style=_sign(style),
            server="'self'" if node else "'none'",
        ),
        "STYLE": style,
        "LANGUAGE": f'lang="{language}" data-own' if language else 'lang="en"',
        "CONTENT": _write_data(
            {
                "kernel": _pack((FOLDER / "kernel.wasm").read_bytes()),
                "packed": _pack(json.dumps(collect_content(), ensure_ascii=False).encode()),
                "opening": opening,
                "node": node,
            }
        ),
        "RUN": _write_data(run),
        "PACKED": _pack(script.encode()),
        "LOADER": loader,
    }
    return PART.sub(lambda found: parts[found[1]], page)


def _sign(text: str) -> str:
    """Return the source that allows a script or a style with this text."""
    digest = hashlib.sha256(text.encode()).digest()
    return f"'sha256-{_encode(digest)}'"


def _write_data(data: Any) -> str:
    """Return data for an element of the page: no end of an element is in it."""
    return json.dumps(data).replace("<", "\\u003c")


def _pack(data: bytes) -> str:
    """Return data packed by gzip, in base 85: less than half as long.

    Five letters hold four bytes, and four of base64 three. The one letter that ends an element of a
    page is replaced by one that base 85 (RFC 1924) has not.
    """
    return base64.b85encode(gzip.compress(data, mtime=0)).decode().replace("<", LESS)


def _encode(data: bytes) -> str:
    return base64.b64encode(data).decode()


def collect_content() -> dict[str, Any]:
    """Return what the script reads: texts, scenes, fields of a run, lesson."""
    return {
        "languages": LANGUAGES,
        "texts": _list_texts(),
        "scenes": [{"name": name, **_read_values(name)} for name in scene_names()],
        "run_fields": TABLE,
        "bodies": {name: list(map(_list_part, parts)) for name, parts in BODIES.items()},
        "lesson": [_read_step(step) for step in read_steps()],
    }


def _list_texts() -> dict[str, list[str | None]]:
    """Return the texts of each key in all languages, next to each other.

    Numbers and formulas are the same in all of them, and gzip finds what is alike within 32 kB: the
    texts are then a fifth shorter.
    """
    known = [read_texts(language) for language in LANGUAGES]
    keys = dict.fromkeys(key for texts in known for key in texts)
    return {key: [texts.get(key) for texts in known] for key in keys}


def _list_part(part: Part) -> dict[str, Any]:
    """Return what the page has of a part."""
    return {name: getattr(part, name) for name in ("kind", "mass", "size", "distance")}


def _read_step(step: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields of a step that are the same in all languages."""
    return {
        "acts": [{**ACT, **_name_run(act)} for act in step["acts"]],
        **{name: step.get(name, default) for name, default in STEP.items()},
    }


def _name_run(act: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return an act; one of the record has its run."""
    return {"run": read_record(act["record"])} if "record" in act else act


def read_record(spin: float) -> dict[str, Any]:
    """Return the run of the record with so many times its spin: of a top with less Iz.

    Its axle moves in the same way, as p_psi = Iz omega_z is the same.
    """
    run: dict[str, Any] = json.loads(RECORD.read_text(encoding="utf-8"))
    (start,) = run["events"]
    start["top"][1] /= spin
    start["angular_velocity"][2] *= spin
    return run


def _read_values(name: str) -> dict[str, Any]:
    """Return the parameters of a scene; the page's kernel computes the start, as a node's does."""
    settings = Settings.from_scene(name)
    return {
        "initial": dataclasses.asdict(settings.initial),
        "top": settings.top.moments,
        "friction": dataclasses.astuple(settings.friction),
        "torque": settings.steady_torque,
        "weighed": {"mass": settings.mass, "gravity": settings.gravity},
    }


def join_page() -> str:
    """Return the script of the page, which serves fits where it runs without a document.

    What the page has besides the modules of a fit is left out there, as it asks for the document.
    """
    shared = _list_modules(WORKER)
    own = [each for each in _list_modules(START) if each not in shared]
    lines = [*map(_write_function, shared), f"if (!self.document) module_{WORKER.stem}.serve();"]
    return "\n".join(
        [*lines, "else {", *map(_write_function, own), f"module_{START.stem}.start();", "}"]
    )


def join_loader() -> str:
    """Return the script that unpacks the one of the page, which has modules of the same names."""
    modules = map(_write_function, _list_modules(LOADER))
    return "\n".join(["{", *modules, f"module_{LOADER.stem}.load();", "}"])


def _list_modules(main: Path) -> list[Path]:
    """Return a module after all that it imports."""
    ordered: list[Path] = []
    _order(main, ordered)
    return ordered


def _order(path: Path, ordered: list[Path]) -> None:
    """Add a module after those that it imports."""
    for _, imported in IMPORT.findall(path.read_text(encoding="utf-8")):
        other = (path.parent / f"{imported}.js").resolve()
        if other not in ordered:
            _order(other, ordered)
    if path not in ordered:
        ordered.append(path)


def _write_function(path: Path) -> str:
    """Return a module as a function; no two modules have the same name."""
    text = drop_comments(path.read_text(encoding="utf-8"))
    names = [found for _, found in EXPORT.findall(text)]
    text = IMPORT.sub(lambda m: f"const {{{m[1]}}} = module_{Path(m[2]).name};\n", text)
    text = EXPORT.sub(r"\1 \2", text)
    return f"const module_{path.stem} = (() => {{\n{text}return {{ {', '.join(names)} }};\n}})();"


def drop_comments(text: str) -> str:
    """Return a module without what is for its readers: comments, indentation and empty lines."""
    text = re.sub(r"/\*\*(?:(?!\*/).)*\*/ ?", "", text, flags=re.S)
    text = re.sub(r"(?<=[;,{}()\[]) // [^\n\"'`]*$", "", text, flags=re.M)
    return re.sub(r"^\s*(//[^\n]*\n\s*)*", "", text, flags=re.M)


def read_file(language: str) -> dict[str, str]:
    """Return the texts of a language that no record makes, by their keys."""
    text = (TEXTS / f"{language}.json").read_text(encoding="utf-8")
    return {key: value for key, value in json.loads(text).items() if key != TERMS}


@functools.cache
def read_texts(language: str) -> dict[str, str]:
    """Return all texts of a language; a scene that it does not know has its English story."""
    texts: dict[str, str] = {}
    for name, title, story in describe_scenes():
        texts |= {f"scene.{name}.title": title, f"scene.{name}.story": story}
    return texts | read_templates(language) | read_file(language)


def read_steps() -> list[dict[str, Any]]:
    """Return the steps of the lesson; each has its texts by their keys."""
    return list(yaml.safe_load((FOLDER / "lesson.yaml").read_text(encoding="utf-8")))
