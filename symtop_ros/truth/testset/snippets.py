"""The start of a motion as programs for each engine, next to the model files.

Some engines have joint coordinates. Others (Bullet, Jolt, Rapier, PhysX and Havok) hold bodies in
the world: they have the place and the velocity of the centre of mass, and rates in the world frame.
A joint holds the body in the origin there; a body without weight is left free.
"""

from symtop_ros.physics import Body, State
from symtop_ros.run.models.descriptions import join

LARGEST_RATE = 1e6  # rad/s; pybullet stops joints at 100 rad/s
SNIPPETS = """\
## Start in MuJoCo, Drake, Pinocchio, pybullet and Newton

MuJoCo, with the ball joint of the MJCF (`qpos`: w, x, y, z, body to world; `qvel`: body frame):

```python
import mujoco

model = mujoco.MjModel.from_xml_path("{name}.mjcf")
data = mujoco.MjData(model)
data.qpos = [{quaternion}]
data.qvel = [{rates}]
mujoco.mj_forward(model, data)
```

and its trajectory for the scorer, with 16384 steps to each of the 20 times:

```python
steps, duration = 16384, {duration}
model.opt.timestep = duration / 20 / steps
with open("trajectory.csv", "w") as file:
    print(f"# engine: MuJoCo {{mujoco.__version__}}, RK4", file=file)
    print("t,w,x,y,z,wx,wy,wz", file=file)
    for _ in range(20):
        mujoco.mj_step(model, data, nstep=steps)
        print(data.time, *data.qpos, *data.qvel, sep=",", file=file)
```

Drake, with the ball joint of the SDF. Its parent frame is the body's pose at the start, so the
angles begin at zero and the angular velocity is that in the body frame. The angles have a pole:

```python
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

plant = MultibodyPlant(time_step=0.0)
Parser(plant).AddModels("{name}.sdf")
plant.Finalize()
context = plant.CreateDefaultContext()
plant.GetJointByName("pivot").set_angular_velocity(context, [{rates}])
```

Pinocchio, with a spherical joint (`q`: x, y, z, w, body to world; `v`: body frame):

```python
import numpy as np
import pinocchio

model = pinocchio.Model()  # gravity is 9.81 m/s^2
pivot = model.addJoint(0, pinocchio.JointModelSpherical(), pinocchio.SE3.Identity(), "pivot")
moments = np.diag([{moments}])  # about the centre of mass
inertia = pinocchio.Inertia({mass}, np.array([0.0, 0.0, {arm}]), moments)
model.appendBodyToJoint(pivot, inertia, pinocchio.SE3.Identity())
q = np.array([{xyzw}])
v = np.array([{rates}])
```

pybullet, with the three joints of the URDF (precession, tilt, spin), without the damping and the
limits of rates that it has by default:

```python
import pybullet

pybullet.connect(pybullet.DIRECT)
pybullet.setGravity(0, 0, {gravity})
flags = pybullet.URDF_USE_INERTIA_FROM_FILE
top = pybullet.loadURDF("{name}.urdf", useFixedBase=True, flags=flags)
angles, rates = [{angles}], [{euler_rates}]
free = {{"linearDamping": 0, "angularDamping": 0, "jointDamping": 0, "maxJointVelocity": {limit}}}
for joint in range(3):
    pybullet.changeDynamics(top, joint, **free)
    pybullet.setJointMotorControl2(top, joint, pybullet.VELOCITY_CONTROL, force=0)
    pybullet.resetJointState(top, joint, angles[joint], rates[joint])
phi, theta, psi = (pybullet.getJointState(top, joint)[0] for joint in range(3))
```

The attitude is Rz(phi) Rx(theta) Rz(psi); `getLinkState` would round it to single precision.

Newton (`pip install newton mujoco-warp`; single precision), with the ball joint of the MJCF
(`joint_q`: x, y, z, w; `joint_qd`: in the frame of the joint's parent, which is the world):

```python
import newton
import numpy as np

builder = newton.ModelBuilder()
builder.add_mjcf("{name}.mjcf")
model = builder.finalize()
state, following = model.state(), model.state()
state.joint_q.assign(np.array([{xyzw}], dtype=np.float32))
state.joint_qd.assign(np.array([{world_rates}], dtype=np.float32))
newton.eval_fk(model, state.joint_q, state.joint_qd, state)
```

and its trajectory for the scorer:

```python
solver, control = newton.solvers.SolverFeatherstone(model), model.control()
steps, duration = 64, {duration}
with open("trajectory.csv", "w") as file:
    print(f"# engine: Newton {{newton.__version__}}, Featherstone", file=file)
    print("t,w,x,y,z", file=file)
    for k in range(1, 21):
        for _ in range(steps):
            solver.step(state, following, control, None, duration / 20 / steps)
            state, following = following, state
        x, y, z, w = state.joint_q.numpy().tolist()
        print(duration * k / 20, w, x, y, z, sep=",", file=file)
```
"""


def format_snippets(name: str, start: State, body: Body, duration: float) -> str:
    """Return Markdown that starts the models NAME.mjcf, NAME.sdf and NAME.urdf."""
    w, x, y, z = start.orientation.tolist()
    return SNIPPETS.format(
        name=name,
        duration=repr(duration),
        quaternion=join((w, x, y, z), ", "),
        xyzw=join((x, y, z, w), ", "),
        rates=join(start.angular_velocity.tolist(), ", "),
        world_rates=join(start.to_world(start.angular_velocity).tolist(), ", "),
        angles=join(start.euler_angles, ", "),
        euler_rates=join(start.euler_rates, ", "),
        moments=join((body.Ix, body.Ix, body.Iz), ", "),
        mass=repr(body.mass),
        arm=repr(body.arm),
        gravity=repr(-body.gravity),
        limit=LARGEST_RATE,
    )


STEPS = 256  # to each of the 20 times
IN_THE_WORLD = """\
## Start in Bullet, Jolt, Rapier, PhysX, Havok and DART

These hold the centre of mass in the world, and angular velocities in the world frame. `world.csv`
has these quantities at each time. Each program writes a trajectory for the scorer, with {steps}
steps to each of the 20 times; the first two write the version of the engine above it, as a score
is cited. Bullet (C++, `libbullet-dev`), with a joint that its solver holds:

```cpp
#include <btBulletDynamicsCommon.h>
#include <fstream>

int main() {{
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, {gravity}));
  btEmptyShape shape;
  const btQuaternion attitude({xyzw});  // x, y, z, w
  btDefaultMotionState start(btTransform(attitude, btVector3({position})));
  const btVector3 moments({moments});  // about the centre of mass
  btRigidBody top(btRigidBody::btRigidBodyConstructionInfo({mass}, &start, &shape, moments));
  top.setDamping(0, 0);
  top.setActivationState(DISABLE_DEACTIVATION);
  top.setLinearVelocity(btVector3({velocity}));
  top.setAngularVelocity(btVector3({rates}));
  world.addRigidBody(&top);{bullet_joint}
  const int steps = {steps};
  const double duration = {duration};
  std::ofstream file("trajectory.csv");
  file.precision(17);
  file << "# engine: Bullet " << btGetVersion() << "\\n{header}\\n";
  for (int k = 1; k <= 20; k++) {{
    for (int i = 0; i < steps; i++)
      world.stepSimulation(btScalar(duration / 20 / steps), 0);
    const btQuaternion q = top.getOrientation();
    const btVector3 omega = top.getAngularVelocity();
    file << duration * k / 20 << "," << q.w() << "," << q.x() << "," << q.y() << "," << q.z();
    file << "," << omega.x() << "," << omega.y() << "," << omega.z() << "\\n";
  }}
}}
```

    g++ -O2 start.cpp -o start $(pkg-config --cflags --libs bullet-float64) && ./start

Rapier (JavaScript, `npm install @dimforge/rapier3d-compat`; single precision):

```js
import RAPIER from "@dimforge/rapier3d-compat";
import {{ writeFileSync }} from "node:fs";

await RAPIER.init();
const vector = (x, y, z) => ({{ x, y, z }});
const moments = vector({moments}); // about the centre of mass
const world = new RAPIER.World(vector(0, 0, {gravity}));
const start = RAPIER.RigidBodyDesc.dynamic()
  .setRotation({{ {named} }})
  .setLinvel({velocity}) // of the centre of mass
  .setAngvel(vector({rates}))
  .setAdditionalMassProperties({mass}, vector(0, 0, {arm}), moments, RAPIER.RotationOps.identity())
  .setCanSleep(false);
const top = world.createRigidBody(start);{rapier_joint}
const [steps, duration] = [{steps}, {duration}];
world.timestep = duration / 20 / steps;
const rows = [`# engine: Rapier ${{RAPIER.version()}}`, "{header}"];
for (let k = 1; k <= 20; k++) {{
  for (let i = 0; i < steps; i++) world.step();
  const [q, omega] = [top.rotation(), top.angvel()];
  rows.push([(duration * k) / 20, q.w, q.x, q.y, q.z, omega.x, omega.y, omega.z].join());
}}
writeFileSync("trajectory.csv", rows.join("\\n") + "\\n");
```

Jolt (JavaScript, `npm install jolt-physics`; single precision). It stops bodies at 47 rad/s and
damps them unless an option forbids it, and leaves out the gyroscopic torque unless it is asked for:

```js
import initJolt from "jolt-physics";
import {{ writeFileSync }} from "node:fs";

const Jolt = await initJolt();
const pairs = new Jolt.ObjectLayerPairFilterTable(1);
const broad = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
broad.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
const settings = new Jolt.JoltSettings();
settings.mObjectLayerPairFilter = pairs;
settings.mBroadPhaseLayerInterface = broad;
const filter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 1, pairs, 1);
settings.mObjectVsBroadPhaseLayerFilter = filter;
const jolt = new Jolt.JoltInterface(settings);
const system = jolt.GetPhysicsSystem();
system.SetGravity(new Jolt.Vec3(0, 0, {gravity}));
const shape = new Jolt.EmptyShape(new Jolt.Vec3(0, 0, {arm})); // its centre of mass
const attitude = new Jolt.Quat({xyzw}).Normalized();
const start = new Jolt.BodyCreationSettings(
  shape, new Jolt.RVec3(0, 0, 0), attitude, Jolt.EMotionType_Dynamic, 0);
start.mOverrideMassProperties = Jolt.EOverrideMassProperties_MassAndInertiaProvided;
start.mMassPropertiesOverride.mMass = {mass};
start.mMassPropertiesOverride.mInertia = Jolt.Mat44.prototype.sScaleVec3(new Jolt.Vec3({moments}));
start.mApplyGyroscopicForce = true;
start.mLinearDamping = 0;
start.mAngularDamping = 0;
start.mMaxAngularVelocity = 1e6;
start.mAllowSleeping = false;
start.mLinearVelocity = new Jolt.Vec3({velocity});
start.mAngularVelocity = new Jolt.Vec3({rates});
const top = system.GetBodyInterface().CreateBody(start);
system.GetBodyInterface().AddBody(top.GetID(), Jolt.EActivation_Activate);{jolt_joint}
const [steps, duration] = [{steps}, {duration}];
const rows = ["{header}"];
for (let k = 1; k <= 20; k++) {{
  for (let i = 0; i < steps; i++) jolt.Step(duration / 20 / steps, 1);
  const [q, omega] = [top.GetRotation(), top.GetAngularVelocity()];
  const rates = [omega.GetX(), omega.GetY(), omega.GetZ()];
  rows.push([(duration * k) / 20, q.GetW(), q.GetX(), q.GetY(), q.GetZ(), ...rates].join());
}}
writeFileSync("trajectory.csv", rows.join("\\n") + "\\n");
```

PhysX (JavaScript, `npm install physx-js-webidl`; single precision). Its module is for browsers, and
in Node it has to be told that it is in one. Without its flag there is no gyroscopic torque:

```js
import {{ readFileSync, writeFileSync }} from "node:fs";

const node = process;
Object.assign(globalThis, {{ process: undefined, window: globalThis, document: {{}} }});
globalThis.location ??= {{ href: "file:///" }};
const {{ default: initPhysX }} = await import("physx-js-webidl");
const binary = new URL(import.meta.resolve("physx-js-webidl/physx-js-webidl.wasm"));
const PhysX = await initPhysX({{ wasmBinary: readFileSync(binary) }});
globalThis.process = node;
const px = PhysX.PxTopLevelFunctions.prototype;
const vector = (...parts) => new PhysX.PxVec3(...parts);
const place = (point, ...xyzw) => new PhysX.PxTransform(point, new PhysX.PxQuat(...xyzw));
const errors = new PhysX.PxDefaultErrorCallback();
const foundation = px.CreateFoundation(px.PHYSICS_VERSION, new PhysX.PxDefaultAllocator(), errors);
const scale = new PhysX.PxTolerancesScale();
const physics = px.CreatePhysics(px.PHYSICS_VERSION, foundation, scale);
const settings = new PhysX.PxSceneDesc(scale);
settings.gravity = vector(0, 0, {gravity});
settings.cpuDispatcher = px.DefaultCpuDispatcherCreate(0);
settings.filterShader = px.DefaultFilterShader();
const scene = physics.createScene(settings);
const norm = Math.hypot({xyzw});
const attitude = [{xyzw}].map((each) => each / norm);
const top = physics.createRigidDynamic(place(vector(0, 0, 0), ...attitude));
top.setMass({mass});
top.setCMassLocalPose(place(vector(0, 0, {arm}), 0, 0, 0, 1));
top.setMassSpaceInertiaTensor(vector({moments})); // about the centre of mass
top.setRigidBodyFlag(1024, true); // eENABLE_GYROSCOPIC_FORCES
top.setLinearDamping(0);
top.setAngularDamping(0);
top.setMaxAngularVelocity(1e6);
top.setSleepThreshold(0);
top.setSolverIterationCounts(32, 8);
top.setLinearVelocity(vector({velocity})); // of the centre of mass
top.setAngularVelocity(vector({rates}));
scene.addActor(top);{physx_joint}
const [steps, duration] = [{steps}, {duration}];
const rows = ["{header}"];
for (let k = 1; k <= 20; k++) {{
  for (let i = 0; i < steps; i++) {{
    scene.simulate(duration / 20 / steps);
    scene.fetchResults(true);
  }}
  const [{{ q }}, omega] = [top.getGlobalPose(), top.getAngularVelocity()];
  rows.push([(duration * k) / 20, q.w, q.x, q.y, q.z, omega.x, omega.y, omega.z].join());
}}
writeFileSync("trajectory.csv", rows.join("\\n") + "\\n");
```

Havok (JavaScript, `npm install @babylonjs/havok`; single precision). Its moments are those of a
body of 1 kg, and it has no gyroscopic torque: the program adds it as an impulse in each step.

```js
import HavokPhysics from "@babylonjs/havok";
import {{ readFileSync, writeFileSync }} from "node:fs";

const binary = new URL(import.meta.resolve("@babylonjs/havok/lib/esm/HavokPhysics.wasm"));
const HP = await HavokPhysics({{ wasmBinary: readFileSync(binary) }});
const [, world] = HP.HP_World_Create();
HP.HP_World_SetGravity(world, [0, 0, {gravity}]);
HP.HP_World_SetSpeedLimit(world, 1e6, 1e6);
const [, top] = HP.HP_Body_Create();
HP.HP_Body_SetMotionType(top, HP.MotionType.DYNAMIC);
const moments = [{moments}]; // about the centre of mass
const unit = moments.map((each) => each / {mass});
HP.HP_Body_SetMassProperties(top, [[0, 0, {arm}], {mass}, unit, [0, 0, 0, 1]]);
HP.HP_Body_SetLinearDamping(top, 0);
HP.HP_Body_SetAngularDamping(top, 0);
HP.HP_Body_SetQTransform(top, [[0, 0, 0], [{xyzw}]]);
HP.HP_World_AddBody(world, top, false);
HP.HP_Body_SetActivationControl(top, HP.ActivationControl.ALWAYS_ACTIVE);
HP.HP_Body_SetLinearVelocity(top, [{velocity}]); // of the centre of mass
HP.HP_Body_SetAngularVelocity(top, [{rates}]);{havok_joint}
const turn = ([x, y, z, w], [a, b, c]) => {{
  const [t, u, s] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * t + y * s - z * u, b + w * u + z * t - x * s, c + w * s + x * u - y * t];
}};
const [steps, duration] = [{steps}, {duration}];
const step = duration / 20 / steps;
HP.HP_World_SetIdealStepTime(world, step);
const rows = ["{header}"];
for (let k = 1; k <= 20; k++) {{
  for (let i = 0; i < steps; i++) {{
    const [x, y, z, w] = HP.HP_Body_GetQTransform(top)[1][1];
    const [a, b, c] = turn([-x, -y, -z, w], HP.HP_Body_GetAngularVelocity(top)[1]);
    const size = step * (moments[0] - moments[2]) * c;
    HP.HP_Body_ApplyAngularImpulse(top, turn([x, y, z, w], [size * b, -size * a, 0]));
    HP.HP_World_Step(world, step);
  }}
  const [x, y, z, w] = HP.HP_Body_GetQTransform(top)[1][1];
  rows.push([(duration * k) / 20, w, x, y, z, ...HP.HP_Body_GetAngularVelocity(top)[1]].join());
}}
writeFileSync("trajectory.csv", rows.join("\\n") + "\\n");
```

DART (Python, `pip install dartpy`), with a ball joint, whose velocities are in the body frame:

```python
import dartpy as dart
import numpy as np

world = dart.simulation.World()
world.setGravity([0.0, 0.0, {gravity}])
skeleton = dart.dynamics.Skeleton("top")
joint, body = skeleton.createBallJointAndBodyNodePair()
moments = np.diag([{moments}])  # about the centre of mass
body.setInertia(dart.dynamics.Inertia({mass}, [0.0, 0.0, {arm}], moments))
world.addSkeleton(skeleton)
attitude = dart.math.Quaternion({wxyz})
joint.setPositions(dart.dynamics.BallJoint.convertToPositions(attitude.to_rotation_matrix()))
joint.setVelocities([{local_rates}])
steps, duration = {steps}, {duration}
world.setTimeStep(duration / 20 / steps)
with open("trajectory.csv", "w") as file:
    print("t,w,x,y,z,wx,wy,wz", file=file)
    for k in range(1, 21):
        for _ in range(steps):
            world.step()
        q = dart.math.Quaternion(body.getTransform().rotation()).wxyz()
        print(duration * k / 20, *q, *joint.getVelocities(), sep=",", file=file)
```
"""
JOINTS = {
    "bullet_joint": """
  btPoint2PointConstraint pivot(top, btVector3(0, 0, {below}));
  world.addConstraint(&pivot);""",
    "rapier_joint": """
const pivot = world.createRigidBody(RAPIER.RigidBodyDesc.fixed());
const joint = RAPIER.JointData.spherical(vector(0, 0, 0), vector(0, 0, 0));
world.createImpulseJoint(joint, pivot, top, true);""",
    "physx_joint": """
const pivot = place(vector(0, 0, 0), 0, 0, 0, 1);
px.SphericalJointCreate(physics, null, pivot, top, pivot);""",
    "havok_joint": """
const [, pivot] = HP.HP_Body_Create();
HP.HP_Body_SetMotionType(pivot, HP.MotionType.STATIC);
HP.HP_World_AddBody(world, pivot, false);
const [, joint] = HP.HP_Constraint_Create();
HP.HP_Constraint_SetParentBody(joint, pivot);
HP.HP_Constraint_SetChildBody(joint, top);
HP.HP_Constraint_SetAnchorInParent(joint, [0, 0, 0], [1, 0, 0], [0, 1, 0]);
HP.HP_Constraint_SetAnchorInChild(joint, [0, 0, 0], [1, 0, 0], [0, 1, 0]);
for (const name of ["LINEAR_X", "LINEAR_Y", "LINEAR_Z"])
  HP.HP_Constraint_SetAxisMode(
    joint, HP.ConstraintAxis[name], HP.ConstraintAxisLimitMode.LOCKED);
HP.HP_Constraint_SetEnabled(joint, true);""",
    "jolt_joint": """
const pivot = new Jolt.PointConstraintSettings(); // in the origin of the world
system.AddConstraint(pivot.Create(Jolt.JoltInterface.prototype.sGetFixedToWorldBody(), top));""",
}


def format_world_snippets(start: State, body: Body, duration: float) -> str:
    """Return Markdown with programs that start a motion in the world frame."""
    w, x, y, z = start.orientation.tolist()
    has_weight = bool(body.arm)
    joints = JOINTS if has_weight else dict.fromkeys(JOINTS, "")
    wx, wy, _ = start.angular_velocity.tolist()
    return IN_THE_WORLD.format(
        **{name: text.format(below=repr(-body.arm)) for name, text in joints.items()},
        steps=STEPS,
        header="t,w,x,y,z,omega_x,omega_y,omega_z",
        duration=repr(duration),
        gravity=repr(-body.gravity if has_weight else 0.0),
        wxyz=join((w, x, y, z), ", "),
        xyzw=join((x, y, z, w), ", "),
        named=", ".join(f"{k}: {v!r}" for k, v in zip("wxyz", (w, x, y, z), strict=True)),
        position=join(start.to_world([0.0, 0.0, body.arm]).tolist(), ", "),
        velocity=join(start.to_world([body.arm * wy, -body.arm * wx, 0.0]).tolist(), ", "),
        rates=join(start.to_world(start.angular_velocity).tolist(), ", "),
        local_rates=join(start.angular_velocity.tolist(), ", "),
        moments=join((body.Ix, body.Ix, body.Iz), ", "),
        mass=repr(body.mass),
        arm=repr(body.arm),
    )
