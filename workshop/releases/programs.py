"""Programs that run the test set in the environment of a release.

Each reads cases.json, and writes a trajectory VARIANT.NAME.csv for each case. They are plain enough
for Python 3.7. Rapier and Jolt run what `top_judge --testset NAME -o FOLDER` has for them.
"""

from pathlib import Path

SCRIPTS = {"CANNON": "cannon.mjs", "SNIPPETS": "snippets.mjs"}
PYTHON = """\
import json, site, sys
sys.path.insert(0, sys.argv[1])  # what is installed elsewhere comes later
site.addsitedir(sys.argv[1])

def multiply(a, b):
    (p, q, r, s), (w, x, y, z) = a, b
    return [
        p*w - q*x - r*y - s*z, p*x + q*w + r*z - s*y, p*y - q*z + r*w + s*x, p*z + q*y - r*x + s*w
    ]
%s
for case in json.load(open("cases.json")):
    for variant in VARIANTS:
        try:
            rows = list(run(case, variant))
        except Exception as error:
            print(f"{type(error).__name__}: {error}", file=sys.stderr)
            continue
        with open(f"{variant}.{case['name']}.csv", "w") as file:
            print("t,w,x,y,z", file=file)
            for t, q in zip(case["times"], rows):
                print(t, *map(float, q), sep=",", file=file)
"""
MUJOCO = """
import mujoco
VARIANTS = ["RK4", "implicit", "implicitfast", "Euler"]

def run(case, variant):
    model = mujoco.MjModel.from_xml_path(case["model"])
    model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{variant.upper()}")
    model.opt.timestep = case["step"]
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for _ in case["times"]:
        for _ in range(case["steps"]):
            mujoco.mj_step(model, data)
        yield data.qpos[-4:].copy()
"""
PYBULLET = """
import math
import pybullet
pybullet.connect(pybullet.DIRECT)
VARIANTS = ["multibody"]

def run(case, variant):
    pybullet.resetSimulation()
    pybullet.setGravity(0, 0, case["gravity"])
    pybullet.setTimeStep(case["step"])
    flags = pybullet.URDF_USE_INERTIA_FROM_FILE
    top = pybullet.loadURDF(case["model"], useFixedBase=not case["free"], flags=flags)
    undamped = {"linearDamping": 0, "angularDamping": 0}
    pybullet.changeDynamics(top, -1, **undamped)
    joints = {pybullet.getJointInfo(top, k)[1]: k for k in range(pybullet.getNumJoints(top))}
    chain = [joints[each] for each in (b"precession", b"tilt", b"spin") if each in joints]
    for joint, angle, rate in zip(chain, case["angles"], case["rates"]):
        pybullet.changeDynamics(top, joint, jointDamping=0, maxJointVelocity=1e6, **undamped)
        pybullet.setJointMotorControl2(top, joint, pybullet.VELOCITY_CONTROL, force=0)
        pybullet.resetJointState(top, joint, angle, rate)
    # The base has the principal axes of the link: they are turned in its frame.
    x, y, z, w = pybullet.getDynamicsInfo(top, -1)[4]
    back = [w, -x, -y, -z]
    if case["free"]:
        q = multiply(case["q"], [w, x, y, z])
        pybullet.resetBasePositionAndOrientation(top, [0, 0, 0], q[1:] + q[:1])
        pybullet.resetBaseVelocity(top, [0, 0, 0], case["world_rates"])
    for _ in case["times"]:
        for _ in range(case["steps"]):
            pybullet.stepSimulation()
        if case["free"]:
            x, y, z, w = pybullet.getBasePositionAndOrientation(top)[1]
            yield multiply([w, x, y, z], back)
        else:
            a, b, c = (pybullet.getJointState(top, joint)[0] / 2 for joint in chain)
            q = multiply([math.cos(a), 0, 0, math.sin(a)], [math.cos(b), math.sin(b), 0, 0])
            yield multiply(multiply(q, [math.cos(c), 0, 0, math.sin(c)]), case["turn"])
"""
PINOCCHIO = """
import numpy
import pinocchio
VARIANTS = ["aba, RK4 in Python"]

def run(case, variant):
    model = pinocchio.buildModelFromXML(open(case["model"]).read())
    data, start, still = model.createData(), pinocchio.neutral(model), numpy.zeros(3)
    h, angles, v = case["step"], numpy.array(case["angles"]), numpy.array(case["rates"])
    place = lambda angles: pinocchio.integrate(model, start, angles)
    find = lambda angles, v: numpy.ravel(pinocchio.aba(model, data, place(angles), v, still))
    for _ in case["times"]:
        for _ in range(case["steps"]):
            a1 = find(angles, v)
            v2 = v + h / 2 * a1
            a2 = find(angles + h / 2 * v, v2)
            v3 = v + h / 2 * a2
            a3 = find(angles + h / 2 * v2, v3)
            v4 = v + h * a3
            a4 = find(angles + h * v3, v4)
            angles, v = angles + h / 6 * (v + 2*v2 + 2*v3 + v4), v + h / 6 * (a1 + 2*a2 + 2*a3 + a4)
        pinocchio.forwardKinematics(model, data, place(angles))
        q = pinocchio.Quaternion(data.oMi[3].rotation)
        yield [q.w, q.x, q.y, q.z]
"""
DRAKE = """
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
VARIANTS = ["RK3", "discrete"]

def run(case, variant):
    plant = MultibodyPlant(case["step"] if variant == "discrete" else 0.0)
    parser = Parser(plant)
    read = "AddModels" if hasattr(parser, "AddModels") else "AddAllModelsFromFile"
    getattr(parser, read)(case["model"])
    plant.Finalize()
    simulator = Simulator(plant)
    if variant == "RK3":
        ResetIntegratorFromFlags(simulator, "runge_kutta3", case["step"]).set_fixed_step_mode(True)
    context, body = simulator.get_mutable_context(), plant.GetBodyByName("top")
    if case["free"]:
        plant.SetPositions(context, [*case["q"], *case["place"]])
        plant.SetVelocities(context, [*case["world_rates"], *case["velocity"]])
    else:
        plant.GetJointByName("pivot").set_angular_velocity(context, case["omega"])
    simulator.Initialize()
    for t in case["times"]:
        simulator.AdvanceTo(t)
        q = plant.EvalBodyPoseInWorld(context, body).rotation().ToQuaternion()
        yield [q.w(), q.x(), q.y(), q.z()]
"""
PYTHONS = {"MUJOCO": MUJOCO, "PYBULLET": PYBULLET, "PINOCCHIO": PINOCCHIO, "DRAKE": DRAKE}
PROGRAMS = {name: PYTHON % program for name, program in PYTHONS.items()}
PROGRAMS |= {name: Path(__file__).with_name(file).read_text() for name, file in SCRIPTS.items()}
