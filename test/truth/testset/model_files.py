"""Model files as other engines read them: what they say of a body and its start, in mpmath."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

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
    found = []
    place = None if joint is None else joint.find("pose")
    pivot = vector(ZERO if place is None else " ".join(place.text.split()[:3]))
    for link in model.findall("link"):
        place = link.find("pose")
        *shift, roll, pitch, yaw = numbers("0 0 0 0 0 0" if place is None else place.text)
        inertia = link.find("inertial")
        *centre, a, b, c = numbers(inertia.find("pose").text)
        full = " ".join(inertia.find(f"inertia/{name}").text for name in MOMENTS)
        turned = turn_by_angles(roll, pitch, yaw), turn_by_angles(a, b, c)
        mass = inertia.find("mass").text
        found.append(place_part(mass, matrix(centre), full, turned, matrix(shift) - pivot))
    *origin, x, y, z, w = numbers(model.find("pose").text)
    omega = vector(re.search(r"angular velocity (\S+ \S+ \S+) rad/s", text)[1])
    if joint is not None:
        return gather(found, rotation([w, x, y, z]), omega)
    moving = re.search("moves with (.+) m/s", text)
    velocity = numbers(moving[1] if moving else ZERO)
    return gather_free(found, rotation([w, x, y, z]), omega, origin, velocity)


def read_urdf(root: Element, text: str) -> Described:
    spin, fixed = root.find("joint[@name='spin']"), root.find("joint[@name='fixed']")
    frames = [("top", mp.eye(3), vector(ZERO))]
    if fixed is not None:
        turned = turn_by_angles(*read_origin(fixed, "rpy"))
        frames.append(("top_part", turned, matrix(read_origin(fixed, "xyz"))))
    found = []
    for name, turned, place in frames:
        inertial = root.find(f"link[@name='{name}']/inertial")
        full = " ".join(inertial.find("inertia").get(each) for each in MOMENTS)
        centre = matrix(read_origin(inertial, "xyz"))
        turns = turned, turn_by_angles(*read_origin(inertial, "rpy"))
        found.append(place_part(inertial.find("mass").get("value"), centre, full, turns, place))
    if spin is None:
        x, y, z, w = numbers(re.search("x, y, z, w (.+), angular", text)[1])
        omega = vector(re.search("angular velocity (.+) rad/s", text)[1])
        moving = re.search("place (.+) m and velocity (.+) m/s", text)
        origin, velocity = map(numbers, moving.groups() if moving else (ZERO, ZERO))
        return gather_free(found, rotation([w, x, y, z]), omega, origin, velocity)
    frame = turn_by_angles(*read_origin(spin, "rpy"))
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
    pivot, fixed = prims.get("pivot"), prims.get("fixed")
    held = tuple_of(pivot, "physics:localPos1") if pivot else mp.zeros(3, 1)
    frames = [("top", mp.eye(3), -held)]
    if fixed:
        turned = rotation(list(tuple_of(fixed, "physics:localRot0")))
        frames.append(("part", turned, tuple_of(fixed, "physics:localPos0")))
    found = [place_body(prims[name], turned, place) for name, turned, place in frames]
    frame = rotation(list(tuple_of(prims["start_top"], "xformOp:orient")))
    omega = tuple_of(prims["top"], "physics:angularVelocity") * mp.pi / 180
    origin = tuple_of(prims["start_top"], "xformOp:translate")
    for name, turned, place in frames:
        start = prims[f"start_{name}"]
        prim = prims[name]
        at, centre = tuple_of(start, "xformOp:translate"), tuple_of(prim, "physics:centerOfMass")
        arm = place + turned * centre if pivot else mp.zeros(3, 1)
        own = tuple_of(prim, "physics:angularVelocity") * mp.pi / 180
        size = mp.norm(omega)
        assert mp.norm(turned * own - omega) <= 1e-15 * size
        moving = turned * tuple_of(prim, "physics:velocity") - matrix(cross(omega, arm))
        assert mp.norm(moving) <= 1e-14 * size * (1 + mp.norm(arm))
        turning = rotation(list(tuple_of(start, "xformOp:orient"))) - frame * turned
        assert mp.mnorm(turning) < 1e-15
        apart = at - origin - frame * (place - frames[0][2])
        assert mp.norm(apart) < 1e-15 * (1 + mp.norm(at))
    if pivot:
        assert float(re.search("gravityMagnitude = (.*)", text)[1]) == 9.81
        return gather(found, frame, omega)
    whole = gather(found, frame, omega)
    velocity = -frame * matrix(cross(omega, whole.weighted / whole.mass))
    return gather_free(found, frame, omega, list(origin), list(velocity))


def tuple_of(prim: dict[str, str], name: str) -> Any:
    return vector(prim[name].replace(",", " "))


def place_body(prim: dict[str, str], turned: Any, place: Any) -> tuple[Any, Any, Any]:
    """Return mass, centre of mass and moments of a body of a stage, as `place_part` does."""
    axes = turned * rotation(list(tuple_of(prim, "physics:principalAxes")))
    moments = axes * mp.diag(list(tuple_of(prim, "physics:diagonalInertia"))) * axes.T
    centre = place + turned * tuple_of(prim, "physics:centerOfMass")
    return mpf(float(prim["physics:mass"])), centre, moments


def read_origin(element: Element, name: str) -> list[Any]:
    origin = element.find("origin")
    return numbers(ZERO if origin is None else origin.get(name, ZERO))


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
