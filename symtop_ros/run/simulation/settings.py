"""The parameters of a simulation: default, meaning, unit and range of each, and their values."""

import json
import math
from collections.abc import Callable, Mapping, Sized
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any

from symtop_ros.base.arrays import Vector
from symtop_ros.base.refusals import (
    RefusedError,
    choice,
    describe_range,
    flag,
    number,
    refuse,
    vector,
)
from symtop_ros.physics import DEFAULT_GRAVITY, Body, Friction, Motion, Top
from symtop_ros.run.simulation.presets import load_scene
from symtop_ros.run.simulation.sensor.imu import (
    ALONG,
    CENTRE,
    EARTH,
    LARGEST_LIMIT,
    MAX_DISTANCE,
    MAX_FIELD,
    Imu,
    Magnetometer,
    Rig,
    find_body,
)
from symtop_ros.run.simulation.sensor.noise import MAX_NOISE

NO_TORQUE: Vector = (0.0, 0.0, 0.0)
PRECESSIONS = ("slow", "fast")
ANGLES = ("theta", "phi", "psi")
RATES = ("theta_dot", "phi_dot", "psi_dot")
MAX_ANGLE = 1e3  # rad; beyond, the reduction of an angle to a turn loses digits
MAX_RATE = 1e9  # rad/s; of any rate that is requested, and of the top after a kick
MIN_MOMENT = 1e-30  # kg m^2
MAX_MOMENT = 1e30  # kg m^2, J, N m or N m s; keeps every product of them finite
MAX_SEED = 2**53  # a larger number may not be a double
MAX_PUBLISH_RATE = 2000.0  # Hz
MAX_PRIORITY = 99  # of SCHED_FIFO
FOLDER, MAX_PATH = "the name of a folder (printable characters)", 4096  # characters
MAX_LIST = 1000  # characters of a list that is given as text
MAX_FRAME = 200  # characters of a frame name, which stands in every message


@dataclass(frozen=True, slots=True)
class Parameter:
    """One parameter of the node."""

    default: Any
    description: str  # meaning and unit
    condition: str  # the allowed values
    # returns the value, converted, from the name and a raw value; raises RefusedError
    validate: Callable[[str, Any], Any]
    read_only: bool = False  # True if it can only be set at the start
    limits: tuple[float, float] | None = None  # of a number


def _number(default: float, description: str, unit: str, low: float, high: float) -> Parameter:
    return Parameter(
        default,
        f"{description} ({unit or 'no unit'})",
        describe_range(low, high, unit),
        partial(number, unit=unit, low=low, high=high),
        limits=(low, high),
    )


_moment = partial(_number, high=MAX_MOMENT)


def _read_list(text: str) -> Any:
    """Return the list of a text such as [0, 0, 0.1], which is no list to ROS; else the text."""
    try:
        found = json.loads(text) if len(text) <= MAX_LIST else text
    except (ValueError, RecursionError):
        return text
    return found if isinstance(found, list) else text


def _vector(description: str, size: int, limit: float, unit: str) -> Parameter:
    def validate(name: str, value: Any) -> tuple[float, ...]:
        value = _read_list(value) if isinstance(value, str) else value
        empty = not isinstance(value, str) and isinstance(value, Sized) and len(value) == 0
        return () if empty else vector(name, value, size, limit, unit)

    return Parameter(
        [0.0] * 0,
        f"{description} ({unit})",
        f"{size} numbers ({unit}), or empty: not set",
        validate,
    )


def _printable(condition: str, max_length: int, name: str, value: Any) -> str:
    """Return text that can stand in a message or a path."""
    if (
        not isinstance(value, str)
        or len(value) > max_length
        or not value.strip()
        or not value.isprintable()
    ):
        raise refuse(name, condition, value)
    return value


def _frame(default: str, description: str) -> Parameter:
    condition = f"the name of a frame (1 to {MAX_FRAME} printable characters, no leading slash)"

    def validate(name: str, value: Any) -> str:
        text = _printable(condition, MAX_FRAME, name, value)
        if text.startswith("/"):  # tf2 would not find it
            raise refuse(name, f"{text.lstrip('/')!r}, without the leading slash", text)
        return text

    return Parameter(default, description, condition, validate, read_only=True)


def _flag(default: bool, description: str, read_only: bool = False) -> Parameter:
    return Parameter(default, description, "true or false", flag, read_only)


def _fix(parameter: Parameter) -> Parameter:
    """Return a parameter that can only be set at the start."""
    return replace(parameter, read_only=True)


def _noise(description: str, unit: str) -> Parameter:
    return _fix(_number(0.0, description, unit, 0.0, MAX_NOISE))


def _limit(description: str, unit: str) -> Parameter:
    return _fix(_number(0.0, description, unit, 0.0, LARGEST_LIMIT))


def _whole(largest: int, name: str, value: Any) -> int:
    try:
        whole = number(name, value, "", 0, largest)
    except RefusedError:
        whole = 0.5
    if whole != int(whole):
        raise refuse(name, f"a whole number, 0 to {largest}", value)
    return int(whole)


SEED = Parameter(
    0,
    "seed of the noise",
    f"a whole number, 0 to {MAX_SEED}",
    partial(_whole, MAX_SEED),
    read_only=True,
    limits=(0, MAX_SEED),
)

PARAMETERS: dict[str, Parameter] = {
    "top.Ix": _moment(2.28e-4, "moment of inertia across the axis", "kg m^2", MIN_MOMENT),
    "top.Iz": _moment(
        5.72e-5, "moment of inertia about the axis, at most 2 Ix", "kg m^2", MIN_MOMENT
    ),
    "top.Mgl": _moment(0.068, "weight times distance of the centre of mass", "J", -MAX_MOMENT),
    "initial.theta": _number(0.0, "initial tilt", "rad", 0.0, math.pi),
    "initial.phi": _number(0.0, "initial precession angle", "rad", -MAX_ANGLE, MAX_ANGLE),
    "initial.psi": _number(0.0, "initial spin angle", "rad", -MAX_ANGLE, MAX_ANGLE),
    "initial.theta_dot": _number(0.0, "initial rate of the tilt", "rad/s", -MAX_RATE, MAX_RATE),
    "initial.phi_dot": _number(0.0, "initial precession rate", "rad/s", -MAX_RATE, MAX_RATE),
    "initial.psi_dot": _number(0.0, "initial spin rate", "rad/s", -MAX_RATE, MAX_RATE),
    "initial.precession": Parameter(
        "",
        "start on a root of regular precession",
        "slow, fast, or empty: not set",
        partial(choice, options=("", *PRECESSIONS)),
    ),
    "initial.orientation": _vector("initial quaternion, body -> world", 4, 2.0, "x, y, z, w"),
    "initial.angular_velocity": _vector(
        "initial angular velocity", 3, MAX_RATE, "rad/s, body frame"
    ),
    "initial.clamped": _flag(False, "hold phi from the start on, as ~/clamp does"),
    "friction.axial": _moment(0.0, "friction torque per omega_z, on the axis", "N m s", 0.0),
    "friction.transverse": _moment(0.0, "friction torque per omega across the axis", "N m s", 0.0),
    "steady_torque": _vector("constant applied torque", 3, MAX_MOMENT, "N m, world frame"),
    "applied_torque_timeout": _number(
        0.1, "time for which a sample of ~/applied_torque acts", "s", 0.001, 1e6
    ),
    "hurry_factor": _number(1.4, "factor of phi' in ~/hurry_precession", "", -1e6, 1e6),
    "publish_rate": _number(200.0, "samples per second of the stamps", "Hz", 1.0, MAX_PUBLISH_RATE),
    "real_time_factor": _number(
        1.0, "seconds of the motion per second of the clock", "", 1e-3, 100.0
    ),
    "start_paused": _flag(
        False, "start paused, for a run that is stepped or resumed by request", read_only=True
    ),
    "publish_tf": _flag(True, "publish world -> top on /tf"),
    "publish_clock": _flag(
        False,
        "publish /clock, the elapsed time of the run; all stamps are in this time",
        read_only=True,
    ),
    "publish_markers": _flag(False, "publish ~/markers for rviz", read_only=True),
    "record.enabled": _flag(False, "record from the start", read_only=True),
    "record.directory": Parameter(
        "./logs",
        "folder of the logs",
        FOLDER,
        partial(_printable, FOLDER, MAX_PATH),
        read_only=True,
    ),
    "record.max_size": _number(0.0, "size at which a new log begins; 0: none", "B", 0.0, 1e15),
    "record.max_duration": _number(0.0, "length at which a new log begins; 0: none", "s", 0.0, 1e9),
    "mass": _moment(
        0.0, "mass of the top; 0: a mass is assumed for the force of the pivot", "kg", 0.0
    ),
    "gravity": _number(DEFAULT_GRAVITY, "acceleration of gravity", "m/s^2", 1e-3, 1e3),
    "imu.enabled": _flag(False, "publish ~/imu", read_only=True),
    "imu.position": _fix(_vector("place of the sensor, body frame", 3, MAX_DISTANCE, "m")),
    "imu.orientation": _fix(_vector("quaternion, sensor -> body", 4, 2.0, "x, y, z, w")),
    "imu.noise.gyroscope_noise_density": _noise("white noise", "rad/s/sqrt(Hz)"),
    "imu.noise.gyroscope_random_walk": _noise("random walk of the bias", "rad/s^2/sqrt(Hz)"),
    "imu.noise.accelerometer_noise_density": _noise("white noise", "m/s^2/sqrt(Hz)"),
    "imu.noise.accelerometer_random_walk": _noise("random walk of the bias", "m/s^3/sqrt(Hz)"),
    "imu.noise.seed": SEED,
    "imu.limits.gyroscope_range": _limit(
        "largest rate that the sensor shows; 0: no limit", "rad/s"
    ),
    "imu.limits.gyroscope_resolution": _limit("step of the rates; 0: none", "rad/s"),
    "imu.limits.accelerometer_range": _limit(
        "largest specific force that the sensor shows; 0: no limit", "m/s^2"
    ),
    "imu.limits.accelerometer_resolution": _limit("step of the forces; 0: none", "m/s^2"),
    "magnetic_field.enabled": _flag(False, "publish ~/magnetic_field", read_only=True),
    "magnetic_field.vector": _fix(_vector("magnetic field, world frame", 3, MAX_FIELD, "T")),
    "magnetic_field.noise.magnetometer_noise_density": _noise("white noise", "T/sqrt(Hz)"),
    "magnetic_field.noise.magnetometer_random_walk": _noise(
        "random walk of the bias", "T/s/sqrt(Hz)"
    ),
    "magnetic_field.noise.seed": SEED,
    "odometry.enabled": _flag(False, "publish ~/odometry", read_only=True),
    "scheduling_priority": Parameter(
        0,
        "priority of SCHED_FIFO, real-time scheduling; 0: none",
        f"a whole number, 0 to {MAX_PRIORITY}",
        partial(_whole, MAX_PRIORITY),
        read_only=True,
        limits=(0, MAX_PRIORITY),
    ),
    "world_frame": _frame("world", "fixed frame, z up"),
    "top_frame": _frame("top", "frame of the body"),
}


@dataclass(frozen=True, slots=True)
class InitialConditions:
    """The `initial.*` parameters."""

    theta: float  # Euler angles z-x-z in rad
    phi: float
    psi: float
    theta_dot: float  # their rates in rad/s
    phi_dot: float
    psi_dot: float
    precession: str  # "slow" or "fast" for a root of regular precession; empty: not set
    orientation: tuple[float, ...]  # quaternion x, y, z, w, or empty
    # body frame, rad/s; empty: zero if there is an orientation
    angular_velocity: tuple[float, ...]
    clamped: bool


@dataclass(frozen=True, slots=True)
class RecordSettings:
    """The `record.*` parameters."""

    enabled: bool
    directory: str
    # of one file; the recording then continues in a new one
    max_size: float  # in bytes; 0: no limit
    max_duration: float  # in s, between the stamps of its messages; 0: no limit


@dataclass(frozen=True, slots=True)
class Settings:
    """Validated values of all parameters; see `PARAMETERS` for their meaning."""

    values: Mapping[str, Any]  # the values by their full names, for logs and comparisons
    top: Top
    friction: Friction
    initial: InitialConditions
    record: RecordSettings
    steady_torque: Vector
    applied_torque_timeout: float
    hurry_factor: float
    publish_rate: float
    real_time_factor: float
    start_paused: bool
    publish_tf: bool
    publish_clock: bool
    publish_markers: bool
    mass: float  # kg; 0: a body is chosen
    gravity: float
    imu: Imu | None
    odometry: bool
    scheduling_priority: int
    world_frame: str
    top_frame: str

    @classmethod
    def from_values(cls, values: Mapping[str, Any]) -> "Settings":
        """Validate raw values; parameters that are missing get their defaults."""
        clean = {
            name: parameter.validate(name, values.get(name, parameter.default))
            for name, parameter in PARAMETERS.items()
        }
        if clean["initial.angular_velocity"] and not clean["initial.orientation"]:
            raise RefusedError(
                "initial.angular_velocity must be set together with initial.orientation, got none"
            )
        stamps = clean["publish_rate"] * clean["real_time_factor"]
        if clean["publish_clock"] and stamps > MAX_PUBLISH_RATE:
            raise refuse(
                "publish_rate times real_time_factor",
                f"at most {MAX_PUBLISH_RATE:g} Hz with publish_clock",
                stamps,
            )
        try:
            top, friction = read_body(clean)
        except ValueError as error:  # of the moments together; a friction has its limits above
            raise RefusedError(f"top.{error}") from None
        if clean["mass"]:
            Body.from_top(top, clean["gravity"], clean["mass"])  # refuses one that is too small
        x, y, z = clean["steady_torque"] or NO_TORQUE
        plain = {name: value for name, value in clean.items() if "." not in name}
        return cls(
            values=clean,
            top=top,
            friction=friction,
            initial=InitialConditions(**_group(clean, "initial.")),
            record=RecordSettings(**_group(clean, "record.")),
            imu=_build_imu(clean),
            odometry=clean["odometry.enabled"],
            **{**plain, "steady_torque": (x, y, z)},
        )

    def rig(self, begin: int) -> Rig:
        """Return gravity, mass and sensor, whose biases are zero at the stamp `begin` (ns)."""
        imu = self.imu and replace(self.imu, rate=self.publish_rate, begin=begin)
        return Rig(self.gravity, imu, self.mass)

    @property
    def body(self) -> Body | None:
        """The body of the top: of its mass, or the chosen one; None if no body can be it."""
        return find_body(self.top, self.gravity, self.mass)

    @classmethod
    def from_scene(cls, name: object, **changes: Any) -> "Settings":
        """Return the settings of a scene, with changes (`__` for the dots in their names)."""
        named = {key.replace("__", "."): value for key, value in changes.items()}
        return cls.from_values(override_scene(load_scene(name), named))


def list_body(motion: Motion) -> dict[str, float]:
    """Return the parameters that say what moves: all numbers of its top and its friction."""
    numbers = {"top": asdict(motion.top), "friction": asdict(motion.friction)}
    return {f"{kind}.{name}": each[name] for kind, each in numbers.items() for name in each}


def read_body(values: Mapping[str, Any]) -> tuple[Top, Friction]:
    """Return the top and the friction that parameters describe."""
    return Top(**_group(values, "top.")), Friction(**_group(values, "friction."))


def override_scene(scene: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the parameters of a scene with others; a given rate ends its regular precession.

    This is as in a request; otherwise the given rate would be silently replaced.
    """
    is_given = any(f"initial.{name}" in given for name in ("phi_dot", "theta_dot"))
    regular = {"initial.precession": ""} if is_given else {}
    return {**scene, **regular, **given}


def _build_imu(clean: Mapping[str, Any]) -> Imu | None:
    """Return the sensor, or None if nothing of it is published."""
    magnetometer = None
    if clean["magnetic_field.enabled"]:
        vector = clean["magnetic_field.vector"] or EARTH
        magnetometer = Magnetometer(vector, **_group(clean, "magnetic_field.noise."))
    try:
        imu = Imu(
            clean["imu.position"] or CENTRE,
            clean["imu.orientation"] or ALONG,
            **_group(clean, "imu.noise."),
            **_group(clean, "imu.limits."),
            magnetometer=magnetometer,
        )
    except ValueError as error:
        raise RefusedError(f"imu.{error}") from None
    return imu if clean["imu.enabled"] or magnetometer else None


def _group(values: Mapping[str, Any], prefix: str) -> dict[str, Any]:
    return {
        name.removeprefix(prefix): value
        for name, value in values.items()
        if name.startswith(prefix)
    }
