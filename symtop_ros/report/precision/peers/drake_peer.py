"""Drake: a body on a ball joint with roll, pitch and yaw."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RollPitchYaw, RotationMatrix
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import BallRpyJoint, SpatialInertia, UnitInertia
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator

from symtop_ros.report.precision.peers.peer import Peer, Real, Solve, Task

SCHEMES = {"RK3": "runge_kutta3", "RK5": "runge_kutta5"}
ACCURACIES = {
    name: tuple(10.0**-k for k in range(3, last)) for name, last in (("RK3", 10), ("RK5", 14))
}
LARGEST_STEP = 0.1  # s
GRAVITY = 10.0  # m/s^2


def prepare(scheme: str, task: Task, accuracy: float) -> Solve:
    """Build the model and its simulator; a solution goes back to the start first."""
    plant, joint = _plant(task)
    simulator = Simulator(plant)
    integrator = ResetIntegratorFromFlags(simulator, scheme, LARGEST_STEP)
    integrator.set_target_accuracy(accuracy)
    integrator.set_fixed_step_mode(False)
    context = simulator.get_mutable_context()
    orientation, angular_velocity = task.start.orientation, task.start.angular_velocity
    turned = RotationMatrix(Quaternion(orientation))
    angles = RollPitchYaw(turned).vector()
    spin = turned.matrix() @ angular_velocity

    def solve(t: float) -> Real:
        context.SetTime(0.0)
        joint.set_angles(context, angles)
        joint.set_angular_velocity(context, spin)
        simulator.Initialize()
        simulator.AdvanceTo(t)
        q = RollPitchYaw(joint.get_angles(context)).ToQuaternion()
        return np.array([q.w(), q.x(), q.y(), q.z()])

    return solve


def _plant(task: Task) -> tuple[Any, Any]:
    Ix, Iz, Mgl = task.top.moments
    arm = Ix / 2 * GRAVITY / Mgl if Mgl else 0.0
    mass = Mgl / (GRAVITY * arm) if Mgl else 1.0
    plant = MultibodyPlant(time_step=0.0)
    unit = UnitInertia(Ix / mass, Ix / mass, Iz / mass)
    body = plant.AddRigidBody("top", SpatialInertia(mass, [0.0, 0.0, arm], unit))
    joint = plant.AddJoint(
        BallRpyJoint(
            "pivot",
            plant.world_frame(),
            body.body_frame(),
        )
    )
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -GRAVITY])
    plant.Finalize()
    return plant, joint


PEERS = [
    Peer(f"Drake {name}", ACCURACIES[name], partial(prepare, scheme))
    for name, scheme in SCHEMES.items()
]
