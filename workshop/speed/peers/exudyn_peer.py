"""EXUDYN: a rigid body with a Lie-group node, by its explicit Runge-Kutta methods.

The body floats with its centre of mass at the pivot. Two opposite forces, down at 1 m along the
axis and up at the pivot, make the torque of gravity and leave the pivot at rest.
"""

from functools import partial
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    LoadForceVector,
    MarkerBodyPosition,
    NodeRigidBodyRotVecLG,
    ObjectRigidBody,
    SensorNode,
)
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from workshop.speed.peers.peer import RECORDED, Peer, Solution, count_steps

SETTINGS = tuple(2.0**-k for k in (9, 10, 11, 12, 13, 14, 15, 16, 17, 18))  # s


def prepare(method: str, task: Motion, step: float) -> Solution:
    """Assemble the systems, one of them with a sensor that records; each solution starts anew."""
    plain, node = _build_system(task)
    recording, recorded_node = _build_system(task)
    sensor = recording.AddSensor(
        SensorNode(
            nodeNumber=recorded_node,
            storeInternal=True,
            outputVariableType=exu.OutputVariableType.RotationMatrix,
        )
    )
    for system in (plain, recording):
        system.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.explicit.useLieGroupIntegration = True

    def run(system: Any, t: float) -> None:
        settings.timeIntegration.endTime = t
        settings.timeIntegration.numberOfSteps = count_steps(t, step)
        settings.solution.sensors.writePeriod = max(step, t / RECORDED)
        system.SolveDynamic(settings, solverType=getattr(exu.DynamicSolverType, method))

    def reach(t: float) -> Real:
        run(plain, t)
        matrix = plain.GetNodeOutput(node, exu.OutputVariableType.RotationMatrix)
        return np.asarray(_read(np.reshape(matrix, (1, 9)))[0])

    def record(t: float) -> tuple[Real, Real]:
        run(recording, t)
        table = recording.GetSensorStoredData(sensor)[1:]
        # Its own times are sums of steps, which round. The steps are powers of two.
        times = np.rint(table[:, 0] / step) * step
        return times, _read(table[:, 1:10])

    return Solution(reach, record)


def _read(matrices: Real) -> Real:
    """Return quaternions (n, 4) from rotation matrices (n, 9)."""
    turns = Rotation.from_matrix(matrices.reshape(-1, 3, 3))
    return np.asarray(turns.as_quat()[:, [3, 0, 1, 2]])


def _build_system(task: Motion) -> tuple[Any, Any]:
    """Return a system with the top, and the number of its node."""
    system = exu.SystemContainer().AddSystem()
    Ix, Iz, Mgl = task.top.moments
    w, x, y, z = task.start.orientation.tolist()
    rotation = Rotation.from_quat([x, y, z, w]).as_rotvec().tolist()
    omega = task.start.angular_velocity.tolist()
    node = system.AddNode(
        NodeRigidBodyRotVecLG(
            referenceCoordinates=[0.0] * 6,
            initialCoordinates=[0.0, 0.0, 0.0, *rotation],
            initialVelocities=[0.0, 0.0, 0.0, *omega],
        )
    )
    inertia = [Ix, Ix, Iz, 0.0, 0.0, 0.0]
    body = system.AddObject(ObjectRigidBody(nodeNumber=node, mass=1.0, inertia=inertia))
    for height, force in ((1.0, -Mgl), (0.0, Mgl)):
        place = [0.0, 0.0, height]
        marker = system.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=place))
        system.AddLoad(LoadForceVector(markerNumber=marker, loadVector=[0.0, 0.0, force]))
    return system, node


PEERS = [Peer(f"EXUDYN {name}", SETTINGS, partial(prepare, name)) for name in ("RK44", "RK67")]
