"""The scorers in C++ and JavaScript print what the scorer in Python prints, for any file."""

import shutil
from base64 import b64encode
from functools import partial

import numpy as np
import pytest
from programs import execute

from symtop_ros.arrays import invert
from symtop_ros.physics import State
from symtop_ros.testset.score import FILE, find_problem, main, read_problems

SCORER = FILE.with_name("score.mjs")
NAMES = ("t", "w", "x", "y", "z", "wx", "wy", "wz")
PROBLEMS = (
    *("cusps", "gentle_pole", "plane_pendulum", "free_rod", "cusps_100000", "large"),
    *("cusps.turned", "gentle_pole.turned", "free_rod.nested", "large.offset"),
)


def read_exact(name):
    """Times, quaternions and rates in doubles."""
    facts = find_problem(read_problems(), name).facts
    parts = [np.array(facts[key], dtype=float) for key in ("orientations", "angular_velocities")]
    return np.array(facts["times"]), *parts


def make_table(name, error=0.0, seed=1):
    """The columns of an exact trajectory with errors at random."""
    t, q, omega = read_exact(name)
    random = np.random.default_rng(seed)
    q = q + error * random.normal(size=q.shape)
    return np.column_stack((t, q, omega * (1 + error * random.normal(size=omega.shape))))


def write(table, names=NAMES, separator=","):
    rows = [separator.join(map(repr, row)) for row in table.tolist()]
    return "\n".join([separator.join(names), *rows]) + "\n"


def make_mistakes():
    """Tables with a mistake of convention, by what is named."""
    t, q, omega = read_exact("cusps")
    world = State(q, omega).to_world(omega)
    xyzw = [1, 2, 3, 0]
    tables = {
        "order x, y, z, w": (q[:, xyzw], omega),
        "conjugate: world to body": (invert(q), omega),
        "conjugate, in the order x, y, z, w": (invert(q)[:, xyzw], omega),
        "in deg/s": (q, np.degrees(omega)),
        "in the world frame": (q, world),
        "in deg/s, in the world frame": (q, np.degrees(world)),
    }
    return {name: write(np.column_stack((t, *parts))) for name, parts in tables.items()}


def make_files():
    """Good and bad tables of the problem cusps, by what they are."""
    good, (t, q, omega) = make_table("cusps", 1e-7), read_exact("cusps")
    text = write(good)
    lines = text.splitlines()
    # errors above rounding, which depends on the order of sums
    world = State(q, omega).to_world(omega * (1 + 1e-9))
    in_world = np.column_stack((t, q, world)), (*NAMES[:5], "omega_x", "omega_y", "omega_z")
    more = ["a," + lines[0], *(f"x,{row}" for row in [*lines[1:], "0.1" + ",1" * 7])]
    far, odd = good.copy(), good.copy()
    far[3, 1], odd[5, 6] = 1e300, -1e200
    return {
        "good": text,
        "bom": "\ufeff" + text,
        "semicolons": write(good, separator=";"),
        "tabs": write(good, separator="\t"),
        "spaces": write(good, separator="  "),
        "hash": "# " + write(good, separator=" "),
        "quotes": text.replace("t,w", '"t","w"'),
        "blank lines and carriage returns": "\r\n\r\n".join(lines),
        "no rates": write(good[:, :5], NAMES[:5]),
        "world rates": write(*in_world),
        "other columns and rows": "\n".join(more),
        "times that have added up": write(good * [1 + 5e-10, *[1.0] * 7]),
        "norms of 1.005": write(good * [1, *[1.005] * 4, 1, 1, 1]),
        "of one sign": write(good * [1, *[-1.0] * 4, 1, 1, 1]),
        "still": write(np.column_stack((t, np.tile(q[0], (20, 1))))[:, :5], NAMES[:5]),
        **make_mistakes(),
        "norms of 1.1": write(good * [1, *[1.1] * 4, 1, 1, 1]),
        "zeros": write(good * [1, *[0.0] * 4, 1, 1, 1]),
        "overflow": write(far),
        "overflow of a rate": write(odd),
        "nan": text.replace(lines[4].split(",")[2], "nan"),
        "infinite time": text + "inf" + ",1" * 7 + "\n",
        "no header": "\n".join(lines[1:]),
        "other names": text.replace("t,w", "time,qw"),
        "empty": "",
        "a header alone": lines[0],
        "other times": write(good * [1 + 1e-6, *[1.0] * 7]),
        "half of the times": "\n".join(lines[:11]),
        "a word": text.replace(lines[4].split(",")[2], "one"),
        "a hexadecimal number": text.replace(lines[4].split(",")[2], "0x1p-3"),
        "underscores": text.replace(lines[4].split(",")[2], "1_0"),
        "a row without its end": text.replace(lines[4], ",".join(lines[4].split(",")[:3])),
        "short row": text.replace(lines[4], "1.75,1,2"),
        "not text": "\x00\x01\u00e9\u0416",
    }


FILES = make_files()


@pytest.fixture(scope="session")
def cpp(folder):
    """Run the scorer in C++."""
    compiler = shutil.which("g++")
    if not compiler:
        pytest.skip("no g++: apt install g++")
    command = [compiler, "-O1", "-std=c++17", "-Wall", "-Wextra", "-Werror", "score.cpp"]
    execute([*command, "-o", "score"], cwd=folder, check=True)
    return partial(run, folder / "score")


@pytest.fixture(scope="session")
def javascript(folder, browser):
    """Run the scorer in JavaScript in a page, which takes a tenth of the time of Node's start."""
    page = browser.new_page()
    texts = {name: (folder / name).read_text() for name in ("problems.csv", "states.csv")}
    page.evaluate(LOAD, [b64encode(SCORER.read_bytes()).decode(), texts])
    return partial(run_in_page, page)


def run(*command):
    done = execute(command)
    return done.returncode, done.stdout, done.stderr


LOAD = """async ([module, texts]) => {
    const { run } = await import(`data:text/javascript;base64,${module}`);
    window.score = ([words, own]) => run(words, (name) => texts[name], (name) => own[name]);
}"""


def run_in_page(page, *args):
    """Give the module, which a page has loaded, the words and the texts of the files."""
    own = {str(path): path.read_bytes().decode("latin-1") for path in args[1:]}
    found = page.evaluate("(given) => score(given)", [list(map(str, args)), own])
    ends = ["\n" if found[key] else "" for key in ("out", "err")]
    return found["status"], found["out"] + ends[0], found["err"] + ends[1]


def score(capsys, *args):
    status = main(list(map(str, args)))
    return status, *capsys.readouterr()


def assert_same(capsys, cpp, javascript, *args):
    """Compare what the three scorers print; return the status."""
    wanted = score(capsys, *args)
    assert cpp(*args) == wanted
    assert javascript(*args) == wanted
    return wanted[0]


CASES = {kind: ("cusps", text) for kind, text in FILES.items()}
for problem in PROBLEMS:
    for error in (1e-15, 1e-3):
        CASES[f"{problem} with errors of {error:g}"] = problem, write(make_table(problem, error))


@pytest.mark.parametrize(("name", "text"), CASES.values(), ids=CASES)
def test_the_three_scorers_print_the_same(name, text, tmp_path, capsys, cpp, javascript):
    path = tmp_path / "trajectory.csv"
    path.write_text(text, encoding="utf-8")
    status = assert_same(capsys, cpp, javascript, name, path)
    assert status == 0 or name == "cusps"  # of which there are bad files


def test_the_three_scorers_list_and_refuse_the_same(capsys, cpp, javascript):
    for args in ((), ("no  such",), ("cusps",), ("cusps.bent",), ("no.turned",), ("cusps.turned",)):
        assert_same(capsys, cpp, javascript, *args)


@pytest.mark.skipif(not shutil.which("node"), reason="no node: apt install nodejs")
def test_node_and_the_program_in_cpp_say_what_cannot_be_read(folder, tmp_path, capsys, cpp):
    (tmp_path / "good.csv").write_text(FILES["good"])
    node = partial(run, "node", folder / "score.mjs")
    for path in ("good.csv", "none.csv", "."):
        assert_same(capsys, cpp, node, "cusps", tmp_path / path)


@pytest.mark.parametrize("kind", make_mistakes())
def test_a_mistake_of_convention_is_named(kind, tmp_path, capsys):
    path = tmp_path / "trajectory.csv"
    path.write_text(FILES[kind])
    status, out, _ = score(capsys, "cusps", path)
    (note,) = out.splitlines()[1:]
    assert status == 0
    assert note.startswith("likely mistake: the ")
    assert note.endswith(kind)
