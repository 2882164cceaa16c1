"""The start of a motion as Python for each engine, next to the model files of `formats`."""

from symtop_ros.physics import Body, State

LARGEST_RATE = 1e6  # rad/s; pybullet stops joints at 100 rad/s
SNIPPETS = """\
## Start in MuJoCo, Drake, Pinocchio and pybullet

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
"""


def format_snippets(name: str, start: State, body: Body, duration: float) -> str:
    """Return Markdown that starts the models NAME.mjcf, NAME.sdf and NAME.urdf."""
    w, x, y, z = start.orientation.tolist()
    return SNIPPETS.format(
        name=name,
        duration=repr(duration),
        quaternion=_join((w, x, y, z)),
        xyzw=_join((x, y, z, w)),
        rates=_join(start.angular_velocity.tolist()),
        angles=_join(start.euler_angles),
        euler_rates=_join(start.euler_rates),
        moments=_join((body.Ix, body.Ix, body.Iz)),
        mass=repr(body.mass),
        arm=repr(body.arm),
        gravity=repr(-body.gravity),
        limit=LARGEST_RATE,
    )


def _join(numbers: tuple[float, ...] | list[float]) -> str:
    return ", ".join(map(repr, numbers))
