"""A torque of a button is repeated while a page holds it, and no longer."""

import pytest

from symtop_ros.page.panel.held import PERIOD, SILENCE, HeldTorque

TORQUE = (0.0, 0.0, 0.25)


class Clock:
    now = 8.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def held(clock):
    return HeldTorque(clock)


def test_nothing_is_due_before_a_button_is_pressed(held):
    assert held.find_due() == ()


def test_it_is_due_once_in_a_period(held, clock):
    held.take(TORQUE)
    assert held.find_due() == ()  # it was published when it was asked for
    clock.now += PERIOD
    assert held.find_due() == TORQUE
    assert held.find_due() == ()


def test_its_end_ends_it_at_once(held, clock):
    held.take(TORQUE)
    held.take((0.0, 0.0, 0.0))
    clock.now += PERIOD
    assert held.find_due() == ()
    held.renew()
    assert held.find_due() == ()


def test_a_page_that_is_slow_keeps_it_and_one_that_is_gone_does_not(held, clock):
    held.take(TORQUE)
    for _ in range(4):
        clock.now += SILENCE
        assert held.find_due() == TORQUE
        held.renew()
    clock.now += SILENCE + PERIOD
    assert held.find_due() == ()
    held.renew()  # too late
    assert held.find_due() == ()
