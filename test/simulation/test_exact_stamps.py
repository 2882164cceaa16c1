"""Every message, decoded from its bytes, is within a few eps of the exact motion at its stamp.

The exact motion starts from the doubles of the last event that changed it, and its time is the
exact sum of products of nanoseconds and real-time factors. It is computed with 150 digits.
"""

from __future__ import annotations

import math
import random
from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp, mpc, mpf
from simulation.runs import SECOND, ListSink, Run

from symtop_ros.simulation.topics import STATE_TOPICS
from workshop.exact_motion import Inputs, exact_motion

pytestmark = pytest.mark.untraced

EPS = 2.0**-52
# In eps; 5 is what is promised. The worst of these samples has 2.8, the rest is for other libraries
# of sines and exponentials.
BOUND = 4.0
YEAR = 365 * 86_400 * SECOND
FACTORS = (1.0, 1 / 3, *(pytest.param(each, marks=pytest.mark.long) for each in (0.1, 7.0, 1e-3)))
SCENES = (
    *("cusps", "looping", "unidirectional", "regular_precession", "fast_precession"),
    *("hurry_slow", "hurry_fast", "perry_fails", "sleeping", "sleeping_unstable"),
    *("through_the_pole", "hanging", "disc", "free"),
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


class Expected:
    """The exact quantities of all topics at one stamp."""

    def __init__(self, event, stamp):
        values = {
            key: [float(part) for part in event.values[key].split()]
            for key in ("top", "motion.orientation", "motion.angular_velocity")
        }
        self.Ix, self.Iz, self.Mgl = values["top"]
        inputs = Inputs.of(*values["top"], *list(values.values())[1:])
        with mp.workdps(120):
            self.q, self.omega = exact_motion(inputs, _exact_seconds(event, stamp))
            w, x, y, z = self.q
            self.A, self.B = mpc(w, z), mpc(x, y)
            self.spin = inputs.angular_velocity[2]

    def _to_world(self, vector):
        w, x, y, z = self.q
        a, b, c = vector
        rows = (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
        return [r[0] * a + r[1] * b + r[2] * c for r in rows]

    def angular_velocity(self):
        return self._to_world((self.omega[0], self.omega[1], self.spin))

    def angular_momentum(self):
        return self._to_world(
            (self.Ix * self.omega[0], self.Ix * self.omega[1], self.Iz * self.spin)
        )

    def torque(self):
        axis = self._to_world((mpf(0), mpf(0), mpf(self.Mgl)))
        return [-axis[1], axis[0], mpf(0)]

    def euler(self):
        """theta, sin(theta), phi, psi and the rates phi', theta', psi'."""
        theta = 2 * mp.atan2(abs(self.B), abs(self.A))
        phi, psi = mp.arg(self.A) + mp.arg(self.B), mp.arg(self.A) - mp.arg(self.B)
        node = mp.expj(mp.arg(self.B) - mp.arg(self.A))  # exp(-i psi)
        sine = mp.sin(theta)
        across = mpc(self.omega[0], self.omega[1]) * mp.conj(node)  # theta' + i sin(theta) phi'
        phi_dot = across.imag / sine
        return theta, sine, phi, psi, phi_dot, across.real, self.spin - phi_dot * mp.cos(theta)


def _exact_seconds(event, stamp):
    """The exact time of the motion at a stamp, from the texts of the event alone."""
    values = event.values
    elapsed = Fraction(values["motion.elapsed_ns"])
    if values["motion.running"] == "true":
        factor = Fraction(float(values["motion.real_time_factor"]))
        elapsed += factor * (stamp - int(values["motion.stamp"]))
    return mpf(elapsed.numerator) / elapsed.denominator / SECOND


def _distance(numbers, exact):
    return float(
        mp.sqrt(sum((mpf(float(a)) - b) ** 2 for a, b in zip(numbers, exact, strict=True)))
    )


def _turns(difference):
    return float(abs(difference - 2 * mp.pi * mp.nint(difference / (2 * mp.pi))))


def errors(run, stamp):
    """Largest error of each quantity at a stamp, in units of its bound of 1 eps."""
    begins = [each for each in run.sink.events if int(each.values["motion.stamp"]) <= stamp]
    event = begins[-1]
    numbers = {}
    for name, data in run.sink.messages[stamp].items():
        found, numbers[name] = decode(name, data)
        assert found == stamp
    with mp.workdps(60):
        expected = Expected(event, stamp)
        w, x, y, z = expected.q
        q = [x, y, z, w]
        found = {}
        for name, part in (("orientation", numbers["orientation"]), ("tf", numbers["tf"][3:])):
            found[name] = min(_distance(part, q), _distance(-part, q))
        for name, exact, part in (
            ("angular_velocity", expected.angular_velocity(), numbers["angular_velocity"][3:]),
            ("angular_momentum", expected.angular_momentum(), numbers["angular_momentum"]),
            ("torque", expected.torque(), numbers["torque"][3:]),
        ):
            size = _distance([0.0] * 3, exact)
            found[name] = _distance(part, exact) / size if size else _distance(part, exact)
        found.update(_euler_errors(expected, numbers["euler_angles"]))
    return {name: error / EPS for name, error in found.items()}


def _euler_errors(expected, numbers):
    if 0 in (expected.A, expected.B):  # on the vertical phi and psi are undefined
        return {}
    theta, sine, phi, psi, *rates = expected.euler()
    omega = float(mp.sqrt(sum(each**2 for each in (*expected.omega[:2], expected.spin))))
    found = {
        "theta": float(abs(mpf(float(numbers[1])) - theta) / theta),
        "phi": _turns(numbers[0] - phi) * float(sine) / math.pi,
        "psi": _turns(numbers[2] - psi) * float(sine) / math.pi,
    }
    for name, number, rate in zip(("phi'", "theta'", "psi'"), numbers[3:], rates, strict=True):
        found[name] = float(abs(mpf(float(number)) - rate) * sine) / omega
    return found


def start(scene, **changes):
    run = Run(scene, **changes)
    run.sink = run.simulation._sink = ByteSink()
    run.simulation.report("start", "")
    return run


def assert_exact(run, stamps):
    for stamp in stamps:
        found = errors(run, stamp)
        wrong = {name: round(error, 1) for name, error in found.items() if error > BOUND}
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


@pytest.mark.parametrize(
    ("scene", "count"),
    [
        ("cusps", 200),
        *(
            pytest.param(scene, 1000, marks=pytest.mark.long)
            for scene in ("cusps", "free", "looping", "through_the_pole")
        ),
    ],
)
def test_samples_after_many_pauses_steps_and_changes(scene, count):
    run, chance = start(scene, publish_rate=30.0), random.Random(1)
    for _ in range(count):
        action = chance.randrange(3)
        if action == 0:
            run.ask("pause", True)
            run.ask("step", {"duration": chance.uniform(0.0, 10.0)})
        elif action == 1:
            run.ask("pause", False)
        else:
            run.change({"real_time_factor": 10 ** chance.uniform(-3, 2)})
        run.clock.now += chance.randrange(SECOND)
        run.tick()
    run.ask("pause", False)
    run.advance(0.5, 0.1)
    stamps = sorted(run.sink.messages)
    assert_exact(run, [*stamps[:: len(stamps) // 12], *stamps[-3:]])
