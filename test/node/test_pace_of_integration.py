"""A motion that is too fast to be integrated in real time is slowed down and reported."""

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import QuaternionStamped
from node.running_top import LATCHED, assert_recomputed, events_named, facts, stamp_of, status_of

from workshop.load.domains import claim_domain

pytestmark = [pytest.mark.untraced, pytest.mark.realtime]
# a nutation of 5e6 rad/s a hundred times as fast: ten million steps for each second
HOPELESS = {
    "top__Ix": 1e-4,
    "top__Iz": 1e-4,
    "initial__psi_dot": 5e6,
    "friction__transverse": 1e-6,
    "real_time_factor": 100.0,
}
DOMAIN = claim_domain()
MS = 1_000_000


def test_a_motion_too_fast_for_the_budget_is_slowed_down_and_reported(start_top, capfd):
    run = start_top(realtime=True, publish_rate=200.0, **HOPELESS)
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    orientations = run.collect(QuaternionStamped, "/top/orientation")
    diagnostics = run.collect(DiagnosticArray, "/diagnostics")
    run.spin_until(lambda: events_named(events, "pace") and len(orientations) > 60 and diagnostics)
    # the warning is the sentence of the event
    slowed = events_named(events, "pace")[0].status[0]
    assert slowed.message in capfd.readouterr().err
    assert {each.key: each.value for each in slowed.values}["outcome.kind"] == "slowed"
    pace = facts(diagnostics[-1], "top: pace")
    assert float(pace["real_time_factor"]) == 100.0
    assert 0 < float(pace["real_time_factor.achieved"]) < 1.0
    assert status_of(diagnostics[-1], "top: pace").level == DiagnosticStatus.WARN
    # Without a slow-down there would be no other sample. How many of those since then are missed
    # depends on what else the machine does.
    start = stamp_of(events_named(events, "pace")[0])
    run.spin_until(lambda: sum(stamp_of(each) >= start for each in orientations) > 60)
    run.wait_for(diagnostics)
    stamps = np.array([stamp_of(each) for each in orientations])
    assert not (np.diff(stamps) % (5 * MS)).any()
    # What is missing is counted, in the next diagnostics at the latest.
    stamps = stamps[stamps < stamp_of(diagnostics[-2])]
    assert np.ptp(stamps) // (5 * MS) + 1 - len(stamps) <= missed(diagnostics[-1])
    assert_recomputed(events, orientations)


def missed(diagnostics):
    """Return how many ticks a node had missed by then."""
    return int(facts(diagnostics, "top: pace")["missed"])
