"""What importers read of a model is compared with the body that it describes."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from physics.tops import EPS

from symtop_ros.run.models import FORMATS, UNSAID, name_file
from symtop_ros.truth.testset.forms import FORMS
from symtop_ros.truth.testset.score import DESCRIPTIONS, FORMED, find_problem, read_problems
from workshop.importers.compare import expect, judge

READ = Path(__file__).parents[3] / "workshop/importers/read.py"
FACTS = read_problems()["free_rod_fast"].facts


def read(importer, *paths):
    done = subprocess.run([sys.executable, READ, importer, *paths], check=True, capture_output=True)
    return list(json.loads(done.stdout)["found"].values())


def find_paths(folder, form):
    """The paths of the models of a rod by their descriptions."""
    return {
        each: folder / "models" / name_file(f"free_rod_fast{'.' * bool(each)}{each}", form)
        for each in ("", *DESCRIPTIONS)
        if (each, form) not in UNSAID
    }


FACTS_OF_FORMS = read_problems()[FORMED].facts
FORMS_OF_MJCF = [name for name, form in FORMS if form == "mjcf"]


def test_mujoco_reads_the_body_of_every_form(folder):
    pytest.importorskip("mujoco")
    paths = [folder / "models" / f"{FORMED}.{name}.mjcf" for name in FORMS_OF_MJCF]
    for name, found in zip(FORMS_OF_MJCF, read("mujoco", *paths), strict=True):
        assert judge(found, expect(FACTS_OF_FORMS, name)) == "right", name


@pytest.mark.parametrize("name", FORMS_OF_MJCF)
def test_a_form_of_mjcf_starts_in_the_frame_in_which_it_is_scored(name, folder):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(str(folder / "models" / f"{FORMED}.{name}.mjcf"))
    facts = find_problem(read_problems(), f"{FORMED}.{name}").facts
    # a few products of rounded numbers; the quaternion is a unit one in the model
    q = np.array(facts["orientation"]) / np.linalg.norm(facts["orientation"])
    assert model.key_qpos[0] == pytest.approx(q, abs=4 * EPS)
    rates = facts["angular_velocity"]
    assert model.key_qvel[0] == pytest.approx(rates, abs=4 * EPS * np.linalg.norm(rates))


def test_the_schema_of_usd_has_the_body_of_every_form_that_states_it(folder):
    pytest.importorskip("pxr")
    names = [name for name, form in FORMS if form == "usd" and name != "solid"]
    paths = [folder / "models" / f"{FORMED}.{name}.usda" for name in names]
    for name, found in zip(names, read("usd-core", *paths), strict=True):
        assert judge(found, expect(FACTS_OF_FORMS, name)) == "to 6 digits", name


@pytest.mark.parametrize("form", ["mjcf", "urdf"])
def test_mujoco_reads_the_body_of_every_description(form, folder):
    pytest.importorskip("mujoco")
    paths = find_paths(folder, form)
    for description, found in zip(paths, read("mujoco", *paths.values()), strict=True):
        assert judge(found, expect(FACTS, description)) in ("right", "to 6 digits"), description


def test_the_schema_of_usd_has_the_body_of_every_description(folder):
    pytest.importorskip("pxr")
    paths = find_paths(folder, "usd")
    for description, found in zip(paths, read("usd-core", *paths.values()), strict=True):
        assert judge(found, expect(FACTS, description)) == "to 6 digits", description


def test_an_importer_that_forgets_the_inertial_frame_is_convicted(folder, tmp_path):
    pytest.importorskip("mujoco")
    text = find_paths(folder, "urdf")["inertial"].read_text()
    inertial = text.index("<inertial>\n      <origin xyz")
    forgotten = tmp_path / "forgotten.urdf"
    head, turn, rest = text[inertial:].partition(" rpy=")
    forgotten.write_text(text[:inertial] + head + rest[rest.index("/>") :])
    assert turn
    (found,) = read("mujoco", forgotten)
    # (Ix - Iz) in place of 0, of a rod: nearly all of Ix
    assert judge(found, expect(FACTS, "inertial")).startswith("tensor wrong by ")


def test_a_file_that_no_importer_takes_is_refused(tmp_path):
    pytest.importorskip("mujoco")
    path = tmp_path / "empty.mjcf"
    path.write_text("<mujoco/>")
    (found,) = read("mujoco", path)
    assert judge(found, expect(FACTS, "")) == "refused"


def test_a_reader_that_ends_with_its_process_is_refused_and_other_files_are_read(tmp_path):
    from workshop.importers.__main__ import _read_files

    code = "import json, sys; names = sys.argv[1:]; 'bad' in names and sys.exit(3); "
    code += "print(json.dumps({'version': '1', 'found': {name: {'mass': 1} for name in names}}))"
    found = _read_files([sys.executable, "-c", code], ["good", "bad"], tmp_path)
    assert found == {"good": {"mass": 1}, "bad": {"refused": "it ends with status 3"}}


def test_every_format_is_read_by_some_importer():
    from workshop.importers.__main__ import IMPORTERS

    assert {form for each in IMPORTERS for form in each.formats} == {*FORMATS}
