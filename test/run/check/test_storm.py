"""Random loops and resets of the clock, steps, rates, pauses and recordings: every log is sound."""

import pytest
from drawn import Numbers
from run.log.damaged import SECOND, Log, Recorded
from trials import seeds

from symtop_ros.base.refusals import RefusedError
from symtop_ros.replay.main import main
from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.top_log import TopLog

ACTS = 14
LOOP = 20.0  # s, at which the clock of a bag that is played again and again begins


def jump(rng, recorded):
    """Set the clock: to the begin of a loop, to 0, back a little or far, or forth."""
    now = recorded.clock.now / SECOND
    times = LOOP, 0.0, now - rng.uniform(0.01, 3.0), now + rng.uniform(1.5, 9.0)
    recorded.jump(max(0.0, rng.choice(times)))


def set_back(rng, recorded):
    """Set the clock of the system: no notice is given; a step forward is time that was missed."""
    recorded.clock.now += round(rng.choice((-60.0, -5.0, -1.5, 3.0)) * SECOND)
    recorded.clock.now = max(0, recorded.clock.now)


def change(rng, recorded):
    values = {
        "publish_rate": rng.choice((30.0, 100.0, 300.0)),
        "real_time_factor": rng.choice((0.5, 1.0, 2.0)),
        "top.Mgl": rng.uniform(0.05, 0.08),
        "publish_tf": rng.random() < 0.5,
    }
    name = rng.choice(sorted(values))
    try:
        recorded.session.apply_settings({name: values[name]})
    except RefusedError:
        return


def ask(rng, recorded):
    service, value = {
        "kick": ("kick", {"precession_rate_factor": rng.uniform(0.5, 1.5)}),
        "push": ("kick", {"axle_impulse": rng.uniform(-1e-5, 1e-5), "rate": 50.0, "number": 20}),
        "release": ("release", None),
        "pause": ("pause", recorded.session.simulation.segment.running),
        "step": ("step", {"duration": rng.uniform(0.0, 0.3)}),
        "reset": ("reset", None),
        "start": ("set_initial_conditions", {"theta": rng.uniform(0.1, 1.0), "psi_dot": 150.0}),
    }[rng.choice(("kick", "push", "release", "pause", "pause", "step", "reset", "start"))]
    recorded.session.answer(service, lambda: value)  # what is refused changes nothing


def switch(rng, recorded):
    """Record, or do not."""
    recorded.session.answer("record", lambda: recorded.session.recording.path is None)


def storm(rng, folder):
    """Record a run at random; return the folder with its files."""
    is_own, is_real = rng.random() < 0.2, rng.random() < 0.3
    limits = {"record__max_duration": 0.7} if rng.random() < 0.3 else {}
    recorded = Recorded(folder, publish_clock=is_own, **limits)
    recorded.clock.is_simulated = not (is_own or is_real)
    move = set_back if is_real else jump
    acts = [ask, ask, change, switch, *([] if is_own else [move, move])]
    for _ in range(ACTS):
        recorded.run(rng.randint(1, 900) / 1024)
        rng.choice(acts)(rng, recorded)
    recorded.run(0.2)
    if recorded.session.recording.path is None:
        switch(rng, recorded)
        recorded.run(0.2)
    recorded.close()
    return folder


def stop(rng, recorded):
    """Let the process lack time, after which a request or the diagnostics may come first."""
    recorded.clock.now += round(rng.choice((0.05, 0.2, 0.7, 1.5, 3.0)) * SECOND)
    if rng.random() < 0.3:
        recorded.session.keep_up()


def push(rng, recorded):
    recorded.session.hold_torque([rng.uniform(-1e-3, 1e-3) for _ in range(3)])


@pytest.mark.parametrize("seed", seeds(6, 300))
def test_a_log_of_a_busy_machine_with_acts_in_quick_succession_is_sound(seed, tmp_path):
    rng = Numbers(seed)
    recorded = Recorded(tmp_path, publish_clock=rng.random() < 0.5)
    recorded.clock.is_simulated = False
    for _ in range(ACTS):
        recorded.run(rng.randint(1, 400) / 1024)
        for _ in range(rng.randint(1, 3)):
            rng.choice((ask, change, push, stop, stop))(rng, recorded)
    recorded.run(0.2)
    assert_sound(recorded)


def assert_sound(recorded):
    log = TopLog(open_run(recorded.close()))
    assert (log.catalog.problems, log.catalog.doubts) == ((), ())
    found = check_run(log)
    assert found.samples_agree
    assert (found.mismatches, found.unjudged) == ([], 0)


@pytest.mark.parametrize("is_changed", [False, True])
def test_acts_within_one_period_leave_no_sample_missing(is_changed, tmp_path):
    recorded = Recorded(tmp_path, publish_clock=True)
    recorded.clock.is_simulated = False
    recorded.run(0.5)
    recorded.kick()  # which acts with the next sample
    recorded.ask("pause", True)
    if is_changed:
        recorded.session.apply_settings({"publish_rate": 30.0})
    recorded.ask("pause", False)
    if is_changed:
        recorded.session.apply_settings({"publish_rate": 100.0})
    recorded.run(0.3)
    assert_sound(recorded)


@pytest.mark.parametrize("seed", seeds(6, 300))
def test_a_log_of_a_storm_is_sound(seed, tmp_path, capsys):
    folder = storm(Numbers(seed), tmp_path)
    status = main([str(folder), "--check", "--strict"])
    out, err = capsys.readouterr()
    said = [line for line in err.splitlines() if not line.endswith("the recording was off")]
    assert (status, said) == (0, [])
    assert "not compared: the motion is not known" not in out


@pytest.mark.parametrize("seed", seeds(3, 100))
def test_samples_lost_in_a_storm_make_no_others_false(seed, tmp_path, capsys):
    rng = Numbers(seed)
    path = rng.choice(sorted(storm(rng, tmp_path).glob("*.mcap")))
    log = Log.read(path)
    begin = rng.randrange(len(log.messages))
    path.unlink()
    log.without(range(begin, begin + rng.randint(20, 500))).write(path)  # events among them
    main([str(tmp_path), "--check"])
    assert "DO NOT agree" not in capsys.readouterr().out
