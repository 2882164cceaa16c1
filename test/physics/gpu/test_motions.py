"""The device's source on the host, behind a stand-in for CuPy: bits, shapes and refusals."""

import contextlib
import io
import re
import sys

import numpy as np
import pytest
from documents import ROOT, blocks
from physics.gpu.host_device import MEMORY, compile_host, make_cupy
from programs import find_fault, run_python

from symtop_ros.physics import Motion, State, Top
from symtop_ros.physics import Motions as MotionsOfCpu
from symtop_ros.physics.gpu import DeviceError, Motions, toolchain
from symtop_ros.physics.gpu import __main__ as program
from symtop_ros.physics.gpu.draw import FAMILIES, draw_mixed

COUNT = 100_000
ARTICLE = Top(0.000228, 0.0000572, 0.068)
START = State.from_euler(theta=0.5, psi_dot=200.0)
BAD_TOP, BAD_TIME, TOO_FAR = 2, 7, 8  # of symtop_status


def forget():
    toolchain.open_cupy.cache_clear()
    toolchain._open.cache_clear()


@pytest.fixture(scope="module", name="library")
def _library(tmp_path_factory):
    if fault := find_fault("g++"):
        pytest.skip(fault)
    return compile_host(tmp_path_factory.mktemp("host"))


@pytest.fixture(name="cupy")
def _cupy(library, monkeypatch):
    """A device that is this host."""
    cupy = make_cupy(library)
    monkeypatch.setitem(sys.modules, "cupy", cupy)
    forget()
    yield cupy
    forget()


@pytest.mark.slow
def test_no_bit_of_any_family_differs_from_the_kernel_of_the_processor(cupy):
    starts, times = draw_mixed(COUNT, 11)
    functions = toolchain.open_functions()
    motions, status = functions.prepare(cupy.asarray(starts))
    found = functions.read(motions, cupy.asarray(times), 1, 1)
    expected = toolchain.compute_on_cpu(starts, times)
    assert toolchain.find_different(expected, found).sum() == 0
    written = (expected[2] == 0).sum()
    refused = COUNT // len(FAMILIES)
    assert (status == BAD_TOP).sum() == pytest.approx(refused, abs=1)
    assert 0 < COUNT - refused - written < COUNT // 50  # too far


def test_states_have_the_shape_of_the_motions_and_the_times(cupy):
    weights = cupy.asarray(np.linspace(0.05, 0.08, 5))
    motions = Motions((0.000228, 0.0000572, weights), START)
    assert len(motions) == 5
    for times, shape in ((1.0, (5,)), ([0.0, 10.0, 1e6], (5, 3))):
        states = motions.at(times)
        expected = MotionsOfCpu(Top(0.000228, 0.0000572, weights.get()), START).at(times)
        assert states.orientation.shape == (*shape, 4)
        assert states.angular_velocity.shape == (*shape, 3)
        assert (states.status == np.zeros(shape)).all()
        assert (states.orientation.get() == expected.orientation).all()
        assert (states.angular_velocity.get() == expected.angular_velocity).all()


def test_each_motion_has_its_own_times(cupy):
    motions = Motions(Top(0.000228, 0.0000572, np.array([0.05, 0.068])), START)
    times = np.array([[0.0, 1.0, 2.0], [3.0, 4.0, 1e9]])
    table = motions.at_each(times)
    column = motions.at_each(times[:, 1])
    for i in range(2):
        assert (table.orientation[i] == motions[i].at(times[i]).orientation).all()
        assert (column.orientation[i] == table.orientation[i, 1]).all()


def test_one_of_them_is_a_motion_of_the_library(cupy):
    given = np.array([[1.0005, 0.0, 0.0, 0.0], [0.6, 0.8, 0.0, 0.0]])
    motions = Motions(ARTICLE, (given, np.array([1.0, 2.0, 200.0])))
    for i in range(2):
        alone = Motion(ARTICLE, State(given[i], [1.0, 2.0, 200.0]))
        assert motions[i].at(10.0) == alone.at(10.0)
        assert (motions.at(1e6).orientation[i] == alone.at(1e6).orientation).all()


def test_a_start_that_is_refused_is_nan_with_its_reason(cupy):
    Iz = np.array([1.0, 3.0, np.nan])
    motions = Motions((1.0, Iz, 1.0), ([1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0]))
    assert motions.status.tolist() == [0, BAD_TOP, BAD_TOP]
    assert [*motions.refusals] == [1, 2]
    assert motions.refusals[1].startswith("Ix, Iz and Mgl must be finite")
    states = motions.at([1.0, np.nan, 1e300])
    assert states.status.tolist() == [[0, BAD_TIME, TOO_FAR], [BAD_TOP] * 3, [BAD_TOP] * 3]
    assert (np.isnan(states.orientation).all(axis=-1) == (states.status != 0)).all()
    with pytest.raises(ValueError, match="Iz must be"):
        motions[1]


class Foreign:
    """An array of another library, which NumPy reads by DLPack alone."""

    def __init__(self, array):
        self.array = array

    def __dlpack__(self, **named):
        return self.array.__dlpack__(**named)

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()


def test_arrays_of_other_libraries_are_read_by_dlpack(cupy):
    weights = np.linspace(0.05, 0.08, 5)
    one = Motions((0.000228, 0.0000572, Foreign(weights)), START)
    other = Motions((0.000228, 0.0000572, weights), START)
    assert (one.at(10.0).orientation == other.at(10.0).orientation).all()


def test_the_program_of_the_page_prints_what_the_page_shows(cupy):
    ((code, output),) = blocks(ROOT / "docs/many.md", "py")
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(code, {})
    assert printed.getvalue() == output


@pytest.mark.parametrize(
    ("top", "start", "message"),
    [
        (
            (1.0, 1.0, np.ones(2)),
            ([1.0, 0, 0, 0], np.zeros((3, 3))),
            "arrays must be of one length",
        ),
        ((1.0, 1.0, 1.0), ([1.0, 0, 0], [0.0, 0, 1]), r"orientation must be of shape \(4,\)"),
        ((1.0, 1.0, np.ones((2, 2))), START, r"Mgl must be a number or of shape \(n,\)"),
        ((1.0, 1.0), START, "top and start must be of 3 and 2 arrays, got 4"),
    ],
)
def test_shapes_that_do_not_fit_are_named(top, start, message, cupy):
    with pytest.raises(ValueError, match=message):
        Motions(top, start)


def test_times_that_do_not_fit_are_named(cupy):
    motions = Motions(ARTICLE, START)
    with pytest.raises(
        ValueError, match=r"times must be a number or of shape \(m,\), got \(2, 2\)"
    ):
        motions.at(np.zeros((2, 2)))
    with pytest.raises(ValueError, match=r"times must be of shape \(1,\) or \(1, m\), got \(2,\)"):
        motions.at_each(np.zeros(2))


def test_what_does_not_fit_into_memory_is_refused_with_the_number_that_does(cupy):
    size = toolchain.open_functions().motion_bytes
    with pytest.raises(ValueError, match=f"motions must be at most {MEMORY // size} "):
        Motions((1.0, 1.0, np.ones(MEMORY // size + 1)), START)
    with pytest.raises(ValueError, match="states must be at most"):
        Motions(ARTICLE, START).at(np.broadcast_to(0.0, MEMORY // 57 + 1))


def test_a_device_with_another_bit_is_refused(cupy, monkeypatch):
    read = toolchain.Functions.read

    def spoil(*arguments):
        found = read(*arguments)
        found[0][7, 0, 2] = np.nextafter(found[0][7, 0, 2], 2.0)
        return found

    monkeypatch.setattr(toolchain.Functions, "read", spoil)
    with pytest.raises(
        DeviceError, match=r"got others in 1 of 288 motions of the trial .*first: 7"
    ):
        Motions(ARTICLE, START)


def test_the_trial_has_all_families():
    rows = np.load(toolchain.TRIAL)
    assert rows.shape == (24 * len(FAMILIES), 16)
    orientation, _, left = toolchain.compute_on_cpu(rows[:, :15].copy(), rows[:, 15].copy())
    refused = np.isnan(orientation[:, 0]).reshape(len(FAMILIES), -1).sum(axis=1)
    assert dict(zip(FAMILIES, refused, strict=True))["refused"] == 24
    assert (left != 0).sum() == refused.sum() < 40


def test_the_program_prints_bits_speeds_and_the_errors_of_an_integrator(cupy, capsys, monkeypatch):
    monkeypatch.setattr(program, "STEPS", 2000)
    monkeypatch.setattr(program, "EACH", 5)
    monkeypatch.setattr(sys, "argv", ["gpu", "--motions", "240"])
    assert program.main() == 0
    printed = capsys.readouterr().out
    assert "device: host" in printed
    assert "bits: 0 of 240 mixed motions differ" in printed
    errors = re.findall(r"Runge-Kutta, 2000 steps to .*error: median (\S+) rad", printed)
    assert len(errors) == 2


def test_without_cupy_a_line_names_it():
    code = (
        "import sys; sys.modules['cupy'] = None; from symtop_ros.physics.gpu.__main__ import main; "
    )
    done = run_python(f"{code}sys.argv[1:] = []; sys.exit(main())")
    assert done.returncode == 1
    assert done.stderr == f"symtop_ros.physics.gpu: {toolchain.NO_CUPY}\n"


def test_without_a_gpu_a_line_says_so(cupy):
    def fail():
        raise RuntimeError("cudaErrorNoDevice: no CUDA-capable device is detected")

    cupy.cuda.runtime.getDeviceCount = fail
    with pytest.raises(DeviceError, match=r"a GPU of NVIDIA must be there, got none \(cudaErrorNo"):
        Motions(ARTICLE, START)


def test_the_options_change_with_the_headers(monkeypatch, tmp_path):
    before = toolchain.list_options()
    (tmp_path / "new.hpp").write_text("")
    monkeypatch.setattr(toolchain, "SHIM", tmp_path)
    assert toolchain.list_options()[-1].startswith("-DSYMTOP_DIGEST=")
    (tmp_path / "new.hpp").write_text("// changed")
    assert toolchain.list_options()[-1] != before[-1]
