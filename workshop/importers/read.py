"""Read models by an importer: runs in the environment of the importer, with NumPy alone.

    python read.py NAME FILE...

It prints JSON: the version, and of each file what the whole body has in the frame of the link
"top": mass, centre of mass (3,) and the moments about it (3, 3); or the reason of a refusal.
"""

import contextlib
import io
import json
import os
import sys
from collections.abc import Callable, Iterable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

# Mass (kg), centre of mass (m), and moments about it (kg m^2), in some frame: of parts of a body.
Part = tuple[float, Any, Any]
LEAST = 1e-12  # kg; lighter links have a mass for MuJoCo only


def gather(
    parts: Iterable[Part], place: Any, turn: Any, kilogram: float = 1.0, metre: float = 1.0
) -> dict[str, Any]:
    """Return parts together, in a frame with a place and a rotation (its axes as columns).

    Numbers may be in other units, which are given.
    """
    place = metre * np.asarray(place)
    parts = [
        (kilogram * m, metre * np.asarray(c), kilogram * metre**2 * np.asarray(own))
        for m, c, own in parts
        if kilogram * m > LEAST
    ]
    if not parts:
        return {"refused": "no mass is read"}
    mass = sum(each[0] for each in parts)
    centre = sum(m * c for m, c, _ in parts) / mass
    moments = np.zeros((3, 3))
    for m, c, own in parts:
        arm = c - centre
        moments += own + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    found = {"centre": turn.T @ (centre - place), "moments": turn.T @ moments @ turn}
    return {"mass": float(mass), **{name: each.tolist() for name, each in found.items()}}


def rotate(w: float, x: float, y: float, z: float) -> Any:
    """Return the matrix of a quaternion."""
    w, x, y, z = np.array([w, x, y, z]) / np.linalg.norm([w, x, y, z])
    return np.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w + y * y - x * x - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w + z * z - x * x - y * y],
        ]
    )


def read_mujoco(path: str) -> dict[str, Any]:
    """Return what MuJoCo reads of MJCF and URDF."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    parts = []
    for k in range(model.nbody):
        turn = data.ximat[k].reshape(3, 3)
        own = turn @ np.diag(model.body_inertia[k]) @ turn.T
        parts.append((model.body_mass[k], data.xipos[k], own))
    top = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "top")
    return gather(parts, data.xpos[top], data.xmat[top].reshape(3, 3))


def read_pinocchio(path: str) -> dict[str, Any]:
    """Return what Pinocchio reads of URDF and MJCF; that of PyPI has no SDF."""
    import pinocchio

    build = pinocchio.buildModelFromMJCF if path.endswith("mjcf") else pinocchio.buildModelFromUrdf
    model = build(path)
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, pinocchio.neutral(model))
    parts = []
    for own, place in zip(model.inertias, data.oMi, strict=True):
        turn = place.rotation
        centre = place.translation + turn @ own.lever
        parts.append((own.mass, centre, turn @ own.inertia @ turn.T))
    frame = data.oMf[model.getFrameId("top", pinocchio.FrameType.BODY)]
    return gather(parts, frame.translation, frame.rotation)


def read_drake(path: str) -> dict[str, Any]:
    """Return what Drake reads of URDF, SDF and MJCF."""
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import BodyIndex

    plant = MultibodyPlant(time_step=0.0)
    kind = path.rpartition(".")[2].replace("mjcf", "xml")
    Parser(plant).AddModelsFromString(Path(path).read_text(), kind)
    plant.Finalize()
    context = plant.CreateDefaultContext()
    parts = []
    for k in range(1, plant.num_bodies()):
        body = plant.get_body(BodyIndex(k))
        own = body.CalcSpatialInertiaInBodyFrame(context)
        pose = body.EvalPoseInWorld(context)
        turn = pose.rotation().matrix()
        mass = own.get_mass()
        if mass <= LEAST:
            continue
        about = own.CalcRotationalInertia().CopyToFullMatrix3()
        arm = own.get_com()
        about = about - mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        parts.append((mass, pose.translation() + turn @ arm, turn @ about @ turn.T))
    pose = plant.GetBodyByName("top").EvalPoseInWorld(context)
    return gather(parts, pose.translation(), pose.rotation().matrix())


def read_pybullet(path: str) -> dict[str, Any]:
    """Return what pybullet reads of URDF, SDF and MJCF; a flag asks for the moments of the file."""
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    pybullet.resetSimulation()
    flag = pybullet.URDF_USE_INERTIA_FROM_FILE
    if path.endswith("urdf"):
        body = pybullet.loadURDF(path, flags=flag)
    elif path.endswith("sdf"):
        (body,) = pybullet.loadSDF(path)
    else:
        body = pybullet.loadMJCF(path, flags=flag)[-1]
    links = {"base": -1}
    names = {pybullet.getBodyInfo(body)[0].decode(): -1}
    for k in range(pybullet.getNumJoints(body)):
        names[pybullet.getJointInfo(body, k)[12].decode()] = k
    parts, frames = [], {}
    for name, k in (names | links).items():
        info = pybullet.getDynamicsInfo(body, k)
        x, y, z, w = info[4]
        own, centre = rotate(w, x, y, z), np.array(info[3])
        if k < 0:
            (*place,), (x, y, z, w) = pybullet.getBasePositionAndOrientation(body)
            turn = rotate(w, x, y, z) @ own.T  # that of the inertial frame is given
            place = np.array(place) - turn @ centre
        else:
            state = pybullet.getLinkState(body, k)
            x, y, z, w = state[5]
            place, turn = np.array(state[4]), rotate(w, x, y, z)
        frames[name] = place, turn
        if name != "base":
            axes = turn @ own
            parts.append((info[0], place + turn @ centre, axes @ np.diag(info[2]) @ axes.T))
    return gather(parts, *frames.get("top", frames["base"]))


def read_newton(path: str) -> dict[str, Any]:
    """Return what Newton reads of MJCF, URDF and USD, in single precision.

    It keeps the units of a stage, its gravity as well, and returns them.
    """
    import newton
    import warp

    warp.config.quiet = True
    builder = newton.ModelBuilder()
    kind = path.rpartition(".")[2]
    add = {"mjcf": builder.add_mjcf, "urdf": builder.add_urdf, "usda": builder.add_usd}[kind]
    units = add(path) or {}
    model = builder.finalize(device="cpu")
    state = model.state()
    newton.eval_fk(model, model.joint_q, model.joint_qd, state)
    frames = state.body_q.numpy().astype(float)
    parts = []
    for k in range(builder.body_count):
        x, y, z, w = frames[k][3:]
        turn = rotate(w, x, y, z)
        own = np.array(builder.body_inertia[k], float).reshape(3, 3)
        centre = frames[k][:3] + turn @ np.array(builder.body_com[k])
        parts.append((builder.body_mass[k], centre, turn @ own @ turn.T))
    labels = [each.rpartition("/")[2] for each in builder.body_label]
    top = labels.index("top") if "top" in labels else builder.body_count - 1
    x, y, z, w = frames[top][3:]
    given = [units.get(name, 1.0) for name in ("mass_unit", "linear_unit")]
    return gather(parts, frames[top][:3], rotate(w, x, y, z), *given)


def read_usd(path: str) -> dict[str, Any]:
    """Return what the schema's own library gives of the bodies of a stage."""
    from pxr import Usd, UsdGeom, UsdPhysics

    stage = Usd.Stage.Open(path)
    parts, frames = [], {}
    for prim in stage.Traverse():
        if not prim.HasAPI(UsdPhysics.MassAPI):
            continue
        mass = UsdPhysics.MassAPI(prim)
        pose = np.array(UsdGeom.XformCache().GetLocalToWorldTransform(prim)).T
        axes = mass.GetPrincipalAxesAttr().Get()
        turn = pose[:3, :3] @ rotate(axes.GetReal(), *axes.GetImaginary())
        centre = pose[:3, 3] + pose[:3, :3] @ np.array(mass.GetCenterOfMassAttr().Get())
        own = turn @ np.diag(np.array(mass.GetDiagonalInertiaAttr().Get(), float)) @ turn.T
        parts.append((mass.GetMassAttr().Get(), centre, own))
        frames[prim.GetName()] = pose[:3, 3], pose[:3, :3]
    units = UsdPhysics.GetStageKilogramsPerUnit(stage), UsdGeom.GetStageMetersPerUnit(stage)
    return gather(parts, *frames["top"], *units)


READERS: dict[str, tuple[str, Callable[[str], dict[str, Any]]]] = {
    "mujoco": ("mujoco", read_mujoco),
    "pinocchio": ("pin", read_pinocchio),
    "drake": ("drake", read_drake),
    "pybullet": ("pybullet", read_pybullet),
    "newton": ("newton", read_newton),
    "usd-core": ("usd-core", read_usd),
}


def read(function: Callable[[str], dict[str, Any]], path: str) -> dict[str, Any]:
    """Return what is read of a file, or why it is not. A reader fails in its own way."""
    try:
        return function(path)
    except Exception as error:
        lines = str(error).strip().splitlines() or [""]
        return {"refused": f"{type(error).__name__}: {lines[0]}"}


@contextlib.contextmanager
def silence() -> Any:
    """Keep what C and C++ print out of the JSON."""
    kept = os.dup(1)
    os.dup2(2, 1)
    with contextlib.redirect_stdout(io.StringIO()):
        yield
    os.dup2(kept, 1)


def main() -> None:
    """Read the files that are named."""
    name, *paths = sys.argv[1:]
    package, function = READERS[name]
    with silence():
        found = {path: read(function, path) for path in paths}
    print(json.dumps({"version": version(package), "found": found}))


if __name__ == "__main__":
    main()
