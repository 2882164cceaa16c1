"""Model files as other engines read them: what they say of a body and its start, in mpmath."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from mpmath import matrix, mp, mpf

DIGITS = 30
ZERO = "0 0 0"


@dataclass(frozen=True)
class Described:
    """A body and its start in the frame of its link, with the pivot in the origin."""

    moments: Any  # matrix (3, 3) about the pivot, kg m^2
    mass: Any
    weighted: Any  # mass times the centre of mass, kg m, (3, 1)
    orientation: tuple[Any, ...]
    angular_velocity: tuple[Any, ...]


def read_model(path: Path) -> Described:
    """Return what a MJCF, SDF or URDF file says."""
    root = ElementTree.parse(path).getroot()
    read = {"mjcf": read_mjcf, "sdf": read_sdf, "urdf": read_urdf}[path.suffix[1:]]
    with mp.workdps(DIGITS):
        return read(root, path.read_text())


def read_mjcf(root: Element, _: str) -> Described:
    link = root.find("worldbody/body")
    joint, child = link.find("joint"), link.find("body")
    pivot = vector(ZERO if joint is None else joint.get("pos", ZERO))
    parts = [(link, mp.eye(3), vector(ZERO))]
    if child is not None:
        parts.append((child, rotation(numbers(child.get("quat"))), vector(child.get("pos"))))
    found = []
    for body, turn, place in parts:
        if (inertial := body.find("inertial")) is not None:
            full = inertial.get("fullinertia") or f"{inertial.get('diaginertia')} 0 0 0"
            mass, centre = mpf(inertial.get("mass")), vector(inertial.get("pos"))
            found.append((mass, place + turn * centre - pivot, turn * tensor(full) * turn.T))
    key = root.find("keyframe/key")
    qpos, qvel = numbers(key.get("qpos")), numbers(key.get("qvel"))
    if joint is not None:
        return gather(found, unit(qpos), qvel)
    return gather_free(found, unit(qpos[3:]), qvel[3:], qpos[:3], qvel[:3])


def read_sdf(root: Element, text: str) -> Described:
    model = root.find("world/model")
    joint, found = model.find("joint[@type='ball']"), []
    place = None if joint is None else joint.find("pose")
    pivot = vector(ZERO if place is None else " ".join(place.text.split()[:3]))
    for link in model.findall("link"):
        place = link.find("pose")
        *shift, roll, pitch, yaw = numbers("0 0 0 0 0 0" if place is None else place.text)
        turn, inertia = turn_by_angles(roll, pitch, yaw), link.find("inertial")
        centre = vector(" ".join(inertia.find("pose").text.split()[:3]))
        names = "ixx", "iyy", "izz", "ixy", "ixz", "iyz"
        full = tensor(" ".join(inertia.find(f"inertia/{name}").text for name in names))
        mass = mpf(inertia.find("mass").text)
        found.append((mass, matrix(shift) + turn * centre - pivot, turn * full * turn.T))
    *origin, x, y, z, w = numbers(model.find("pose").text)
    omega = numbers(re.search(r"angular velocity (\S+ \S+ \S+) rad/s", text)[1])
    if joint is not None:
        return gather(found, unit([w, x, y, z]), omega)
    moving = re.search("moves with (.+) m/s", text)
    return gather_free(
        found, unit([w, x, y, z]), omega, origin, numbers(moving[1] if moving else ZERO)
    )


def read_urdf(root: Element, text: str) -> Described:
    spin, fixed = root.find("joint[@name='spin']"), root.find("joint[@name='fixed']")
    parts = [("top", mp.eye(3), vector(ZERO))]
    if fixed is not None:
        turn = turn_by_angles(*read_origin(fixed, "rpy"))
        parts.append(("top_part", turn, matrix(read_origin(fixed, "xyz"))))
    found = []
    for name, turn, place in parts:
        inertial = root.find(f"link[@name='{name}']/inertial")
        names = "ixx", "iyy", "izz", "ixy", "ixz", "iyz"
        full = tensor(" ".join(inertial.find("inertia").get(each) for each in names))
        mass = mpf(inertial.find("mass").get("value"))
        centre = matrix(read_origin(inertial, "xyz"))
        found.append((mass, place + turn * centre, turn * full * turn.T))
    if spin is None:
        x, y, z, w = numbers(re.search("x, y, z, w (.+), angular", text)[1])
        omega = numbers(re.search("angular velocity (.+) rad/s", text)[1])
        moving = re.search("place (.+) m and velocity (.+) m/s", text)
        origin, velocity = map(numbers, moving.groups() if moving else (ZERO, ZERO))
        return gather_free(found, unit([w, x, y, z]), omega, origin, velocity)
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
    return gather(found, quaternion(turns[0] * turns[1] * turns[2] * turns[3]), list(omega))


def read_origin(element: Element, name: str) -> list[Any]:
    origin = element.find("origin")
    return numbers(ZERO if origin is None else origin.get(name, ZERO))


def gather_free(parts: Any, q: Any, omega: Any, place: Any, velocity: Any) -> Described:
    """Return a body that nothing holds, about its centre of mass, which rests in the origin."""
    whole = gather(parts, q, omega)
    centre, R = whole.weighted / whole.mass, rotation(q)
    arm = R * centre
    assert mp.norm(matrix(place) + arm) < 1e-14 * (1 + mp.norm(arm))
    assert mp.norm(matrix(velocity) + cross(R * matrix(omega), arm)) < 1e-13 * (
        1 + mp.norm(velocity)
    )
    return gather([(mass, c - centre, each) for mass, c, each in parts], q, omega)


def gather(parts: list[tuple[Any, Any, Any]], q: Any, omega: Any) -> Described:
    """Return the body that some parts are: mass, centre of mass, and moments about it."""
    moments, weighted = mp.zeros(3), mp.zeros(3, 1)
    for mass, centre, each in parts:
        square = (centre.T * centre)[0]
        moments += each + mass * (square * mp.eye(3) - centre * centre.T)
        weighted += mass * centre
    mass = sum((mass for mass, *_ in parts), mpf(0))
    return Described(moments, mass, weighted, tuple(q), tuple(omega))


def numbers(text: str) -> list[Any]:
    return [mpf(float(each)) for each in text.split()]


def vector(text: str) -> Any:
    return matrix(numbers(text))


def tensor(text: str) -> Any:
    xx, yy, zz, xy, xz, yz = numbers(text)
    return matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def cross(a: Any, b: Any) -> Any:
    return matrix([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def unit(q: list[Any]) -> list[Any]:
    return [each / mp.norm(q) for each in q]


def rotation(q: list[Any]) -> Any:
    w, x, y, z = unit(q)
    return matrix(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    )


def quaternion(R: Any) -> list[Any]:
    """Return the quaternion of a matrix, by its largest component."""
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    squares = [1 + trace, *(1 + 2 * R[k, k] - trace for k in range(3))]
    largest = max(range(4), key=lambda k: squares[k])
    w, x, y, z = squares
    rows = (
        (w, R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]),
        (R[2, 1] - R[1, 2], x, R[0, 1] + R[1, 0], R[0, 2] + R[2, 0]),
        (R[0, 2] - R[2, 0], R[0, 1] + R[1, 0], y, R[1, 2] + R[2, 1]),
        (R[1, 0] - R[0, 1], R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], z),
    )
    return unit(list(rows[largest]))


def about(axis: int, angle: Any) -> Any:
    """Return the matrix of a rotation about an axis of the frame."""
    q = [mp.cos(angle / 2), mpf(0), mpf(0), mpf(0)]
    q[axis + 1] = mp.sin(angle / 2)
    return rotation(q)


def turn_by_angles(roll: Any, pitch: Any, yaw: Any) -> Any:
    """Return the matrix of roll, pitch and yaw, as SDF and URDF have them."""
    return about(2, yaw) * about(1, pitch) * about(0, roll)
