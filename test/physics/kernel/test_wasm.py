"""The kernel in a browser: the bits of Python, from a module that was built from these sources."""

import base64
import subprocess
from pathlib import Path

import numpy as np
import pytest
from browser import running_browser
from physics.kernel.motions import NAMES, list_many, normalize
from physics.kernel.test_c_interface import HOSTILE_SEEDS, LIBRARY, build, run_hostile

from workshop.kernel_wasm import DIGEST, FUNCTIONS, MODULE, SOURCES, digest_sources

ROOT = Path(__file__).parents[3]
ZIG = ROOT / ".venv/zig/bin/python"
SCRIPT = Path(__file__).with_name("print_motions.js").read_text()
# Two modules of the page, as one script.
RECORDS, BINDING = (
    (ROOT / f"symtop_ros/page/web/js/physics/{name}.js").read_text()
    for name in ("records", "kernel")
)
LINES = [line for line in BINDING.splitlines() if not line.startswith("import ")]
KERNEL = "\n".join([RECORDS, *LINES, "window.binding = { Kernel, pack };"])


@pytest.fixture(scope="module")
def page():
    with running_browser() as browser:
        tab = browser.new_page()
        tab.add_script_tag(content=KERNEL, type="module")
        tab.wait_for_function("Boolean(window.binding)")
        tab.add_script_tag(content=SCRIPT)
        load = "async (module) => { window.kernel = await binding.Kernel.load(decode(module)); }"
        tab.evaluate(load, to_text(MODULE.read_bytes()))
        yield tab


def to_text(data):
    return base64.b64encode(data).decode()


def compare(page, samples, expected):
    arguments = [NAMES, to_text(MODULE.read_bytes()), to_text(samples)]
    result = page.evaluate(
        "([names, module, samples]) => print_motions(binding, names, module, samples)", arguments
    )
    assert normalize(np.frombuffer(base64.b64decode(result))) == expected


def test_the_module_was_built_from_these_sources():
    # If this fails: `make kernel-wasm`, and commit both files.
    assert DIGEST.read_text().strip() == digest_sources()


def test_the_module_has_every_function_of_the_header():
    header = (SOURCES / "symtop.h").read_text()
    for name in FUNCTIONS:
        assert f"symtop_{name}(" in header
        assert f"symtop_{name}".encode() in MODULE.read_bytes()
    assert header.count("\nSYMTOP_API ") == len(FUNCTIONS)


@pytest.mark.slow
def test_two_thousand_motions_have_the_bits_of_python(page):
    compare(page, *list_many())


def test_a_start_that_is_refused_says_why(page):
    say = """(start) => { try { kernel.motion(start); return ""; } catch (error) {
        return `${error.name}: ${error.message}`; } }"""
    start = {"Ix": 1, "Iz": 3, "Mgl": 1, "orientation": [1, 0, 0, 0], "angular_velocity": [0, 0, 1]}
    assert page.evaluate(say, start) == (
        "RangeError: Ix, Iz and Mgl must be finite, 1e-100 to 1e100 in size, with Iz > 0 and at "
        "most 2 Ix"
    )
    assert "must have 4, 3, 2 and 3" in page.evaluate(say, start | {"orientation": [1, 0, 0]})


def test_an_integration_goes_on_where_it_was_left(page):
    reached = page.evaluate("""() => {
        const top = {Ix: 0.000228, Iz: 0.0000572, Mgl: 0.068};
        const start = {orientation: [0.8, 0.6, 0, 0], angular_velocity: [0, 0, 200]};
        const motion = kernel.motion({...top, ...start, friction: [2e-6, 0]});
        return [motion.reach(1, 3), motion.reach(1, 3), motion.reach(1, Infinity)];
    }""")
    assert 0 < reached[0] < reached[1] < reached[2] == 1.0


HOSTILE = """async (module) => {
    const { instance } = await WebAssembly.instantiate(decode(module), {});
    instance.exports._initialize();
    window.hostile = instance.exports;
}"""
RUN_HOSTILE = """(seeds) => [
    hostile.run(1, seeds), (hostile.digest() >>> 0).toString(16).padStart(8, "0"),
    hostile.count_calls()
]"""


@pytest.mark.long
@pytest.mark.skipif(not ZIG.exists(), reason="make kernel-wasm fetches the compiler")
def test_a_million_hostile_calls_are_answered_as_on_this_processor(page, tmp_path):
    options = ["-target", "wasm32-wasi", "-Os", "-ffp-contract=off", "-Wno-psabi"]
    source = Path(__file__).with_name("hostile.c")
    program, module = tmp_path / "hostile.o", tmp_path / "hostile.wasm"
    zig = (ZIG, "-m", "ziglang")
    include = ("-I", SOURCES)
    subprocess.run([*zig, "cc", *options, *include, "-c", source, "-o", program], check=True)
    library = ["-mexec-model=reactor", "-std=c++17", "-fno-exceptions", "-fno-rtti"]
    names = ("run", "digest", "count_calls")
    exports = [f"-Wl,--export={name}" for name in names]
    sources = SOURCES / "symtop.cpp", program
    subprocess.run([*zig, "c++", *options, *library, *exports, *sources, "-o", module], check=True)
    page.evaluate(HOSTILE, to_text(module.read_bytes()))
    fault, digest, calls = page.evaluate(RUN_HOSTILE, HOSTILE_SEEDS)
    assert (fault, calls > 1_000_000) == (0, True)
    native = build("hostile.c", tmp_path, LIBRARY)
    assert run_hostile(native, HOSTILE_SEEDS) == (digest, calls)


@pytest.mark.long
@pytest.mark.skipif(not ZIG.exists(), reason="make kernel-wasm fetches the compiler")
def test_the_same_sources_give_the_same_module(tmp_path):
    built = tmp_path / "kernel.wasm"
    subprocess.run([ZIG, ROOT / "workshop/kernel_wasm.py", built], check=True)
    assert built.read_bytes() == MODULE.read_bytes()
