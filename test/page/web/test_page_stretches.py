"""The ledger of energy and momentum on the page: record and words of the library's ledger."""

import math

import pytest
from drawn import Numbers
from page.web.page_words import write_as_page
from trials import choose, trials

from symtop_ros.physics import (
    Exchange,
    Friction,
    Ledger,
    Motion,
    Pushes,
    State,
    Top,
    push_axle,
    regular_precession_rates,
)

ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
UNSAID = (
    "Shown if theta has passed two turning points since the last action or push, "
    "and neither friction nor a torque acts."
)
KEPT = "p_phi and p_psi are constant."
FORCES = ("gravity", "friction", "torque", "clamp")


def draw_case(rng):
    """A motion with one of the forces, and a time in ns at which a stretch from its start ends."""
    Ix = rng.power(-5, -2)
    ratio, pull = (
        rng.choice([rng.uniform(0.1, 2), 1.0]),
        rng.choice([1, 1, -1, 0]) * rng.power(1, 3),
    )
    top = Top(Ix, Ix * ratio, Ix * pull)
    rates = {name: rng.uniform(-9, 9) for name in ("theta_dot", "phi_dot")}
    spin = rng.choice([0.0, rng.uniform(-200, 200)])
    start = State.from_euler(theta=rng.uniform(0.05, 3.1), psi_dot=spin, **rates)
    force = rng.choice(FORCES)
    friction = Friction(Ix / 100, Ix / 30) if force == "friction" else Friction()
    torque = (Ix * 3.0, Ix, -Ix * 2.0) if force == "torque" else (0.0, 0.0, 0.0)
    motion = Motion(top, start, friction, torque, clamped=force == "clamp")
    return motion, round(rng.uniform(1e7, 2e9))


def to_case(motion, end):
    Ix, Iz, Mgl = motion.top.moments
    return {
        "top": {"Ix": Ix, "Iz": Iz, "Mgl": Mgl},
        "orientation": motion.start.orientation.tolist(),
        "omega": motion.start.angular_velocity.tolist(),
        "friction": list(motion.friction.coefficients),
        "torque": list(motion.applied_torque),
        "clamped": motion.clamped,
        "end": end,
    }


@pytest.mark.slow
@pytest.mark.parametrize("count", trials(80, 2000))
def test_the_exchange_of_a_stretch_is_that_of_the_library(tab, count):
    """Under friction and a torque the library integrates, and the page takes what is left."""
    rng = Numbers("stretches of the page")
    cases = [draw_case(rng) for _ in range(count)]
    answers = tab.evaluate("findExchanges", [to_case(*each) for each in cases])
    for (motion, end), (found, text) in zip(cases, answers, strict=True):
        wanted = Exchange.from_ledger(Ledger.from_times(motion, 0.0, end / 1e9))
        assert found["kind"] == wanted.kind
        assert found["momenta"]["kind"] == wanted.momenta.kind
        pairs = [*zip(found["shares"], wanted.shares, strict=True)]
        pairs += zip(found["momenta"]["gifts"], wanted.momenta.gifts, strict=True)
        largest = max((each.amount for each in wanted.shares), default=0.0)
        for page, library in pairs:
            assert (page["kind"], page["who"]) == (library.kind, library.who)
            # in a driven motion the states are off by hundreds of eps, and so are all changes
            assert page["amount"] == pytest.approx(library.amount, rel=1e-9, abs=1e-9 * largest)
        assert text == write_as_page("exchange", wanted)


@pytest.mark.parametrize("count", trials(60, 1000))
def test_the_last_two_turning_points_are_those_of_the_library(tab, count):
    rng, cases = Numbers("turning points of the page"), []
    while len(cases) < count:
        motion, end = draw_case(rng)
        low, high = motion.turning_angles
        if not motion.is_driven and high - low > 1e-3 and motion.nutation_period < 1:
            cases.append((motion, end))
    answers = tab.evaluate("findTurns", [to_case(*each) for each in cases])
    for (motion, end), found in zip(cases, answers, strict=True):
        ledger = Ledger.from_turns(motion, end / 1e9)
        half = motion.nutation_period / 2
        if ledger.begin < -2e-9:  # before the start
            assert found is None
            continue
        # the page knows states of whole nanoseconds
        assert found[1] / 1e9 == pytest.approx(ledger.end, rel=0, abs=2e-9)
        assert found[1] - found[0] == pytest.approx(half * 1e9)


@pytest.mark.slow
def test_the_words_are_those_of_the_moment_that_is_shown(open_page):
    page = open_page("#theta=0.5&psi_dot=200&phi_dot=0")
    page.wait_for_time(0.17)
    page.press("Space")
    fall = Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0))
    for time in (0.05, 0.0797, 0.1):
        page.seek(time)
        wanted = f"{Ledger.from_times(fall, 0.0, time)}"
        page.until(lambda wanted=wanted: page.say("stretch-act") == wanted)
        has_turned = time > fall.nutation_period / 2
        turns = "In 0.0798 s the weight gave 6.12 mJ, the precession got 6.12 mJ; " + KEPT
        assert page.say("stretch-turns") == (turns if has_turned else UNSAID)
    page.seek(0.165)
    half = "In 0.0798 s the precession gave 6.12 mJ, the weight got 6.12 mJ; " + KEPT
    page.until(lambda: page.say("stretch-turns") == half)


@pytest.mark.slow
@pytest.mark.parametrize("forces", choose(("axial=1e-6", "torque=0,0,1e-4"), ("axial=1e-6",)))
def test_of_turning_points_that_are_not_looked_for_nothing_is_said(open_page, forces):
    """Under friction and a torque theta turns as well: only the condition is stated."""
    page = open_page(f"#theta=0.5&psi_dot=200&phi_dot=0&{forces}")
    page.wait_for_time(0.4)  # two nutations and a half
    page.until(lambda: page.say("stretch-turns") == UNSAID)


@pytest.mark.slow
def test_a_series_of_pushes_is_told_with_its_first_one(open_page):
    page = open_page("#lesson=13")
    page.tab.click("#lesson-acts button:nth-child(1)")
    page.tab.click("#lesson-acts button:nth-child(2)")
    page.wait_for_time(0.2)
    page.press("Space")
    page.seek(page.read_events()[-1]["time"] + 0.12)  # three pushes
    slow, _ = regular_precession_rates(ARTICLE, 0.5, 200.0)
    start = State.from_euler(theta=0.5, phi_dot=slow, psi_dot=200.0)
    first = push_axle(ARTICLE, start, 5e-5)
    motion = Motion(ARTICLE, first, pushes=Pushes(5e-5, 20.0, 20))
    later = Ledger.from_times(motion, 0.0, 0.12).pushes
    given = later.vertical_momentum + 5e-5 * math.sin(0.5)
    page.until(lambda: f"the pushes gave {given:.3g} N m s to p_phi." in page.say("stretch-act"))
    speeds = (start.euler_rates.phi_dot + first.euler_rates.phi_dot) / 2 * math.sin(0.5)
    work = 1e3 * (later.work + 5e-5 * speeds)
    assert f"the pushes gave {work:.3g} mJ" in page.say("stretch-act")
    page.seek(page.read_events()[-1]["time"] + 0.02)  # back to the first one
    given = 5e-5 * math.sin(0.5)
    page.until(lambda: f"the pushes gave {given:.3g} N m s to p_phi." in page.say("stretch-act"))


@pytest.mark.slow
def test_a_clamp_takes_p_phi_and_no_energy(open_page):
    page = open_page("#theta=0.5&psi_dot=200&phi_dot=0")
    page.press("Space")
    page.press("c")
    page.press("Space")
    began = page.read_events()[-1]["time"]
    page.wait_for_time(began + 0.03)
    page.until(lambda: "the hand at the ring took" in page.say("stretch-act"))
    assert "N m s from p_phi." in page.say("stretch-act")
    assert "the precession" not in page.say("stretch-act")
