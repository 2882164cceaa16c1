"""The lock of a run."""

import threading
from contextlib import suppress

from waiting import until

from symtop_ros.run.simulation.turns import Turns


def test_who_has_the_lock_sees_that_a_turn_waits_and_no_longer_when_it_has_had_it():
    turns = Turns()
    taken = threading.Event()

    def take():
        with turns:
            taken.set()

    other = threading.Thread(target=take)
    with turns.lock:
        assert not turns.is_awaited
        other.start()
        until(lambda: turns.is_awaited)
        assert not taken.is_set()
    other.join()
    assert taken.is_set()
    assert not turns.is_awaited


def test_a_turn_in_a_turn_does_not_wait_and_after_a_failure_another_gets_its_own():
    turns = Turns()
    with suppress(KeyError), turns, turns:
        raise KeyError
    taken = []
    other = threading.Thread(target=lambda: taken.append(turns.lock.acquire(timeout=10.0)))
    other.start()
    other.join()
    assert taken == [True]
