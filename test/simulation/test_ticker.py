"""The grid of stamps, without a clock."""

from fractions import Fraction

from symtop_ros.simulation.block import CATCH_UP, Ticker

MS = 1_000_000
NEVER = 2**62


def due(ticker, now, until=NEVER):
    return ticker.due(now, CATCH_UP, until)


def test_stamps_are_on_the_grid_however_late_the_timer_is():
    ticker = Ticker(1000.0, 0)
    assert due(ticker, 0) == [0]
    assert due(ticker, int(2.5 * MS)) == [MS, 2 * MS]
    assert due(ticker, int(2.9 * MS)) == []
    assert due(ticker, 3 * MS) == [3 * MS]
    assert ticker.late == 1  # the tick of 1 ms, published at 2.5 ms
    assert ticker.missed == 0


def test_after_a_long_stop_there_is_no_burst_and_missed_ticks_are_counted():
    ticker = Ticker(1000.0, 0)
    due(ticker, 0)
    stamps = due(ticker, 5_000 * MS)
    assert stamps == [k * MS for k in range(4900, 5001)]
    assert ticker.missed == 4899


def test_a_clock_that_is_set_back_a_little_is_waited_for():
    ticker = Ticker(100.0, 1_000 * MS)
    assert due(ticker, 1_000 * MS) == [1_000 * MS]
    assert due(ticker, 950 * MS) == []
    assert due(ticker, 1_010 * MS) == [1_010 * MS]


def test_the_thousandth_tick_of_an_odd_rate_is_where_it_should_be():
    ticker = Ticker(333.0, 7)
    last = [stamp for second in range(1, 61) for stamp in due(ticker, 7 + second * 1_000 * MS)][-1]
    assert last == 7 + 60_000 * MS
    assert ticker.next_stamp == 7 + round(19981 * 1e9 / 333)


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
