"""Stamps and samples in blocks, and the compute budget, whose clock advances when it is read."""

import random
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from log_files import ARTICLE, BEGIN, CUSPS
from physics.tops import FAMILIES, precess, random_case
from run.simulation.runs import SECOND

from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.run.simulation.block import CATCH_UP, Block, Blocks, Ticker
from symtop_ros.run.simulation.budget import (
    READY,
    STEPS_AT_ONCE,
    ComputeBudget,
    Progress,
    StepBudget,
)
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.sensor.imu import Imu, Magnetometer, Rig
from symtop_ros.run.simulation.topics import SAMPLE_TOPICS, STATE_TOPICS, Samples

pytestmark = pytest.mark.numbers

STAMPS = [BEGIN + 1_000_003 * k for k in range(16)]
MOTION = Motion(ARTICLE, CUSPS)
NOISES = 2e-3, 3e-4, 0.02, 0.005
FIELD = Magnetometer((1e-5, 2e-5, -4e-5), 6e-8, 1e-9, seed=12)
MOUNT = (0.01, -0.02, 0.05), (0.5, 0.5, 0.5, 0.5)
RIG = Rig(9.81, Imu(*MOUNT, *NOISES, seed=11, rate=400.0, magnetometer=FIELD))
SEGMENTS = {
    "closed form": Segment.begin(MOTION, BEGIN, 0.7, RIG),
    "taylor": Segment.begin(Motion(ARTICLE, CUSPS, Friction(1e-6, 1e-5)), BEGIN, 0.7, RIG),
    "paused": Segment.begin(MOTION, BEGIN - 10**9, 0.7, RIG).pause(BEGIN),
}


LAYOUTS = {name: topic.layout("world", "top") for name, topic in SAMPLE_TOPICS.items()}


def make(segment, stamps, due=()):
    return Block(segment, stamps, lambda name, *given: LAYOUTS[name].encode_many(*given), due)


@pytest.mark.parametrize("segment", SEGMENTS.values(), ids=SEGMENTS)
@pytest.mark.parametrize(("count", "topics"), [(4, SAMPLE_TOPICS), (5000, STATE_TOPICS)])
def test_samples_are_those_of_each_stamp_alone_bit_for_bit(segment, count, topics):
    stamps = [BEGIN + 1_000_003 * k for k in range(count)]
    block = make(segment, stamps)
    for stamp in stamps[:: 1 + count // 100]:
        alone = Samples.at(segment, stamp)
        for name, topic in topics.items():
            expected = topic.compute(alone).tolist()
            assert block.numbers(name, stamp) == expected
            assert block.message(name, stamp) == LAYOUTS[name].encode(stamp, expected)


def test_it_covers_its_segment_and_stamps_only():
    segment, other = SEGMENTS["closed form"], SEGMENTS["taylor"]
    block = make(segment, STAMPS)
    assert block.covers(segment, STAMPS[0])
    assert not block.covers(segment, STAMPS[0] + 1)
    assert not block.covers(other, STAMPS[0])
    assert not make(segment, []).covers(segment, STAMPS[0])


@pytest.mark.parametrize("segment", SEGMENTS.values(), ids=SEGMENTS)
def test_a_state_has_the_same_bits_whether_a_block_has_it(segment):
    blocks = Blocks(segment, lambda name, *given: LAYOUTS[name].encode_many(*given))
    steps = [
        lambda: blocks.begin(segment, STAMPS[:8]),
        lambda: blocks.current.message("torque", STAMPS[0]),  # the states of this one, and
        lambda: blocks.begin_later(segment, STAMPS[8:]),
        blocks.work_on_later,  # of the next
        lambda: blocks.begin(segment, STAMPS[:1]),
        lambda: blocks.current.message("torque", STAMPS[0]),
    ]
    for step in steps:
        step()
        for stamp in STAMPS:
            assert blocks.state_at(segment, stamp) == segment.state_at(stamp)
    other = SEGMENTS["paused"].change(BEGIN, precess(3.0))  # no block is of it
    assert blocks.state_at(other, STAMPS[0]) == other.state_at(STAMPS[0])


@pytest.mark.parametrize("family", FAMILIES)
def test_the_first_state_is_that_of_the_exact_time_zero(family):
    for seed in range(20):
        case = random_case(seed, family)
        segment = Segment.begin(Motion(case.top, case.start), BEGIN, 1 / 3)
        exact = segment.motion.at(segment.times_at(BEGIN))
        many = segment.state_at(np.array([BEGIN, BEGIN + 1]))
        assert segment.state_at(BEGIN) == exact == many[0]


@pytest.fixture
def computed(monkeypatch):
    """Names of the topics that are computed, in their order."""
    names = []
    for name, topic in STATE_TOPICS.items():
        compute = topic.compute
        spy = replace(topic, compute=lambda *a, n=name, f=compute: names.append(n) or f(*a))
        monkeypatch.setitem(SAMPLE_TOPICS, name, spy)
    return names


def test_a_topic_that_is_not_requested_is_not_computed(computed):
    block = make(SEGMENTS["closed form"], STAMPS)
    for stamp in STAMPS:
        assert block.message("torque", stamp)
    assert computed == ["torque"]
    after = make(SEGMENTS["taylor"], STAMPS, block.requested)
    after.finish()
    assert computed == ["torque", "torque"]
    after.message("torque", STAMPS[0])
    assert computed == ["torque", "torque"]


def test_what_is_due_is_computed_in_pieces(computed):
    segment = SEGMENTS["closed form"]
    block = make(segment, STAMPS, STATE_TOPICS)
    assert block.work()  # the states
    block.message("torque", STAMPS[0])  # of a late tick
    for count in range(2, len(STATE_TOPICS) + 1):
        assert block.work()
        assert len(computed) == count
    assert not block.work()
    assert sorted(computed) == sorted(STATE_TOPICS)
    for name in STATE_TOPICS:
        assert block.message(name, STAMPS[3]) == make(segment, STAMPS).message(name, STAMPS[3])


MS = 1_000_000
NEVER = 2**62


def due(ticker, now, until=NEVER):
    return [*ticker.due(now, CATCH_UP, until)]


LATE_TICKS = [
    # the tick of 1 ms is published at 2.5 ms
    (1000.0, 0, [(0, [0]), (2.5, [1, 2]), (2.9, []), (3, [3])], 1, 0),
    # after a long stop there is no long burst
    (1000.0, 0, [(0, [0]), (5000, range(4500, 5001))], None, 4499),
    # a clock that is set back a little is waited for
    (100.0, 1000, [(1000, [1000]), (950, []), (1010, [1010])], 0, 0),
]


@pytest.mark.parametrize(("rate", "begin", "ticks", "late", "missed"), LATE_TICKS)
def test_stamps_are_on_the_grid_however_late_the_timer_is(rate, begin, ticks, late, missed):
    ticker = Ticker(rate, begin * MS)
    for now, stamps in ticks:
        assert due(ticker, int(now * MS)) == [each * MS for each in stamps]
    assert late in (None, ticker.late)
    assert ticker.missed == missed


@pytest.mark.parametrize("rate", [30.0, 777.7, 1000.0])
def test_each_stamp_is_due_at_its_own_nanosecond(rate):
    """Its tick may be a fraction of a nanosecond later, at which a clock may stand still."""
    ticker = Ticker(rate, 7)
    for _ in range(100):
        stamp = ticker.next_stamp
        assert due(ticker, stamp - 1) == []
        assert due(ticker, stamp) == [stamp]


def test_the_grid_continues_from_any_of_its_stamps():
    ticker = Ticker(333.0, 7)
    stamps = due(ticker, 7 + 1_000 * MS)
    assert ticker.grid(stamps[5], 20) == stamps[5:25]
    assert ticker.grid(ticker.next_stamp, 1) == [ticker.next_stamp]


def test_no_stamp_is_due_after_the_last_prepared_one():
    ticker = Ticker(1000.0, 0)
    assert due(ticker, 5 * MS, until=2 * MS) == [0, MS, 2 * MS]
    assert due(ticker, 5 * MS, until=2 * MS) == []
    assert due(ticker, 5 * MS) == [3 * MS, 4 * MS, 5 * MS]


def test_after_a_year_each_stamp_is_still_the_nearest_nanosecond():
    rate = 7.0
    ticker = Ticker(rate, 0)
    year = 365 * 86_400 * 1_000 * MS
    stamp = due(ticker, year)[-1]
    k = round(Fraction(stamp) * Fraction(rate) / 10**9)
    assert abs(Fraction(stamp) - k * 10**9 / Fraction(rate)) <= Fraction(1, 2)
    assert ticker.grid(stamp, 2)[1] == ticker.next_stamp


TOP = Top(1e-3, 1e-3, 1.0)
START = State.from_euler(theta=1.0, psi_dot=1e4)


def fast():
    """A motion that takes some thousand steps a second."""
    return Motion(TOP, START, Friction(transverse=1e-3))


class Clock:
    """Advances by some seconds whenever it is read."""

    def __init__(self, each):
        self.time = 0.0
        self.each = each

    def __call__(self):
        self.time += self.each
        return self.time


def prepare(budget, segment, stamp):
    """Return the number of calls until the state is ready or a shortfall is found, and which."""
    turns = 1
    while not (progress := budget.prepare(segment, stamp)).ready and not progress.shortfall:
        turns += 1
    return turns, progress


@pytest.mark.parametrize(
    "segment",
    [Segment.begin(Motion(TOP, START), 0, 100.0), Segment.begin(fast(), 0, 1.0).pause(0)],
    ids=["the closed form", "a pause"],
)
def test_what_needs_no_integration_takes_one_call_for_any_time(segment):
    budget = ComputeBudget(Clock(0.001))
    assert prepare(budget, segment, 10**6 * SECOND) == (1, READY)


def test_a_stretch_that_lasts_longer_than_its_work_is_prepared_in_many_calls():
    budget = ComputeBudget(Clock(0.001))
    turns, progress = prepare(budget, Segment.begin(fast(), 0, 1.0), SECOND)
    assert turns > 10
    assert progress == READY
    assert budget.spent == pytest.approx(0.001 * turns)


def test_a_stretch_that_takes_longer_than_it_lasts_gives_a_factor_that_can_be_kept():
    each = 0.1  # s for a turn
    budget = ComputeBudget(Clock(each))
    turns, progress = prepare(budget, Segment.begin(fast(), 0, 1.0), SECOND)
    assert turns == 11  # the first with which it takes more than the second
    reached, factor, lack = progress.shortfall
    assert lack is None
    assert reached == fast()._reach(1.0, turns * STEPS_AT_ONCE)
    # a quarter of one core
    assert factor == pytest.approx(0.25 * (reached - fast()._reach(1.0, 0)) / (turns * each))


def test_the_factor_of_a_shortfall_can_be_kept():
    budget = ComputeBudget(Clock(0.1))
    segment = Segment.begin(fast(), 0, 1.0)
    _, progress = prepare(budget, segment, SECOND)
    slower = segment.slow_down(*progress.shortfall[:2], SECOND)
    assert prepare(budget, slower, 2 * SECOND)[1] == READY


def test_after_a_long_stop_the_missed_stretch_may_take_as_long_as_it_lasts():
    budget = ComputeBudget(Clock(0.002))  # a tenth of the work that any stretch may take
    segment = Segment.begin(fast(), 0, 1.0)
    prepare(budget, segment, SECOND // 100)
    assert prepare(budget, segment, 5 * SECOND)[1] == READY


def test_a_state_that_is_asked_for_in_between_does_not_make_the_factor_negative():
    budget = ComputeBudget(Clock(0.1))
    motion = fast()
    segment = Segment.begin(motion, 0, 1.0)
    while not (progress := budget.prepare(segment, SECOND)).shortfall:
        assert not progress.ready
        motion.at(0.0)  # moves the integration back to its start
    assert progress.shortfall.factor > 0


class Machine:
    """A processor of which a thread gets a share: CPU time and real time of a budget."""

    def __init__(self, share, work):
        self.share, self.work = share, work  # of one core, and s of CPU time for a call
        self.cpu = self.real = 0.0
        self.is_working = True

    def read_cpu(self):
        """A budget asks before a call and after it."""
        self.is_working = not self.is_working
        if self.is_working:
            self.cpu += self.work
            self.real += self.work / self.share
        return self.cpu

    def read_real(self):
        return self.real


def follow(machine, seconds, step=0.02, **options):
    """Follow a motion in real time; return the first shortfall and when it was found, or None."""
    budget = ComputeBudget(machine.read_cpu, machine.read_real)
    segment = Segment.begin(fast(), 0, 1.0)
    while machine.real < seconds:
        stamp = int((machine.real + step) * SECOND)
        while not (progress := budget.prepare(segment, stamp, **options)).ready:
            if progress.shortfall:
                return progress.shortfall, machine.real
    return None


def measure_need():
    """Return how many calls a second of the motion takes."""
    return prepare(ComputeBudget(Clock(0.0)), Segment.begin(fast(), 0, 1.0), SECOND)[0]


def test_a_motion_that_gets_a_tenth_of_a_core_and_needs_a_third_lacks_cpu_time():
    work = 0.3 / measure_need()
    (_, factor, lack), _ = follow(Machine(0.1, work), 20.0)
    assert lack.got == pytest.approx(10, rel=0.2)  # of windows that end with a call
    assert lack.needed == pytest.approx(30, rel=0.3)  # fewer steps later, as friction slows it
    assert factor == pytest.approx(0.5 * lack.got / lack.needed)


def test_on_a_machine_as_busy_that_gives_what_it_needs_a_motion_keeps_its_pace():
    work = 0.05 / measure_need()
    assert follow(Machine(0.1, work), 5.0) is None


def test_stamps_that_do_not_follow_the_real_time_have_no_shortfall_of_it():
    work = 0.3 / measure_need()
    assert follow(Machine(0.1, work), 20.0, is_timed=False) is None


def test_a_stop_of_the_process_is_caught_up_and_no_lack():
    machine = Machine(1.0, 0.3 / measure_need())
    budget = ComputeBudget(machine.read_cpu, machine.read_real)
    segment = Segment.begin(fast(), 0, 1.0)
    assert prepare(budget, segment, SECOND // 10)[1] == READY
    assert not budget.prepare(segment, 4 * SECOND).ready
    machine.real += 3.0
    assert prepare(budget, segment, 4 * SECOND)[1] == READY


@pytest.mark.parametrize(("count", "is_reached"), [(10, False), (100, True)])
def test_a_log_may_take_steps_for_each_of_its_samples(count, is_reached):
    stamps = np.array([SECOND * k // count for k in range(1, count + 1)])  # 5100 steps in all
    assert StepBudget().reach_stamps(Segment.begin(fast(), 0, 1.0), stamps) == is_reached


def test_a_motion_that_comes_to_its_last_state_is_stopped_there():
    motion = Motion(Top(1e-3, 1e-3, 1.0), State.from_euler(theta=1.0, psi_dot=1e12))
    segment = Segment.begin(motion, 0, 1.0)
    budget = ComputeBudget()
    last = int(segment.last_stamp)
    assert 0 < last * 1e-9 < motion.farthest_time
    assert budget.prepare(segment, last) == READY
    assert budget.prepare(segment, last + SECOND) == Progress(False, end=segment.time_at(last))
    assert segment.state_at(last) == motion.at(segment.times_at(last))


def test_the_last_stamp_of_a_segment_has_a_state_and_lies_within_its_margin():
    draws = random.Random(31)
    for _ in range(300):
        spin = draws.randrange(-(2**53), 2**53) / 2.0 ** draws.randrange(-20, 53)
        motion = Motion(Top(1e-3, 1e-3, draws.choice((-1.0, 0.0, 1.0))), spinning(spin))
        factor = draws.randrange(1, 2**20) / 2.0 ** draws.randrange(40)
        begin = Fraction(motion.farthest_time) * draws.randrange(2**10) / 2**10 * SECOND
        stamp = draws.randrange(2**61)
        segment = Segment(motion, stamp, begin, factor, running=True)
        last = min(int(segment.last_stamp), 2**62)
        duration = Fraction(motion.farthest_time) / Fraction(factor) * SECOND
        exact = stamp + duration - begin / Fraction(factor)
        assert last < exact
        # twice what is left for rounding, and the nanosecond that is not whole
        assert last > min(exact, 2**62) - duration / 2**39 - 1
        assert segment.state_at(last) is not None


def spinning(spin: float) -> State:
    """Return a tilted top at rest but for its spin (rad/s)."""
    return State((0.8, 0.6, 0.0, 0.0), (0.0, 0.0, spin))
