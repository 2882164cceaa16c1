"""The kernel compiled for this processor and for another one, without Python: the same bits."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from physics.driven_families import list_cases
from physics.tops import random_case

from symtop_ros.physics import Motion, accelerated

SOURCE = Path(__file__).with_name("print_states.cpp")
OPTIONS = ["-O2", "-std=c++17", "-ffp-contract=off"]
AARCH64 = Path(__file__).parents[3] / ".venv/aarch64/usr"
FAMILIES = "any", "weak gravity", "fast", "critical", "pendulum", "from below"
# of the time of a case; less than 1e15 turns, which is what the kernel serves
TIMES = np.array(
    [0.0, 1e-9, -1e-4, 1e-3, -1e-2, 0.1, 0.02, -0.03, 1e-9, 0.04, 0.05, -0.06, 0.07, 0.08]
)


def list_motions():
    """Random motions, each with its times."""
    for family in FAMILIES:
        for seed in range(40):
            case = random_case(50_000 + seed, family)
            motion = Motion(case.top, case.start)
            if motion.engine == "closed form":
                yield motion, case.t * TIMES


def encode(motions, driven):
    numbers = [np.ravel(ROWS), [len(motions)]]
    for motion, times in motions:
        start = [each for part in motion._arguments for each in part]
        numbers += [start, [motion.top.Mgl < 0], [len(times)], times]
    numbers.append([len(driven)])
    for case in driven:
        motion, (_, t) = case.motion, case.times
        friction = motion.friction
        numbers += [motion.top.moments, [friction.axial, friction.transverse]]
        numbers += [motion.applied_torque, motion.start.given_orientation]
        numbers += [motion.start.angular_velocity, [t]]
    return np.concatenate([np.asarray(each, dtype=float) for each in numbers]).tobytes()


def expect(motions, driven):
    states = [motion.at(times) for motion, times in motions]
    states += [case.motion.at([case.times[1]]) for case in driven]
    parts = [np.concatenate(each.parts, axis=1) for each in states]
    return np.concatenate(parts)


def compare(program):
    motions, driven = list(list_motions()), list_cases()[::3]
    output = subprocess.run(
        program, input=encode(motions, driven), capture_output=True, check=True
    ).stdout
    found, expected = np.frombuffer(output).reshape(-1, 7), expect(motions, driven)
    closed = sum(len(times) for _, times in motions)
    assert found[:closed].tobytes() == expected[:closed].tobytes()
    if accelerated:  # Python alone has other bits for driven motions
        # and the start of a driven motion is given back as it is
        assert found[closed:].tobytes() == expected[closed:].tobytes()


@pytest.mark.skipif(not shutil.which("g++"), reason="no C++ compiler")
def test_a_program_without_python_has_the_same_bits(tmp_path):
    program = tmp_path / "print_states"
    subprocess.run(["g++", *OPTIONS, str(SOURCE), "-o", str(program)], check=True)
    compare([str(program)])


@pytest.mark.long
@pytest.mark.skipif(not AARCH64.exists(), reason="make .venv/aarch64 fetches compiler and emulator")
def test_an_arm_processor_has_the_same_bits(tmp_path):
    program = tmp_path / "print_states"
    (compiler,) = AARCH64.glob("bin/aarch64-linux-gnu-g++-*")
    libraries = AARCH64 / "lib/x86_64-linux-gnu"
    command = [str(compiler), *OPTIONS, "-static", str(SOURCE), "-o", str(program)]
    subprocess.run(command, check=True, env={"LD_LIBRARY_PATH": str(libraries), "PATH": ""})
    compare([str(AARCH64 / "bin/qemu-aarch64-static"), str(program)])
