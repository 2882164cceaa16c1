"""Drake: a body that floats, with a quaternion, and a body on a ball joint with three angles.

The floating body has its centre of mass at the pivot and moments about the pivot. Two opposite
forces, down at 1 m along the axis and up at the pivot, make the torque of gravity and leave the
pivot at rest. This form has no pole, takes fixed steps, and is by far the more exact one.
"""

from functools import partial
from typing import Any

import numpy as np
from pydrake.common.eigen_geometry import Quaternion
from pydrake.common.value import AbstractValue
from pydrake.math import RollPitchYaw, RotationMatrix
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.multibody.tree import SpatialInertia, UnitInertia
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import DiagramBuilder, EventStatus
from pydrake.systems.primitives import ConstantValueSource

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Body, Motion, State
from symtop_ros.run.models.engines import format_sdf
from workshop.speed.peers.peer import Peer, Solution, normalize

SCHEMES = {"RK3": "runge_kutta3", "RK5": "runge_kutta5"}
# At order 3 an accuracy of 1e-10 takes 3 million steps for ten seconds.
ACCURACIES = {
    name: tuple(10.0**-k for k in range(3, last)) for name, last in (("RK3", 11), ("RK5", 16))
}
STEPS = tuple(2.0**-k for k in range(9, 20))  # s
LARGEST_STEP = 0.1  # s


def prepare_quaternion(scheme: str, task: Motion, step: float) -> Solution:
    """Build the floating body and its simulator with fixed steps; each solution starts anew."""
    simulator, plant = _build_floating_body(task)
    integrator = ResetIntegratorFromFlags(simulator, scheme, step)
    integrator.set_fixed_step_mode(True)
    root = simulator.get_mutable_context()
    context = plant.GetMyMutableContextFromRoot(root)
    rotation = RotationMatrix(Quaternion(task.start.orientation)).matrix()
    start = [*task.start.orientation, 0.0, 0.0, 0.0]
    velocity = [*(rotation @ task.start.angular_velocity), 0.0, 0.0, 0.0]

    def begin() -> None:
        root.SetTime(0.0)
        plant.SetPositions(context, start)
        plant.SetVelocities(context, velocity)
        simulator.Initialize()

    return Solution.of_fixed_steps(
        step,
        begin,
        advance=lambda steps: simulator.AdvanceTo(root.get_time() + steps * step),
        read=lambda: normalize(plant.GetPositions(context)[:4]),
    )


def _build_floating_body(task: Motion) -> tuple[Simulator, Any]:
    Ix, Iz, Mgl = task.top.moments
    builder = DiagramBuilder()
    plant = builder.AddSystem(MultibodyPlant(time_step=0.0))
    inertia = SpatialInertia(1.0, [0.0, 0.0, 0.0], UnitInertia(Ix, Ix, Iz))
    body = plant.AddRigidBody("top", inertia)
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
    plant.Finalize()
    forces = [_make_force(body, 1.0, -Mgl), _make_force(body, 0.0, Mgl)]
    source = builder.AddSystem(ConstantValueSource(AbstractValue.Make(forces)))
    builder.Connect(source.get_output_port(), plant.get_applied_spatial_force_input_port())
    return Simulator(builder.Build()), plant


def _make_force(body: Any, height: float, upward: float) -> ExternallyAppliedSpatialForce:
    force = ExternallyAppliedSpatialForce()
    force.body_index = body.index()
    force.p_BoBq_B = [0.0, 0.0, height]
    force.F_Bq_W = SpatialForce(tau=[0.0, 0.0, 0.0], f=[0.0, 0.0, upward])
    return force


def prepare_ball_joint(scheme: str, task: Motion, accuracy: float) -> Solution:
    """Build the body on a joint and its simulator with error control; solutions start anew."""
    plant, joint = _build_ball_joint(task)
    simulator = Simulator(plant)
    integrator = ResetIntegratorFromFlags(simulator, scheme, LARGEST_STEP)
    integrator.set_target_accuracy(accuracy)
    integrator.set_fixed_step_mode(False)
    context = simulator.get_mutable_context()
    rotation = RotationMatrix(Quaternion(task.start.orientation))
    angles = RollPitchYaw(rotation).vector()
    world_angular_velocity = rotation.matrix() @ task.start.angular_velocity

    def read() -> Real:
        q = RollPitchYaw(joint.get_angles(context)).ToQuaternion()
        return np.array([q.w(), q.x(), q.y(), q.z()])

    def reach(t: float) -> Real:
        context.SetTime(0.0)
        joint.set_angles(context, angles)
        joint.set_angular_velocity(context, world_angular_velocity)
        simulator.Initialize()
        simulator.AdvanceTo(t)
        return read()

    def run(t: float) -> tuple[Real, Real]:
        steps: dict[float, Real] = {}

        def store(_: Any) -> EventStatus:
            steps[context.get_time()] = read()
            return EventStatus.DidNothing()

        simulator.set_monitor(store)
        reach(t)
        simulator.clear_monitor()
        return np.array([*steps]), np.array([*steps.values()])

    return Solution.of_steps(lambda t: reach(t)[np.newaxis], run, read=lambda _, y: y)


def _build_ball_joint(task: Motion) -> tuple[Any, Any]:
    """Return the body of the SDF of `top_model`, turned back to where the angles are zero."""
    upright = State((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    plant = MultibodyPlant(time_step=0.0)
    Parser(plant).AddModelsFromString(format_sdf(task.top, upright, Body.from_top(task.top)), "sdf")
    plant.Finalize()
    return plant, plant.GetJointByName("pivot")


PEERS = [
    *(
        Peer(f"Drake {name}, quaternion", STEPS, partial(prepare_quaternion, scheme))
        for name, scheme in SCHEMES.items()
    ),
    *(
        Peer(f"Drake {name}, three angles", ACCURACIES[name], partial(prepare_ball_joint, scheme))
        for name, scheme in SCHEMES.items()
    ),
]
