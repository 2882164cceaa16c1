"""Model files as other engines read them: what they say of a body and its start, in mpmath."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import pytest
from mpmath import matrix, mp, mpf
from physics.tops import cross, turn

DIGITS = 30
ZERO = "0 0 0"
MOMENTS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


@dataclass(frozen=True)
class Described:
    """A body and its start in the frame of its link, with the pivot in the origin."""

    moments: Any  # matrix (3, 3) about the pivot, kg m^2
    mass: Any
    weighted: Any  # mass times the centre of mass, kg m, (3, 1)
    frame: Any  # matrix (3, 3), from the link to the world
    angular_velocity: Any  # (3, 1)


def read_model(path: Path) -> Described:
    """Return what a MJCF, SDF, URDF or USD file says."""
    if path.suffix == ".usda":
        with mp.workdps(DIGITS):
            return read_usd(path.read_text())
    root = ElementTree.parse(path).getroot()
    read = {"mjcf": read_mjcf, "sdf": read_sdf, "urdf": read_urdf}[path.suffix[1:]]
    with mp.workdps(DIGITS):
        return read(root, path.read_text())


def read_mjcf(root: Element, _: str) -> Described:
    link = root.find("worldbody/body")
    joint, child = link.find("joint"), link.find("body")
    pivot = vector(ZERO if joint is None else joint.get("pos", ZERO))
    frames = [(link, mp.eye(3), -pivot)]
    if child is not None:
        place = vector(child.get("pos")) - pivot
        frames.append((child, rotation(numbers(child.get("quat"))), place))
    found = []
    for body, turned, place in frames:
        if (inertial := body.find("inertial")) is not None:
            full = inertial.get("fullinertia") or f"{inertial.get('diaginertia')} 0 0 0"
            centre = vector(inertial.get("pos"))
            own = rotation(numbers(inertial.get("quat", "1 0 0 0")))
            found.append(place_part(inertial.get("mass"), centre, full, (turned, own), place))
    key = root.find("keyframe/key")
    qpos, qvel = numbers(key.get("qpos")), numbers(key.get("qvel"))
    if joint is not None:
        return gather(found, rotation(qpos), matrix(qvel))
    return gather_free(found, rotation(qpos[3:]), matrix(qvel[3:]), qpos[:3], qvel[:3])


def read_sdf(root: Element, text: str) -> Described:
    model = root.find("world/model")
    joint = model.find("joint[@type='ball']")
    pivot = mp.zeros(3, 1) if joint is None else read_pose(joint.find("pose"))[0]
    found = []
    inner = model.find("model")
    whole = mp.zeros(3, 1), mp.eye(3)
    for owner, (at, axes) in [(model, whole)] + (
        [] if inner is None else [(inner, read_pose(inner.find("pose")))]
    ):
        named = {each.get("name"): each for each in owner if each.tag in ("link", "frame")}
        for link in owner.findall("link"):
            place, turned = find_frame(link, named)
            found.append(read_link(link, at + axes * place - pivot, axes * turned))
    *origin, x, y, z, w = numbers(model.find("pose").text)
    omega = vector(re.search(r"angular velocity (\S+ \S+ \S+) rad/s", text)[1])
    if joint is not None:
        return gather(found, rotation([w, x, y, z]), omega)
    moving = re.search("moves with (.+) m/s", text)
    velocity = numbers(moving[1] if moving else ZERO)
    return gather_free(found, rotation([w, x, y, z]), omega, origin, velocity)


def read_pose(pose: Element | None) -> tuple[Any, Any]:
    """Return place (3, 1) and rotation (3, 3) of a pose of SDF, which may be absent or empty."""
    if pose is None or not (pose.text or "").strip():
        return mp.zeros(3, 1), mp.eye(3)
    x, y, z, *angles = numbers(pose.text)
    if pose.get("rotation_format") == "quat_xyzw":
        return matrix([x, y, z]), rotation([angles[3], *angles[:3]])
    unit = mp.pi / 180 if pose.get("degrees") == "true" else 1
    return matrix([x, y, z]), turn_by_angles(*(unit * each for each in angles))


def find_frame(element: Element, named: dict[str, Element]) -> tuple[Any, Any]:
    """Return place and rotation of a link or a frame in its model."""
    pose = element.find("pose")
    place, turned = read_pose(pose)
    to = (None if pose is None else pose.get("relative_to")) or element.get("attached_to")
    if to is None:
        return place, turned
    at, axes = find_frame(named[to], named)
    return at + axes * place, axes * turned


def read_link(link: Element, place: Any, turned: Any) -> tuple[Any, Any, Any]:
    """Return mass, centre and moments of a link: stated, or those of its collision."""
    inertial = link.find("inertial")
    if inertial.get("auto") == "true":
        assert inertial.find("mass") is None
        collision = link.find("collision")
        centre, own = read_pose(collision.find("pose"))
        shape = collision.find("geometry/cylinder")
        sizes = (mpf(float(shape.find(name).text)) for name in ("radius", "length"))
        mass, moments = fill_cylinder(*sizes, mpf(float(collision.find("density").text)))
        return mass, place + turned * centre, turned * own * moments * (turned * own).T
    centre, own = read_pose(inertial.find("pose"))
    full = " ".join(inertial.find(f"inertia/{name}").text for name in MOMENTS)
    return place_part(inertial.find("mass").text, centre, full, (turned, own), place)


def fill_cylinder(radius: Any, height: Any, density: Any) -> tuple[Any, Any]:
    """Return mass and moments (3, 3) of a homogeneous cylinder along z, about its centre."""
    mass = density * mp.pi * radius**2 * height
    across = mass * (3 * radius**2 + height**2) / 12
    return mass, mp.diag([across, across, mass * radius**2 / 2])


def read_urdf(root: Element, text: str) -> Described:
    spin = root.find("joint[@name='spin']")
    frames = [("top", mp.eye(3), vector(ZERO))]
    fixed = {each.find("parent").get("link"): each for each in root.findall("joint[@type='fixed']")}
    for name, axes, at in frames:  # it grows by the children of each
        if name in fixed:
            child = fixed[name].find("child").get("link")
            place = at + axes * matrix(read_origin(fixed[name], "xyz"))
            frames.append((child, axes * read_turn(fixed[name]), place))
    found = []
    for name, turned, place in frames:
        inertial = root.find(f"link[@name='{name}']/inertial")
        full = " ".join(inertial.find("inertia").get(each) for each in MOMENTS)
        centre = matrix(read_origin(inertial, "xyz"))
        turns = turned, read_turn(inertial)
        found.append(place_part(inertial.find("mass").get("value"), centre, full, turns, place))
    if spin is None:
        x, y, z, w = numbers(re.search("x, y, z, w (.+), angular", text)[1])
        omega = vector(re.search("angular velocity (.+) rad/s", text)[1])
        moving = re.search("place (.+) m and velocity (.+) m/s", text)
        origin, velocity = map(numbers, moving.groups() if moving else (ZERO, ZERO))
        return gather_free(found, rotation([w, x, y, z]), omega, origin, velocity)
    frame = read_turn(spin)
    axis = vector(spin.find("axis").get("xyz"))
    assert mp.norm(frame * axis - vector("0 0 1")) < 1e-15  # the axis of the body
    (angles, rates) = re.search("position (.+) rad, velocity (.+) rad/s", text).groups()
    phi, theta, psi = numbers(angles)
    turns = [about(2, phi), about(0, theta), about(2, psi), frame]
    z, x = vector("0 0 1"), vector("1 0 0")
    a, b, c = numbers(rates)
    # of each joint in the frame of the link: its axis, turned back by the joints after it
    omega = turns[3].T * (turns[2].T * (turns[1].T * z * a + x * b) + z * c)
    return gather(found, turns[0] * turns[1] * turns[2] * turns[3], omega)


def read_usd(text: str) -> Described:
    """Return what a stage says: each field of a prim by its name, numbers as they stand there."""
    heads = list(re.finditer(r'def \w+ "(\w+)"', text))
    ends = [*(each.start() for each in heads[1:]), len(text)]
    prims = {
        head[1]: dict(re.findall(r"^ +\w+ (\S+) = \(?([^()\n]*)\)?$", text[head.end() : end], re.M))
        for head, end in zip(heads, ends, strict=True)
    }
    kilogram, metre = (
        mpf(float(re.search(rf"{name}PerUnit = (.*)", text)[1])) for name in ("kilograms", "meters")
    )
    pivot, fixed = prims.get("pivot"), prims.get("fixed")
    held = tuple_of(pivot, "physics:localPos1") if pivot else mp.zeros(3, 1)
    frames = [("top", mp.eye(3), -held)]
    if fixed:
        turned = rotation(list(tuple_of(fixed, "physics:localRot0")))
        frames.append(("part", turned, tuple_of(fixed, "physics:localPos0")))
    bodies = {name: find_mass(prims, name) for name, *_ in frames}
    found = [place_body(bodies[name], turned, place) for name, turned, place in frames]
    frame, origin = find_start(prims, "top")
    omega = tuple_of(prims["top"], "physics:angularVelocity") * mp.pi / 180
    for name, turned, place in frames:
        axes, at = find_start(prims, name)
        prim, centre = prims[name], bodies[name][1]
        arm = place + turned * centre if pivot else mp.zeros(3, 1)
        own = tuple_of(prim, "physics:angularVelocity") * mp.pi / 180
        size = mp.norm(omega)
        assert mp.norm(turned * own - omega) <= 1e-15 * size
        moving = turned * tuple_of(prim, "physics:velocity") - matrix(cross(omega, arm))
        assert mp.norm(moving) <= 1e-14 * size * (1 + mp.norm(arm))
        assert mp.mnorm(axes - frame * turned) < 1e-15
        apart = at - origin - frame * (place - frames[0][2])
        assert mp.norm(apart) < 1e-15 * (1 + mp.norm(at))
    if pivot:
        gravity = float(re.search("gravityMagnitude = (.*)", text)[1])
        assert gravity * metre == pytest.approx(9.81, rel=4e-16)  # a product, and 0.01 as a double
        found = [(kilogram * m, metre * c, kilogram * metre**2 * own) for m, c, own in found]
        return gather(found, frame, omega)
    whole = gather(found, frame, omega)
    velocity = -frame * matrix(cross(omega, whole.weighted / whole.mass))
    return gather_free(found, frame, omega, list(origin), list(velocity))


def tuple_of(prim: dict[str, str], name: str) -> Any:
    return vector(prim[name].replace(",", " "))


def find_start(prims: dict[str, dict[str, str]], name: str) -> tuple[Any, Any]:
    """Return rotation and place of the transforms over a body, one in the other."""
    turned, at = mp.eye(3), mp.zeros(3, 1)
    for prim in (prims.get(each) for each in (f"start_{name}", "back")):
        if prim:
            at += turned * tuple_of(prim, "xformOp:translate")
            if "xformOp:orient" in prim:
                turned *= rotation(list(tuple_of(prim, "xformOp:orient")))
            else:  # about fixed axes: x first
                angles = tuple_of(prim, "xformOp:rotateXYZ") * mp.pi / 180
                turned *= turn_by_angles(*angles)
    return turned, at


def find_mass(prims: dict[str, dict[str, str]], name: str) -> tuple[Any, Any, Any]:
    """Return mass, centre and moments in the frame of a body: stated, or those of its collider."""
    prim = prims[name]
    if solid := prims.get("solid"):
        assert "physics:mass" not in prim
        axes = rotation(list(tuple_of(solid, "xformOp:orient")))
        sizes = (mpf(float(solid[each])) for each in ("radius", "height", "physics:density"))
        mass, moments = fill_cylinder(*sizes)
        return mass, tuple_of(solid, "xformOp:translate"), axes * moments * axes.T
    axes = rotation(list(tuple_of(prim, "physics:principalAxes")))
    moments = axes * mp.diag(list(tuple_of(prim, "physics:diagonalInertia"))) * axes.T
    return mpf(float(prim["physics:mass"])), tuple_of(prim, "physics:centerOfMass"), moments


def place_body(body: tuple[Any, Any, Any], turned: Any, place: Any) -> tuple[Any, Any, Any]:
    """Return mass, centre of mass and moments of a body that is turned and moved."""
    mass, centre, moments = body
    return mass, place + turned * centre, turned * moments * turned.T


def read_origin(element: Element, name: str) -> list[Any]:
    origin = element.find("origin")
    return numbers(ZERO if origin is None else origin.get(name, ZERO))


def read_turn(element: Element) -> Any:
    """Return the rotation of an origin: by its angles, or the quaternion of URDF 1.1."""
    origin = element.find("origin")
    if origin is None or origin.get("quat_xyzw") is None:
        return turn_by_angles(*read_origin(element, "rpy"))
    x, y, z, w = numbers(origin.get("quat_xyzw"))
    return rotation([w, x, y, z])


def place_part(mass: str, centre: Any, full: str, turns: Any, place: Any) -> tuple[Any, Any, Any]:
    """Return mass, centre of mass and moments of a part of a body that is turned and moved.

    Its moments are in an inertial frame, which is turned in that of the part.
    """
    turned, own = turns
    xx, yy, zz, xy, xz, yz = numbers(full)
    moments = matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    axes = turned * own
    return mpf(mass), place + turned * centre, axes * moments * axes.T


def gather_free(parts: Any, frame: Any, omega: Any, place: Any, velocity: Any) -> Described:
    """Return a body that nothing holds, about its centre of mass, which rests in the origin."""
    whole = gather(parts, frame, omega)
    centre = whole.weighted / whole.mass
    arm = frame * centre
    rest = matrix(cross(frame * omega, frame * centre))
    assert mp.norm(matrix(place) + arm) < 1e-14 * (1 + mp.norm(arm))
    assert mp.norm(matrix(velocity) + rest) < 1e-13 * (1 + mp.norm(velocity))
    return gather([(mass, c - centre, each) for mass, c, each in parts], frame, omega)


def gather(parts: list[tuple[Any, Any, Any]], frame: Any, omega: Any) -> Described:
    """Return the body that some parts are: mass, centre of mass, and moments about it."""
    moments = mp.zeros(3)
    weighted = mp.zeros(3, 1)
    for mass, centre, each in parts:
        square = (centre.T * centre)[0]
        moments += each + mass * (square * mp.eye(3) - centre * centre.T)
        weighted += mass * centre
    return Described(moments, sum(mass for mass, *_ in parts), weighted, frame, omega)


def numbers(text: str) -> list[Any]:
    return [mpf(float(each)) for each in text.split()]


def vector(text: str) -> Any:
    return matrix(numbers(text))


def rotation(q: list[Any]) -> Any:
    """Return the matrix of a quaternion w, x, y, z of any norm: its columns are turned axes."""
    unit = [each / mp.norm(q) for each in q]
    return matrix([turn(unit, axis) for axis in mp.eye(3).tolist()]).T


def about(axis: int, angle: Any) -> Any:
    """Return the matrix of a rotation about an axis of the frame."""
    return rotation([mp.cos(angle / 2), *(mp.sin(angle / 2) * (k == axis) for k in range(3))])


def turn_by_angles(roll: Any, pitch: Any, yaw: Any) -> Any:
    """Return the matrix of roll, pitch and yaw, as SDF and URDF have them."""
    return about(2, yaw) * about(1, pitch) * about(0, roll)
