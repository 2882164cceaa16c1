"""What is said of a start is said of its symmetric twins, in the same words and with bits that map.

Starts are those of all families, those next to each boundary where a word changes, and those
without weight at all tilts. Twins show what no reference looks at: every fact is asked at once.
"""

from collections.abc import Iterator

import pytest
from drawn import Numbers
from physics.families import DRAWS
from physics.families import draw_motion as draw_of_family
from physics.kernel.exact.test_weightless import DECADES
from physics.kernel.exact.test_weightless import draw_motion as draw_weightless
from physics.rule.test_boundaries import BOUNDARIES, move, unpack
from physics.test_starts import Drawn, draw_question
from physics.twins import TWINS, are_twins, compare, list_facts, map_known, solve_all
from trials import choose

from symtop_ros.physics import State, Top

FEW, MANY = 1, 200  # starts of each kind, in a run of all tests and in the long trial
Start = tuple[Top, State, float]
COUNTS = choose((FEW, MANY), (FEW,))


def list_starts(source: str, count: int) -> Iterator[Start]:
    """Yield starts, and a time for each."""
    rng = Numbers(f"twins {source}")
    for number in range(count):
        if source in DRAWS:
            motion, t = draw_of_family(source, number)
            yield motion.top, motion.start, t
        elif source in BOUNDARIES:
            top, state = unpack(move(rng, BOUNDARIES[source].draw(rng)))
            yield top, state, rng.uniform(0.1, 10.0)
        else:
            motion = draw_weightless(rng, int(source.rsplit(maxsplit=1)[-1]))
            yield motion.top, motion.start, rng.uniform(0.1, 10.0)


SOURCES = [
    *DRAWS,
    *(name for name in BOUNDARIES if name != "the least energy"),  # of constants, not of a start
    *(f"weightless, tilt 1e {decade}" for decade in DECADES),
]


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("source", SOURCES)
def test_whatever_is_said_of_a_start_is_said_of_its_twins(source, count):
    for top, state, t in list_starts(source, count):
        facts = list_facts(top, state, t)
        assert len(facts) > 80
        for name, twin in TWINS.items():
            others = list_facts(twin.of_top(top), twin.of_state(state), twin.of_time(t))
            assert not list(compare(twin, facts, others)), (name, top, state)


@pytest.mark.parametrize("count", choose((20, 1000), (20,)))
def test_starts_from_what_is_seen_have_twins(count):
    for seed in range(count):
        one = Drawn(50_000 + seed)
        known, _ = draw_question(one)
        starts = solve_all(one.top, known)
        for name, twin in TWINS.items():
            if twin.is_over and "theta" in known:
                continue  # pi - theta is not exact
            others = solve_all(twin.of_top(one.top), map_known(twin, known))
            assert are_twins(twin, starts, others), (name, one.top, known, starts, others)


def test_a_fact_that_is_no_twin_is_noticed():
    top, state, t = next(list_starts("generic", 1))
    facts = list_facts(top, state, t)
    mirrored = TWINS["mirrored"]
    assert {name for name, *_ in compare(mirrored, facts, facts)} >= {
        "motion.mean_precession_rate",
        "motion.mean_spin_rate",
        "orientation",
    }
