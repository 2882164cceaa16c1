"""EXUDYN: a rigid body with a Lie-group node, by its explicit Runge-Kutta methods.

The body is free; a force at the pivot takes the weight, so that the pivot rests.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    LoadForceVector,
    MarkerBodyPosition,
    NodeRigidBodyRotVecLG,
    ObjectRigidBody,
)
from scipy.spatial.transform import Rotation

from symtop_ros.report.precision.peers.peer import Peer, Real, Solve, Task, steps

METHODS = {"RK44": exu.DynamicSolverType.RK44, "RK67": exu.DynamicSolverType.RK67}
SETTINGS = (3.125e-3, 1e-3, 3.125e-4, 1e-4, 3.125e-5)  # s


def prepare(method: Any, task: Task, step: float) -> Solve:
    """Assemble the system; it starts from its initial values each time."""
    system = exu.SystemContainer().AddSystem()
    node = _add_top(system, task)
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.explicit.useLieGroupIntegration = True

    def solve(t: float) -> Real:
        settings.timeIntegration.endTime = t
        settings.timeIntegration.numberOfSteps = steps(t, step)
        system.SolveDynamic(settings, solverType=method)
        turn = np.reshape(system.GetNodeOutput(node, exu.OutputVariableType.RotationMatrix), (3, 3))
        return np.asarray(Rotation.from_matrix(turn).as_quat()[[3, 0, 1, 2]])

    return solve


def _add_top(system: Any, task: Task) -> Any:
    Ix, Iz, Mgl = task.top.moments
    w, x, y, z = task.start.orientation.tolist()
    turned = Rotation.from_quat([x, y, z, w]).as_rotvec().tolist()
    omega = task.start.angular_velocity.tolist()
    node = system.AddNode(
        NodeRigidBodyRotVecLG(
            referenceCoordinates=[0.0] * 6,
            initialCoordinates=[0.0, 0.0, 0.0, *turned],
            initialVelocities=[0.0, 0.0, 0.0, *omega],
        )
    )
    inertia = [Ix, Ix, Iz, 0.0, 0.0, 0.0]
    body = system.AddObject(ObjectRigidBody(nodeNumber=node, mass=1.0, inertia=inertia))
    for height, force in ((1.0, -Mgl), (0.0, Mgl)):
        place = [0.0, 0.0, height]
        marker = system.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=place))
        system.AddLoad(LoadForceVector(markerNumber=marker, loadVector=[0.0, 0.0, force]))
    return node


PEERS = [
    Peer(f"EXUDYN {name}", SETTINGS, partial(prepare, method)) for name, method in METHODS.items()
]
