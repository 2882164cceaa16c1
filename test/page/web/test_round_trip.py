"""Round through all that keeps a run: every kind of kick, coefficient, field of a start, parameter.

What there is, is found from its definitions: the header of the kernel, the fields of a run, and
the parameters. So nothing is added here when one of them grows, and what one of the places does not
know fails: node, event, log, check, run.json, replay, page, link, and page again.
"""

import json
from dataclasses import asdict, fields
from functools import partial
from itertools import pairwise

import numpy as np
import pytest
from page.web.modules import load_kernel, open_tab
from physics.tops import ARTICLE, CUSPS
from run.session.test_outputs import Program, advance, start
from run.session.test_random_sessions import check, drop_idle, is_near, list_exact

from symtop_ros.physics import HOLDS, Friction, Motion, balance
from symtop_ros.physics.arguments import read_start
from symtop_ros.physics.kernel.records import FRICTION_KINDS, KICK_KINDS, StartRecord
from symtop_ros.physics.reference import exact_state
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.session.run_log import write_run_log
from symtop_ros.run.simulation.changes.requests import FIELDS, KINDS
from symtop_ros.run.simulation.fields import TABLE
from symtop_ros.run.simulation.run_file import read_run, record_run, write_run
from symtop_ros.run.simulation.settings import PARAMETERS

STEP = 1 / 64  # s between two acts
COEFFICIENTS = {name: (k + 1) * 2.0**-20 for k, name in enumerate(FRICTION_KINDS)}
WANTED = {"mass": 0.5}  # kg; a lighter one no body of the top has
NOT_DRAWN = ("record.", "publish_clock", "real_time_priority")  # of the process, not of the motion


def list_kicks():
    """Every kind of kick, with every hold that may be chosen for it, as a request."""
    for k, (name, field) in enumerate((name, FIELDS[name]) for name in KINDS):
        amount = (k + 1.25) / 2 if field["unit"] in ("", "rad/s") else (k + 1) * 2.0**-18
        request = {name: [amount] * field["size"] if "size" in field else amount}
        chosen = field["holds"] == "chosen"
        yield from ({**request, "hold": hold} for hold in HOLDS) if chosen else (request,)


def draw_value(name):
    """Another value of a parameter than its default; None if it has a list or a word."""
    given, limits = PARAMETERS[name].default, PARAMETERS[name].limits
    if isinstance(given, bool):
        return not given
    if limits is None:
        return None
    wanted = given * 1.25 or WANTED.get(name, 2.0**-12)
    return type(given)(min(max(wanted, limits[0]), limits[1]))


def list_changes():
    """The parameters that can be changed while the top moves, each with another value."""
    names = [name for name, each in PARAMETERS.items() if not each.read_only]
    names = [name for name in names if not name.startswith(NOT_DRAWN)]
    return {name: value for name in names if (value := draw_value(name)) is not None}


@pytest.fixture(scope="module", name="told")
def _told(tmp_path_factory):
    """A session that is asked for everything; its motions after each act, and its log."""
    folder = tmp_path_factory.mktemp("log")
    session, clock = start(
        Program(), "cusps", record__enabled=True, record__directory=str(folder), publish_rate=100.0
    )
    motions = [session.simulation.segment.motion]

    def act(do):
        advance(session, clock, STEP)
        do()
        if session.simulation.segment.motion is not motions[-1]:
            motions.append(session.simulation.segment.motion)

    def ask(service, value=None):
        granted, answer = session.answer(service, lambda: value)
        assert granted, (service, value, answer)

    for kick in list_kicks():
        act(partial(ask, "kick", kick))
    act(partial(ask, "kick", {"axle_impulse": 2.0**-18, "rate": 200.0, "number": 9}))
    act(partial(ask, "release"))
    changes = list_changes()
    assert {f"friction.{name}" for name in FRICTION_KINDS} <= changes.keys()
    for name, value in changes.items():
        act(partial(session.apply_settings, {name: value}))
    act(partial(session.apply_settings, {"steady_torque": [2.0**-14, 2.0**-13, -(2.0**-14)]}))
    act(partial(ask, "kick", next(list_kicks())))
    act(partial(ask, "kick", {"axle_impulse": 2.0**-18, "rate": 200.0, "number": 2}))
    advance(session, clock, 0.1)
    state = json.loads(session.answer("get_state", lambda: None)[1])
    path = session.recording.path
    stamp = session.simulation.last
    values = session.simulation.settings.values
    session.close()
    return motions, path, stamp, values, changes, state


@pytest.fixture(scope="module", name="run")
def _run(told):
    _, path, stamp, *_ = told
    return record_run(check(path), stamp)


def pack(motion):
    """All numbers of a motion."""
    pushes = motion.pushes.packed if motion.pushes else b""
    return motion._packed_start + pushes


def test_every_kind_of_kick_of_the_kernel_can_be_asked_for():
    assert {FIELDS[name]["kick"] for name in KINDS} == {*KICK_KINDS}
    assert {field["holds"] for field in map(FIELDS.get, KINDS)} <= {"chosen", None, *HOLDS}


def test_every_coefficient_is_that_of_a_friction_and_a_parameter():
    assert tuple(each.name for each in fields(Friction)) == FRICTION_KINDS
    assert {f"friction.{name}" for name in FRICTION_KINDS} <= PARAMETERS.keys()


def test_every_number_of_a_start_is_one_of_a_motion_and_has_its_field_in_a_run():
    numbers = sum(getattr(kind, "_length_", 1) for _, kind in StartRecord._fields_)
    row = np.frombuffer(Motion(ARTICLE, CUSPS)._packed_start).copy()
    assert len(row) == numbers
    row[10:] = 2.0**-20 * np.arange(1, numbers - 9)  # after the state: what acts on the top
    assert Motion(*read_start(row))._packed_start == row.tobytes()
    sizes = [field["size"] for name, field in TABLE["event"].items() if "size" in field]
    assert sum(sizes) == numbers


@pytest.mark.parametrize("name", FRICTION_KINDS)
def test_a_coefficient_acts_in_the_kernel_the_reference_and_the_torque(name):
    friction = Friction(**{name: 2.0**-19})
    motion = Motion(ARTICLE, CUSPS, friction)
    state = motion.at(0.5)
    free = Motion(ARTICLE, CUSPS).at(0.5)
    found = exact_state(ARTICLE, CUSPS, 0.5, friction=friction, digits=20)
    rates = np.array([float(each) for each in found.angular_velocity])
    # far above the rounding of 0.5 s, and below the least change of a rate by a coefficient
    assert np.abs(state.angular_velocity - rates).max() < 1e-9
    assert np.abs(state.angular_velocity - free.angular_velocity).max() > 1e-6
    assert abs(balance(motion, 0.5, 0.1).energy) < 1e-12 * ARTICLE.energy(CUSPS)


def test_the_node_says_all_numbers_of_its_motion(told):
    motions, _, _, values, changes, state = told
    assert (*state["friction"].values(),) == motions[-1].friction.coefficients
    assert {name: values[name] for name in changes} == changes
    assert {name for name, value in changes.items() if value == PARAMETERS[name].default} == set()


def test_the_log_has_every_motion_and_every_request(told):
    motions, path, _, _, changes, _ = told
    events = check(path)
    packed = [pack(event.segment().motion) for event in events]
    assert [each for k, each in enumerate(packed) if each not in packed[:k]] == [
        *map(pack, motions)
    ]
    asked = {name for event in events if event.name == "parameters" for name in event.request}
    assert asked == {*changes, "steady_torque"}
    kicked = [event.request for event in events if event.name == "kick"]
    wanted = [*list_kicks(), next(list_kicks())]
    assert [each.keys() for each in kicked] == [each.keys() for each in wanted]
    metadata = open_run([path]).metadata["symtop_ros"]
    assert {f"parameter.{name}" for name in PARAMETERS} <= metadata.keys()


def test_a_kick_holds_what_it_says(told):
    """Of theta', psi' and the spin momentum, by the states of the events themselves."""
    for event in check(told[1]):
        if event.name not in ("kick", "push"):
            continue
        before, after = event.state_before(), event.state()
        hold = getattr(event.outcome(), "hold", "spin_momentum")
        size = 1e-9  # far above the rounding of rates below 1e3 rad/s
        if hold is None:
            continue
        assert abs(before.euler_rates.theta_dot - after.euler_rates.theta_dot) < size
        if hold == "spin_momentum":
            assert before.angular_velocity[2] == after.angular_velocity[2]
        else:
            assert abs(before.euler_rates.psi_dot - after.euler_rates.psi_dot) < size
            assert before.angular_velocity[2] != after.angular_velocity[2]


def test_run_json_and_its_replay_have_every_motion_and_every_kick(told, run, tmp_path):
    motions, *_ = told
    events, end = run
    # A release is no event of a run: its pushes have the number that were given.
    is_released = [now.start == after.start for now, after in pairwise(motions)]
    ended = [
        each for each, is_cut in zip(motions, [*is_released, False], strict=True) if not is_cut
    ]
    assert [pack(event.motion) for event in events] == [pack(each) for each in ended]
    assert sum(is_released) == 1
    path, again = tmp_path / "run.json", tmp_path / "again.mcap"
    path.write_text(json.dumps(write_run(events, end)))
    read, reached, _ = read_run(path)
    assert [pack(each.motion) for each in read] == [pack(each.motion) for each in events]
    assert json.dumps([each.act for each in read]) == json.dumps([each.act for each in events])
    write_run_log(read, reached, again, rate=50.0)
    repeated, _ = record_run(check(again), reached)
    for given, found in zip(drop_idle(read), repeated, strict=True):
        assert list_exact(found) == list_exact(given)
        assert is_near(found.motion.start, given.motion.start)


@pytest.mark.slow
def test_the_page_and_its_links_have_every_motion_and_every_kick(run, opened, open_page):
    events, _ = run
    other = open_page()
    sizes = [name for name, field in TABLE["event"].items() if "size" in field]
    for count, event in enumerate(events, start=1):
        content = json.loads(json.dumps(write_run(events[:count], event.time)))
        opened.drop(content)
        opened.until(lambda wanted=content: opened.read_run() == wanted or opened.say("refusal"))
        assert opened.say("refusal") == ""
        other.follow("#" + opened.tab.input_value("#link").split("#")[1])
        given = content["events"][-1]
        started = other.read_events()[-1]
        assert {name: started[name] for name in sizes} == {name: given[name] for name in sizes}


@pytest.mark.slow
def test_a_field_of_the_page_sets_its_own_coefficient(opened):
    for name, value in COEFFICIENTS.items():
        assert opened.tab.locator(f"[id='field-friction.{name}']").count() == 1
        before = opened.read_events()[-1]["friction"]
        opened.enter(f"friction.{name}", repr(value))
        after = dict(zip(FRICTION_KINDS, opened.read_events()[-1]["friction"], strict=True))
        assert after == {**dict(zip(FRICTION_KINDS, before, strict=True)), name: value}


@pytest.mark.parametrize("name", FRICTION_KINDS)
def test_the_page_draws_the_torque_of_every_coefficient(name, browser):
    friction = Friction(**{name: 2.0**-10})
    motion = Motion(ARTICLE, CUSPS, friction)
    tab = open_tab(browser)
    load_kernel(tab)
    found = tab.evaluate(
        """async ([top, orientation, omega, friction]) => {
          const { Course } = await import("/physics/course.js");
          const { State } = await import("/physics/state.js");
          const { findVectors } = await import("/scene/vectors.js");
          const state = new State(kernel, orientation, omega);
          return findVectors(new Course(kernel, top, state, friction), state).torque;
        }""",
        [
            asdict(ARTICLE),
            CUSPS.orientation.tolist(),
            CUSPS.angular_velocity.tolist(),
            friction.coefficients,
        ],
    )
    right = motion.total_torque(CUSPS)
    assert np.abs(np.array(found) - right).max() < 1e-15 * 200  # some roundings
    tab.close()
