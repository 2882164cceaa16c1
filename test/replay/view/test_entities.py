"""Every entity of a recording, read back as a viewer does, is what the motion says.

The list of entities is that of the recording: one without an oracle here fails. What oracles expect
comes from `Motion.at` by the definitions of mechanics, never from the code that draws.
"""

import re
from collections.abc import Callable
from functools import cached_property

import numpy as np
import pytest
from log_files import ARTICLE, BEGIN, Run
from replay.view.rows import DRIFT, record, rows
from rerun.chunk import RrdReader

from symtop_ros.physics import ExactTimes, Motion, State, Top, hurry
from symtop_ros.replay.view import entities

SINGLE = float(np.finfo(np.float32).eps)  # Rerun keeps vectors in single precision
ROUNDED = 8 * SINGLE  # of a length of a few scene units, and a rotation
UP = np.array([0.0, 0.0, 1.0])
FLAT = 5e-4  # of a box of height 1: a curve is drawn in straight pieces
START = State.from_euler(phi=0.4, theta=0.5, psi=0.7, phi_dot=3.0, psi_dot=180.0)
FREE = Top(0.5, 0.75, 0.0)
TURNING = State.from_euler(phi=0.4, theta=1.0, psi=0.7, phi_dot=2.0, psi_dot=3.0)


class Drawn:
    """A recording with all that can be drawn, and the two motions of its run."""

    def __init__(self, folder, top, start):
        self.top = top
        run = Run(top, start, seconds=0.5)
        self.path = record(run, folder, angles=True, torques=True, fictitious=True)
        # In ns of the recording, which begins with the first sample.
        self.kicked = [at for name, at, _ in run.messages if name == "events"][1] - BEGIN
        self.before = Motion(top, start)
        self.after = Motion(top, hurry(self.before.at(ExactTimes(self.kicked)), 1.4))

    def state_at(self, times):
        """The states (n,) at times in ns."""
        states = [
            self.after.at(ExactTimes(int(t) - self.kicked))
            if t >= self.kicked
            else self.before.at(ExactTimes(int(t)))
            for t in times
        ]
        return State(
            np.array([each.orientation for each in states]),
            np.array([each.angular_velocity for each in states]),
        )

    def read(self, entity, column):
        """Times, states at them, and the values of a column."""
        times, values = rows(self.path, entity, column)
        assert len(times), (entity, column)
        return times, self.state_at(times), values

    def arrows(self, entity):
        """States, origins and vectors of an arrow; origins are the pivot if none are given."""
        _, state, vectors = self.read(entity, "Arrows3D:vectors")
        origins = rows(self.path, entity, "Arrows3D:origins")[1]
        vectors = np.array(vectors)[:, 0]
        return state, np.array(origins)[:, 0] if origins else 0.0 * vectors, vectors

    @cached_property
    def scales(self):
        """What one scene unit is, by the labels: as the table says it, with its units."""
        text = rows(self.path, entities.PANEL, "TextDocument:text")[1][0][0]
        names, values = re.search(r"1 unit of (.*?) \| \*\*(.*?)\*\*", text).groups()
        sizes = [float(each.split()[0]) for each in values.split(", ")]
        return dict(zip(names.split(", "), sizes, strict=True))

    @cached_property
    def fictitious_scales(self):
        """The same of the torques in the precessing frame, before and after the kick."""
        texts = rows(self.path, entities.PANEL, "TextDocument:text")[1]
        return [float(re.search(r"1 unit (\S+) N m", text[0])[1]) for text in texts]


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    return Drawn(tmp_path_factory.mktemp("heavy"), ARTICLE, START)


@pytest.fixture(scope="module")
def drawn_free(tmp_path_factory):
    return Drawn(tmp_path_factory.mktemp("free"), FREE, TURNING)


def axis_of(state):
    return state.to_world(UP)


def nodes_of(state):
    """Along z' x z: where theta' turns the axis about."""
    axis = axis_of(state)
    across = np.stack([-axis[:, 1], axis[:, 0], 0.0 * axis[:, 0]], axis=1)
    return across / np.linalg.norm(across, axis=1, keepdims=True)


def torque_of(top, state):
    """Of gravity, along z' x z: the weight is Mgl times the axis off the pivot."""
    return top.Mgl * np.cross(UP, axis_of(state))


def near(found, expected):
    size = max(np.abs(expected).max(), 1.0)
    return np.abs(np.asarray(found) - expected).max() <= ROUNDED * size


def check_attitude(drawn, entity):
    _, state, values = drawn.read(entity, "Transform3D:quaternion")
    found = np.array([each[0] for each in values])[:, [3, 0, 1, 2]]
    assert near(found, state.orientation)


def check_trace(drawn, entity):
    _, state, values = drawn.read(entity, "LineStrips3D:strips")
    ends = np.array([each[0][-1] for each in values])
    assert near(ends, axis_of(state))


def check_ghost(drawn, entity):
    """The motion before the kick goes on."""
    times, values = rows(drawn.path, entity, "Transform3D:quaternion")
    assert times.min() >= drawn.kicked
    expected = drawn.before.at(ExactTimes(np.array(times, dtype=np.int64))).orientation
    assert near(np.array([each[0] for each in values])[:, [3, 0, 1, 2]], expected)


def check_ghost_trace(drawn, entity):
    times, values = rows(drawn.path, entity, "LineStrips3D:strips")
    assert times.min() >= drawn.kicked
    expected = drawn.before.at(ExactTimes(np.array(times, dtype=np.int64)))
    assert near(np.array([each[0][-1] for each in values]), axis_of(expected))


def check_nodes(drawn, entity):
    _, state, values = drawn.read(entity, "LineStrips3D:strips")
    lines = np.array([each[0] for each in values])
    ends = lines[:, -1]
    assert near(lines[:, 0], -ends)  # through the pivot, to both sides
    assert near(ends, np.linalg.norm(ends, axis=1)[:, None] * nodes_of(state))


def check_circles(drawn, entity):
    _, values = rows(drawn.path, entity, "LineStrips3D:strips")
    for motion, strips in zip((drawn.before, drawn.after), values, strict=True):
        for theta, strip in zip(motion.turning_angles, strips, strict=True):
            x, y, z = np.array(strip).T
            assert near(z, np.full(len(z), np.cos(theta)))
            assert near(np.hypot(x, y), np.full(len(z), np.sin(theta)))


def check_vector(label, find):
    def check(drawn, entity):
        state, origins, vectors = drawn.arrows(entity)
        assert not origins.any()
        expected = find(drawn.top, state) / drawn.scales[label]
        assert near(vectors, expected)
        names = rows(drawn.path, f"{entity}/name", "Points3D:positions")[1]
        assert near(np.array(names)[:, 0], expected)  # at the tip

    return check


def check_inertial(part):
    """dL/dt in the body frame, omega x L beneath its tip, and phi' z' x L."""

    def check(drawn, entity):
        state, origins, vectors = drawn.arrows(entity)
        L = drawn.top.angular_momentum(state)
        turning = np.cross(state.to_world(state.angular_velocity), L)
        body = torque_of(drawn.top, state) - turning
        precession = np.cross(state.euler_rates.phi_dot[:, None] * UP, L)
        expected = {"body": body, "turning": turning, "precession": precession}[part]
        assert near(vectors, expected / drawn.scales["torque"])
        tail = body / drawn.scales["torque"] if part == "turning" else 0.0 * body
        assert near(origins[:, :2], tail[:, :2])
        depth = (origins - tail)[:, 2]
        assert near(depth, np.full(len(depth), depth[0]))
        check_label(drawn, entity, state)

    return check


def check_label(drawn, entity, state):
    """A label has a fixed place in the frame of the nodes."""
    places = np.array(rows(drawn.path, f"{entity}/name", "Points3D:positions")[1])[:, 0]
    along = (places * nodes_of(state)).sum(axis=1)
    assert near(along, np.full(len(along), along[0]))
    assert near(places[:, 2], np.full(len(along), places[0, 2]))
    across = np.cross(UP, nodes_of(state))
    assert near((places * across).sum(axis=1), np.zeros(len(along)))


def check_fictitious(part):
    """Along the nodes, head to tail: gravity, Coriolis, centrifugal; their sum is Ix theta''."""

    def check(drawn, entity):
        times, state, _ = drawn.read(entity, "Arrows3D:vectors")
        _, origins, vectors = drawn.arrows(entity)
        scale = np.where(times < drawn.kicked, *drawn.fictitious_scales)
        Ix, Iz, Mgl = drawn.top.moments
        theta = state.euler_angles.theta
        phi_dot, _, psi_dot = state.euler_rates
        sine = np.sin(theta)
        gravity = Mgl * sine
        coriolis = -Iz * psi_dot * phi_dot * sine
        centrifugal = (Ix - Iz) * phi_dot**2 * sine * np.cos(theta)
        total = gravity + coriolis + centrifugal
        size, tail = {
            "gravity": (gravity, 0.0),
            "Coriolis": (coriolis, gravity),
            "centrifugal": (centrifugal, gravity + coriolis),
            "sum": (total, 0.0),
        }[part]
        nodes = nodes_of(state)
        assert near(vectors, (size / scale)[:, None] * nodes)
        assert near(origins[:, :2], ((tail / scale)[:, None] * nodes)[:, :2])
        names = np.array(rows(drawn.path, f"{entity}/name", "Points3D:positions")[1])[:, 0]
        tips = origins + vectors
        assert (np.linalg.norm(names - tips, axis=1) < 0.4).all()  # beyond the tip

    return check


def check_arc(name):
    """phi from x' to N, theta from z' to z, psi from N to x, each at one distance."""

    def check(drawn, entity):
        _, state, values = drawn.read(entity, "LineStrips3D:strips")
        arcs = np.array([each[0] for each in values])
        nodes = nodes_of(state)
        count = len(nodes)
        begin, end = {
            "phi": (np.tile([1.0, 0.0, 0.0], (count, 1)), nodes),
            "theta": (np.tile(UP, (count, 1)), axis_of(state)),
            "psi": (nodes, state.to_world([1.0, 0.0, 0.0])),
        }[name]
        radius = np.linalg.norm(arcs, axis=2)
        assert near(radius, np.full_like(radius, radius[0, 0]))
        assert near(arcs[:, 0], radius[0, 0] * begin)
        assert near(arcs[:, -1], radius[0, 0] * end)
        letters = np.array(rows(drawn.path, f"{entity}/letter", "Points3D:positions")[1])[:, 0]
        middle = arcs[:, arcs.shape[1] // 2]
        assert near(np.cross(letters, middle), np.zeros_like(middle))
        assert (np.linalg.norm(letters, axis=1) > radius[0, 0]).all()

    return check


def check_nodes_arrow(drawn, entity):
    state, _, vectors = drawn.arrows(entity)
    assert near(vectors, np.linalg.norm(vectors[0]) * nodes_of(state))
    names = np.array(rows(drawn.path, f"{entity}/name", "Points3D:positions")[1])[:, 0]
    assert near(names, np.linalg.norm(names[0]) * nodes_of(state))


def check_lines(find):
    """Doubles of a plot, (n, width)."""

    def check(drawn, entity):
        _, state, values = drawn.read(entity, "Scalars:scalars")
        expected = find(drawn.top, state)
        # Sums of products of a state that was rounded once more.
        size = np.abs(expected).max() or 1.0
        assert np.abs(np.array(values) - expected).max() <= 64 * np.finfo(float).eps * size

    return check


def find_rate(k):
    return lambda _, state: state.euler_rates[k][:, None]


def find_along_nodes(top, state):
    """The torque, dL/dt in the body and omega x L, along the nodes."""
    nodes = nodes_of(state)
    turning = np.cross(state.to_world(state.angular_velocity), top.angular_momentum(state))
    total = (torque_of(top, state) * nodes).sum(axis=1)
    moved = (turning * nodes).sum(axis=1)
    return np.stack([total, total - moved, moved], axis=1)


def check_energy(drawn, entity):
    """Kinetic; with potential from its lowest point; the same with no loss; start and work."""
    times, state, values = drawn.read(entity, "Scalars:scalars")
    top = drawn.top
    wx, wy, wz = state.angular_velocity.T
    kinetic = (top.Ix * (wx**2 + wy**2) + top.Iz * wz**2) / 2
    total = kinetic + top.Mgl * axis_of(state)[:, 2] + abs(top.Mgl)
    expected = np.stack([kinetic, total, total, total], axis=1)
    size = np.abs(expected).max()
    assert np.abs(np.array(values) - expected).max() <= 64 * np.finfo(float).eps * size
    assert (times < drawn.kicked).any()


def check_drift(drawn, entity):
    values = np.array(rows(drawn.path, entity, "Scalars:scalars")[1])
    assert values.shape[1] == 3
    assert np.abs(values).max() <= DRIFT


def read_chart(drawn, entity, number):
    """Lines, marks and their labels of one of the two motions, of the chart with a dot."""
    entity = entity.removesuffix("/state")
    found = {}
    for name, column in (("curve", "LineStrips2D"), ("energy", "LineStrips2D")):
        strips = rows(drawn.path, f"{entity}/{name}", f"{column}:strips")[1]
        if strips:
            found[name] = [np.array(each) for each in strips[number]]
    marks = f"{entity}/marks"
    found["marks"] = np.array(rows(drawn.path, marks, "Points2D:positions")[1][number])
    labels = rows(drawn.path, marks, "Points2D:labels")[1][number]
    found["values"] = [float(re.search(r"-?\d+\.\d+", text)[0]) for text in labels]
    return found


def read_dots(drawn, entity):
    """States and positions of the dot, of each of the two motions."""
    times, values = rows(drawn.path, entity, "Points2D:positions")
    places = np.array(values)[:, 0]
    for number, chosen in enumerate((times < drawn.kicked, times >= drawn.kicked)):
        yield number, drawn.state_at(times[chosen]), places[chosen]


def measure(chart, x):
    """Values at places, by two marks with labels of three decimals."""
    (low, high), (first, last) = chart["marks"][[0, 1], 0], chart["values"][:2]
    return first + (x - low) * (last - first) / (high - low)


def check_potential(drawn, entity):
    """The dot is at theta, at the height of the energy, and over the curve, which ends there."""
    for number, state, dots in read_dots(drawn, entity):
        chart = read_chart(drawn, entity, number)
        motion = (drawn.before, drawn.after)[number]
        assert chart["values"] == pytest.approx(motion.turning_angles, abs=0.0005)
        span = chart["values"][1] - chart["values"][0]
        off = np.abs(measure(chart, dots[:, 0]) - state.euler_angles.theta)
        assert off.max() <= 0.001 + 0.01 * span
        (level,) = {float(y) for y in chart["energy"][0][:, 1]}
        assert np.abs(dots[:, 1] - level).max() <= ROUNDED  # gravity alone: E' is constant
        x, y = np.concatenate(chart["curve"]).T
        # y points down: the curve lies below the dot, and meets its height at the marks.
        assert (np.interp(dots[:, 0], x, y) >= dots[:, 1] - 1e-3).all()
        assert np.abs(np.interp(chart["marks"][:, 0], x, y) - level).max() <= 5e-3


def check_cubic(drawn, entity):
    """The dot is at u = cos(theta), on the curve of (du/dt)^2, which is zero at its marks."""
    for number, state, dots in read_dots(drawn, entity):
        chart = read_chart(drawn, entity, number)
        u = np.cos(state.euler_angles.theta)
        assert np.abs(measure(chart, dots[:, 0]) - u).max() <= 0.002
        x, y = np.concatenate(chart["curve"]).T
        off = np.abs(np.interp(dots[:, 0], x, y) - dots[:, 1])
        assert off.max() <= FLAT
        zero = chart["marks"][0, 1]
        assert np.abs(np.interp(chart["marks"][:2, 0], x, y) - zero).max() <= FLAT
        rate = np.sin(state.euler_angles.theta) * state.euler_rates.theta_dot
        height = zero - dots[:, 1]
        assert near(height / height.max(), rate**2 / (rate**2).max())


def check_hatches(chart):
    """From the curve to the line of the energy, or from zero to the curve."""

    def check(drawn, entity):
        for number, strips in enumerate(rows(drawn.path, entity, "LineStrips2D:strips")[1]):
            lines = np.array(strips)
            read = read_chart(drawn, chart, number)
            x, y = np.concatenate(read["curve"]).T
            on_curve = np.interp(lines[:, 0, 0], x, y)
            level = read["energy"][0][0, 1] if chart == entities.POTENTIAL else read["marks"][0, 1]
            first, last = (on_curve, level) if chart == entities.POTENTIAL else (level, on_curve)
            assert np.abs(lines[:, 0, 1] - first).max() <= 10 * FLAT
            assert np.abs(lines[:, 1, 1] - last).max() <= 10 * FLAT
            ends = lines[[0, -1], 0, 0]
            assert np.abs(np.sort(ends) - np.sort(read["marks"][:2, 0])).max() <= ROUNDED

    return check


def check_charts_lines(drawn, entity):
    """Within the box of the chart, whose dot `check_potential` and `check_cubic` read."""
    box = np.concatenate(
        [
            np.concatenate(each)
            for each in rows(drawn.path, entity, "LineStrips2D:strips")[1]
            if each
        ]
    )
    assert (box >= [-ROUNDED, -1 - ROUNDED]).all()
    assert (box <= [2 + ROUNDED, ROUNDED]).all()


def check_cubic_frame(drawn, entity):
    """The line of zero, at which marks stand, and those of cos(theta) = -1 and 1."""
    check_charts_lines(drawn, entity)
    for number, strips in enumerate(rows(drawn.path, entity, "LineStrips2D:strips")[1]):
        zero, *poles = (np.array(each) for each in strips)
        chart = read_chart(drawn, entities.CUBIC, number)
        assert np.abs(zero[:, 1] - chart["marks"][0, 1]).max() <= ROUNDED
        ends = [measure(chart, pole[:, 0]) for pole in poles]
        # of labels with three decimals, which are a part of the chart apart
        span = np.ptp(chart["values"][:2])
        assert np.abs(np.array(ends) - [[-1.0], [1.0]]).max() <= 0.0005 * 2 * (2 / span + 1)


def check_mesh(drawn, entity):
    """A surface: its triangles have areas, and their normals point outwards."""
    find = {
        name: np.array(rows(drawn.path, entity, f"Mesh3D:{name}")[1][0])
        for name in ("vertex_positions", "vertex_normals", "triangle_indices")
    }
    places, normals, corners = find.values()
    assert np.abs(np.linalg.norm(normals, axis=1) - 1).max() <= ROUNDED
    a, b, c = (places[corners[:, k]] for k in range(3))
    faces = np.cross(b - a, c - a)
    areas = np.linalg.norm(faces, axis=1)
    has_area = areas > 1e-7  # a tip has a triangle of none
    assert has_area.mean() > 0.45
    outwards = (faces * normals[corners].sum(axis=1)).sum(axis=1)[has_area]
    assert (outwards > 0).all() or (outwards < 0).all()
    # Through a closed surface an outward normal leads three times its volume.
    leads = ((a + b + c) * normals[corners].sum(axis=1)).sum(axis=1)
    assert (leads * areas).sum() > 0
    low, high = places[:, 2].min(), places[:, 2].max()
    if entity == entities.STAND:
        assert high < 0
    else:
        assert high == pytest.approx(1.0, abs=1e-6)  # the axle ends on the sphere
        assert low <= 0


def check_sphere(drawn, entity):
    points = np.concatenate(rows(drawn.path, entity, "LineStrips3D:strips")[1][0])
    assert near(np.linalg.norm(points, axis=1), np.ones(len(points)))


def check_axis_line(drawn, entity):
    assert np.array(rows(drawn.path, entity, "LineStrips3D:strips")[1][0]).tolist() == [
        [[0, 0, 0], [0, 0, 1]]
    ]


def check_cone_rim(find):
    """The end of omega goes round the rim."""

    def check(drawn, entity):
        frames = [*rows(drawn.path, entity, "LineStrips3D:strips")[1]]
        for motion, strips in zip((drawn.before, drawn.after), frames, strict=True):
            across, along = find(drawn, motion)
            x, y, z = np.array(strips[0]).T
            assert near(np.hypot(x, y), np.full(len(x), across))
            assert near(z, np.full(len(z), along))

    return check


def find_polhode(drawn, motion):
    x, y, z = motion.start.angular_velocity / drawn.scales["omega"]
    return np.hypot(x, y), z


def find_herpolhode(drawn, motion):
    L = drawn.top.angular_momentum(motion.start)
    omega = motion.start.to_world(motion.start.angular_velocity) / drawn.scales["omega"]
    along = omega @ L / np.linalg.norm(L)
    return np.sqrt(omega @ omega - along**2), along


def check_herpolhode_turn(drawn, entity):
    """Its z axis is turned to L."""
    for motion, (xyzw,) in zip(
        (drawn.before, drawn.after),
        rows(drawn.path, entity, "Transform3D:quaternion")[1],
        strict=True,
    ):
        L = drawn.top.angular_momentum(motion.start)
        x, y, z, w = xyzw
        turned = State((w, x, y, z), (0.0, 0.0, 0.0)).to_world(UP)
        assert near(turned, L / np.linalg.norm(L))


def check_cone(drawn, entity):
    places = np.array(rows(drawn.path, entity, "Mesh3D:vertex_positions")[1][0])
    rim = np.array(rows(drawn.path, entity.replace("cone", "rim"), "LineStrips3D:strips")[1][0][0])
    far = places[np.linalg.norm(places, axis=1) > 1e-6]
    assert near(np.hypot(far[:, 0], far[:, 1]), np.full(len(far), np.hypot(*rim[0, :2])))
    assert near(far[:, 2], np.full(len(far), rim[0, 2]))


ORACLES: dict[str, Callable[[Drawn, str], None] | None] = {
    entities.BODY: lambda drawn, entity: (check_attitude(drawn, entity), check_mesh(drawn, entity)),
    entities.GHOST: lambda drawn, entity: (check_ghost(drawn, entity), check_mesh(drawn, entity)),
    f"{entities.GHOST}/axis": check_axis_line,
    entities.GHOST_TRACE: check_ghost_trace,
    entities.TRACE: check_trace,
    entities.NODES: check_nodes,
    entities.CIRCLES: check_circles,
    entities.SPHERE: check_sphere,
    entities.STAND: check_mesh,
    entities.MOMENTUM: check_vector("L", lambda top, state: top.angular_momentum(state)),
    entities.VELOCITY: check_vector(
        "omega", lambda _, state: state.to_world(state.angular_velocity)
    ),
    entities.TORQUE: check_vector("torque", torque_of),
    f"{entities.ANGLES}/phi": check_arc("phi"),
    f"{entities.ANGLES}/theta": check_arc("theta"),
    f"{entities.ANGLES}/psi": check_arc("psi"),
    f"{entities.ANGLES}/nodes": check_nodes_arrow,
    **{
        f"{entities.INERTIAL}/{part}": check_inertial(part)
        for part in ("body", "turning", "precession")
    },
    **{
        f"{entities.FICTITIOUS}/{part}": check_fictitious(part)
        for part in ("gravity", "Coriolis", "centrifugal", "sum")
    },
    entities.THETA: check_lines(lambda _, state: state.euler_angles.theta[:, None]),
    entities.PHI_DOT: check_lines(find_rate(0)),
    entities.PSI_DOT: check_lines(find_rate(2)),
    entities.L: check_lines(lambda top, state: top.angular_momentum(state)),
    entities.L_HORIZONTAL: check_lines(
        lambda top, state: (top.angular_momentum(state)[:, :2] ** 2).sum(axis=1)[:, None]
    ),
    entities.NODES_TORQUE: check_lines(find_along_nodes),
    entities.ENERGY: check_energy,
    entities.DRIFT: check_drift,
    f"{entities.POTENTIAL}/state": check_potential,
    f"{entities.CUBIC}/state": check_cubic,
    **{
        f"{chart}/{name}": check_charts_lines
        for chart in (entities.POTENTIAL, entities.CUBIC)
        for name in ("curve", "before", "frame")
    },
    **{f"{chart}/allowed": check_hatches(chart) for chart in (entities.POTENTIAL, entities.CUBIC)},
    f"{entities.CUBIC}/frame": check_cubic_frame,
    f"{entities.POTENTIAL}/energy": check_charts_lines,
    f"{entities.POLHODE}/rim": check_cone_rim(find_polhode),
    f"{entities.HERPOLHODE}/rim": check_cone_rim(find_herpolhode),
    f"{entities.POLHODE}/cone": check_cone,
    f"{entities.HERPOLHODE}/cone": check_cone,
    entities.HERPOLHODE: check_herpolhode_turn,
}
# Read with what they name or belong to, above; sentences are read by the tests of words, and the
# arrow of the sensor, which this log has not, by test_view.py.
READ_ELSEWHERE = re.compile(
    r".*/(name|letter|marks)|/(motion|sentence|events)|/__properties(/.*)?|"
    r"/space/(angles/world|top/axes)(/names)?|/space/(specific_force|points)"
)


def list_entities(drawn):
    return {chunk.entity_path for chunk in RrdReader(drawn.path).stream()}


def test_there_is_an_oracle_for_each_entity(drawn, drawn_free):
    found = list_entities(drawn) | list_entities(drawn_free)
    assert {each for each in found if not READ_ELSEWHERE.fullmatch(each)} - set(ORACLES) == set()
    assert set(ORACLES) - found == set()


def test_there_is_an_oracle_below_each_path_of_the_list():
    named = {name: value for name, value in vars(entities).items() if name.isupper()}
    paths = {each for each in named.values() if isinstance(each, str) and each[:1] == "/"}
    assert len(paths) > 25
    for path in paths:
        has_one = any(each == path or each.startswith(f"{path}/") for each in ORACLES)
        assert has_one or READ_ELSEWHERE.fullmatch(path), path


@pytest.mark.parametrize("entity", ORACLES)
def test_an_entity_is_what_the_motion_says(drawn, drawn_free, entity):
    chosen = drawn if entity in list_entities(drawn) else drawn_free
    ORACLES[entity](chosen, entity)
