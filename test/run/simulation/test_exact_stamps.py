"""Every message, decoded from its bytes, is within a few eps of the exact motion at its stamp.

The exact motion starts from the doubles of the last event that changed it, and its time is the
exact sum of products of nanoseconds and real-time factors. It is computed with 60 digits.
"""

from fractions import Fraction

import numpy as np
import pytest
from drawn import Numbers
from mpmath import mp, mpf
from physics.tops import EPS, attitude_error, error, exact_euler, turn
from run.simulation.runs import SECOND, ListSink, Run
from trials import choose, trials

from symtop_ros.physics.reference.series import Inputs
from symtop_ros.run.simulation.topics import STATE_TOPICS
from workshop.digits import ClosedForm

pytestmark = [pytest.mark.numbers, pytest.mark.untraced]

# In eps; 5 is what is promised. The worst of these samples has 2.8, the rest is for other libraries
# of sines and exponentials.
BOUND = 4.0
YEAR = 365 * 86_400 * SECOND
FACTORS = choose((1.0, 1 / 3, 0.1, 7.0, 1e-3), (1 / 3,))
SCENES = (
    "cusps",
    "looping",
    "unidirectional",
    "regular_precession",
    "fast_precession",
    "hurry_slow",
    "hurry_fast",
    "perry_fails",
    "sleeping",
    "sleeping_unstable",
    "through_the_pole",
    "hanging",
    "disc",
    "free",
)
LAYOUTS = {name: topic.layout("world", "top") for name, topic in STATE_TOPICS.items()}


class ByteSink(ListSink):
    """Keeps the encoded messages of each stamp."""

    def __init__(self):
        super().__init__()
        self.messages = {}

    def send_sample(self, stamp, block):
        self.messages[stamp] = {
            name: layout.encode(stamp, block.numbers(name, stamp))
            for name, layout in LAYOUTS.items()
        }


def decode(name, data):
    layout = LAYOUTS[name]
    stamps, numbers = layout.decode(np.frombuffer(data, np.uint8).reshape(1, -1))
    return int(stamps[0]), numbers[0]


def expect(event, stamp):
    """The exact attitude, body rates, and vectors in the world by their topics, at a stamp."""
    keys = "top", "motion.orientation", "motion.angular_velocity"
    moments, *start = ([float(part) for part in event.values[key].split()] for key in keys)
    with mp.workdps(120):
        exact = ClosedForm(Inputs.exact(*moments, *start), 60)
        q, omega = exact.at(_exact_seconds(event, stamp))
        Ix, Iz, Mgl = map(mpf, moments)
        momentum = [Ix * omega[0], Ix * omega[1], Iz * omega[2]]
        x, y, _ = turn(q, (0, 0, Mgl))
        vectors = {"angular_velocity": turn(q, omega), "angular_momentum": turn(q, momentum)}
        return q, omega, {**vectors, "torque": (-y, x, 0)}


def _exact_seconds(event, stamp):
    """The exact time of the motion at a stamp, from the texts of the event alone."""
    values = event.values
    elapsed = Fraction(values["motion.elapsed_ns"])
    if values["motion.running"] == "true":
        factor = Fraction(float(values["motion.real_time_factor"]))
        elapsed += factor * (stamp - int(values["motion.stamp"]))
    return mpf(elapsed.numerator) / elapsed.denominator / SECOND


def errors(run, stamp):
    """Largest error of each quantity at a stamp, in units of its bound of 1 eps."""
    begins = [each for each in run.sink.events if int(each.values["motion.stamp"]) <= stamp]
    event = begins[-1]
    numbers = {}
    for name, data in run.sink.messages[stamp].items():
        found, numbers[name] = decode(name, data)
        assert found == stamp
    q, omega, vectors = expect(event, stamp)
    found = {
        name: attitude_error([*q[1:], q[0]], numbers[name][-4:]) for name in ("orientation", "tf")
    }
    for name, exact in vectors.items():
        found[name] = error(exact, numbers[name][-3:], mp.norm(exact) or 1.0)
    found |= _euler_errors(q, omega, numbers["euler_angles"])
    return {name: each / EPS for name, each in found.items()}


def _euler_errors(q, omega, numbers):
    if not (any(q[1:3]) and any(q[::3])):  # on the vertical phi and psi are undefined
        return {}
    with mp.workdps(60):
        (phi, theta, psi), rates = exact_euler(q, omega)
        sine = mp.sin(theta)
        off = [a - b for a, b in zip(numbers[3:].tolist(), rates, strict=True)]
        turns = [(a - b) / (2 * mp.pi) for a, b in ((numbers[0], phi), (numbers[2], psi))]
        found = [abs(numbers[1] - theta) / theta]
        found += [2 * abs(each - mp.nint(each)) * sine for each in turns]
        found += [abs(each) * sine / mp.norm(omega) for each in off]
    return dict(zip(("theta", "phi", "psi", "phi'", "theta'", "psi'"), found, strict=True))


def start(scene, **changes):
    run = Run(scene, sink=ByteSink(), **changes)
    run.simulation.do("reset", {})
    return run


def assert_exact(run, stamps):
    for stamp in stamps:
        found = errors(run, stamp)
        wrong = {name: float(each) for name, each in found.items() if each > BOUND}
        assert not wrong, (stamp, wrong)


@pytest.mark.parametrize("factor", FACTORS)
@pytest.mark.parametrize("scene", SCENES)
def test_samples_of_a_minute_and_after_a_year(scene, factor):
    run = start(scene, publish_rate=7.0, real_time_factor=factor)
    run.advance(2.0, 0.1)
    minute = sorted(run.sink.messages)
    run.clock.now = 60 * SECOND
    run.tick()
    run.clock.now = YEAR
    run.tick()
    late = sorted(run.sink.messages)[-3:]
    assert late[-1] > YEAR - SECOND
    assert_exact(run, [minute[3], minute[-1], sorted(run.sink.messages)[-10], late[0], late[-1]])


CHANGED = "cusps", "free", "looping", "through_the_pole"


@pytest.mark.parametrize("scene", choose(CHANGED, CHANGED[:1]))
@pytest.mark.parametrize("count", trials(40, 1000))
def test_samples_after_many_pauses_steps_and_changes(scene, count):
    run = start(scene, publish_rate=30.0)
    chance = Numbers(1)
    for _ in range(count):
        action = chance.randrange(3)
        if action == 0:
            run.ask("pause", True)
            run.ask("step", {"duration": chance.uniform(0.0, 10.0)})
        elif action == 1:
            run.ask("pause", False)
        else:
            run.change({"real_time_factor": chance.power(-3, 2)})
        run.clock.now += chance.randrange(SECOND)
        run.tick()
    run.ask("pause", False)
    run.advance(0.5, 0.1)
    stamps = sorted(run.sink.messages)
    assert_exact(run, [*stamps[:: len(stamps) // 12], *stamps[-3:]])
