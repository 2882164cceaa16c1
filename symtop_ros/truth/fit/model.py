"""The model of a record: the values that the exact motion predicts, and their derivatives.

The unit of moments is Ix. An axis is that of a top with Iz = Ix and the same p_psi, so that only
records of the body have the parameters Iz/Ix and spin. The start is a small rotation of a reference
attitude and the angular velocity across the axis: no parameter has a pole.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real, compose, find_rotation_vectors, invert
from symtop_ros.physics import (
    DEFAULT_GRAVITY,
    Friction,
    Motion,
    Motions,
    State,
    Top,
    specific_force,
)
from symtop_ros.truth.fit.camera import CAMERA, CENTRE, project
from symtop_ros.truth.fit.kinds import ACROSS, Kind
from symtop_ros.truth.fit.record import Record

MOUNT = ("bias_x", "bias_y", "bias_z", "tilt_x", "tilt_y")  # of a gyroscope
FORCE_BIASES = ("bias_fx", "bias_fy", "bias_fz")  # of an accelerometer
LENGTH = "log_length"  # of points of an axis; their distance from the pivot is exp(log_length)
TURNS = ("turn_1", "turn_2", "turn_3")
FRICTION = ("axial/Iz", "transverse/Ix")
# Parameters of a kick: its time after the first row, and the change of the rates in the world
# frame, which does not turn with the spin while its time is looked for.
KICK = ("kick_time", "kick_x", "kick_y", "kick_z")
THINNEST = 1e-4  # Iz/Ix of a rod
# If a step changes the phase by DELTA, a forward difference has the relative error DELTA/2, and a
# central one DELTA^2/6; the rounding of phases, below 1e-14 rad, adds less than 1e-8 to both.
DELTA, CENTRAL_DELTA = 2e-6, 2e-4
LARGEST_STEP = 1e-5  # of the scale of a parameter
BAD = 1e3  # residual of parameters without a motion


@dataclass(frozen=True, eq=False)
class Model:
    """Predicted values of parameters x (k, p) at the times of a record.

    The start of all of them is near a reference attitude (4,).
    """

    record: Record
    reference: Real

    @property
    def kind(self) -> Kind:
        """Kind of the record."""
        return self.record.kind

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        spins = self.kind.shows_spin
        core: tuple[str, ...] = ("Mgl/Ix", "Iz/Ix", "spin") if spins else ("Mgl/Ix", "p_psi/Ix")
        if self.lacks_ratio:
            core = "Mgl/Ix", "spin"
        camera = tuple(n for n in CAMERA if self._seeks(n))
        is_inertial = self.kind.name == "inertial"
        return (
            *core,
            *TURNS[: len(self._basis)],
            "wx",
            "wy",
            *(FRICTION if self.record.has_friction else ()),
            *(KICK if self.record.has_kick else ()),
            *(MOUNT if self.record.has_mount else ()),
            *((LENGTH,) if self.record.has_length else ()),
            *(("gravity",) if is_inertial else ()),
            *(FORCE_BIASES if is_inertial and self.record.has_mount else ()),
            *(camera if self.kind.name == "pixels" else ()),
        )

    @property
    def lacks_ratio(self) -> bool:
        """True if Iz/Ix is set to 1, because rates across the axis do not depend on it."""
        return self.kind is ACROSS and "Iz/Ix" not in self.record.known

    def _seeks(self, name: str) -> bool:
        """Return True if a number of the camera is looked for."""
        return name not in self.record.camera and (
            name != "nearness" or self.record.has_perspective
        )

    @cached_property
    def place(self) -> dict[str, int]:
        """Place of each parameter."""
        return {name: place for place, name in enumerate(self.names)}

    @cached_property
    def _basis(self) -> Real:
        """Axes (r, 3) of the body about which the reference is turned, so that the record shows it.

        Attitudes show a turn about all three axes. Rates do not show one about the vertical, points
        of an axis do not show one about the axis, and theta alone shows neither of these.
        """
        if self.kind.name == "attitude":
            return np.eye(3)
        w, x, y, z = self.reference
        up = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
        fixed = up if self.kind.shows_spin else np.array([0.0, 0.0, 1.0])
        across = np.cross(fixed, [1.0, 0.3, 0.2] if self.kind.shows_spin else up)
        if np.linalg.norm(across) < 1e-9:
            across = np.array([1.0, 0.0, 0.0])
        across /= np.linalg.norm(across)
        basis = np.stack([across, np.cross(fixed, across)])
        return basis[:1] if self.kind.name == "theta" else basis

    def move(self, record: Record) -> "Model":
        """Return the same model of a different part of the record that has the same start."""
        return Model(record, self.reference)

    def take(self, x: Real, name: str, missing: float = 0.0) -> Real:
        """Return a parameter, (k,), of many."""
        place = self.place.get(name)
        return np.full(len(x), missing) if place is None else x[:, place]

    def read(self, x: Real) -> Motions:
        """Return the motions of parameters (k, p)."""
        ratio = np.clip(self.take(x, "Iz/Ix", 1.0), THINNEST / 2, 2.0)
        turn = x[:, [self.place[n] for n in TURNS if n in self.place]] @ self._basis
        small = Rotation.from_rotvec(turn).as_quat()[:, [3, 0, 1, 2]]
        q = compose(self.reference, small)
        spin = self.take(x, "spin" if self.kind.shows_spin else "p_psi/Ix")
        omega = np.stack([self.take(x, "wx"), self.take(x, "wy"), spin], axis=-1)
        top = Top(np.ones(len(x)), ratio, self.take(x, "Mgl/Ix"))
        if not self.record.has_friction:
            return Motions(top, State(q, omega))
        axial, transverse = (np.maximum(self.take(x, name), 0.0) for name in FRICTION)
        return Motions(top, State(q, omega), Friction(axial * ratio, transverse))

    def find_motion(self, x: Real) -> Motion:
        """Return the motion of parameters (p,)."""
        found = self.read(x[np.newaxis])[0]
        assert isinstance(found, Motion)
        return found

    def show(self, x: Real) -> Real:
        """Return the values (k, n, m) of a record of parameters (k, p)."""
        return self.show_at(x, self.record.times - self.record.times[0])

    def show_at(self, x: Real, times: Real) -> Real:
        """Return the values (k, n, m) that parameters (k, p) show at times (n,) from the start."""
        motions = self.read(x)
        state = motions.at(times)
        if self.record.has_kick:
            state = self._kick(motions, state, x, times)
        if self.kind.name != "inertial":
            return self._see(state, x)
        forces = self._find_forces(motions, state, self.take(x, "gravity"))
        force_bias = np.stack([self.take(x, n) for n in FORCE_BIASES], axis=-1)
        forces = self._turn_sensor(forces, x) + force_bias[:, np.newaxis]
        return np.concatenate([self._mount(state.angular_velocity, x), forces], axis=-1)

    def _kick(self, motions: Motions, state: State, x: Real, times: Real) -> State:
        """Return the states (k, n) at times, of which those after a kick are of another motion."""
        place = self.place["kick_time"]
        late = times >= x[:, place : place + 1]
        if not late.any():
            return state
        after = np.where(late, times - x[:, place : place + 1], 0.0)
        kicked = change_rates(motions, x[:, place], x[:, place + 1 : place + 4]).at_each(after)
        both = [
            np.where(late[..., np.newaxis], *each)
            for each in zip(_take(kicked), _take(state), strict=True)
        ]
        return State._wrap(*both)

    def _find_forces(self, motions: Motions, state: State, gravity: Real) -> Real:
        """Return the specific forces (k, n, 3) at the place of the accelerometer."""
        q, omega = state.orientation, state.angular_velocity
        found = []
        for k, g in enumerate(gravity.tolist()):
            motion = motions[k]
            assert isinstance(motion, Motion)
            found.append(
                specific_force(motion, State._wrap(q[k], omega[k]), self.record.position, g)
            )
        return np.array(found)

    def _see(self, state: State, x: Real) -> Real:
        if self.kind.name == "attitude":
            return state.orientation
        if self.kind.name in {"rates", ACROSS.name}:
            return self._mount(state.angular_velocity, x)[..., : self.kind.width]
        axis = find_axis(state.orientation)
        if self.kind.name == "axis":
            return axis * np.exp(self.take(x, LENGTH))[:, np.newaxis, np.newaxis]
        if self.kind.name == "pixels":
            return project(axis, self._find_cameras(x))
        theta = np.arctan2(np.hypot(axis[..., 0], axis[..., 1]), axis[..., 2])
        if self.kind.name == "theta":
            return theta[..., np.newaxis]
        return np.stack([theta, np.arctan2(axis[..., 0], -axis[..., 1])], axis=-1)

    def _find_cameras(self, x: Real) -> dict[str, Real]:
        given = self.record.camera
        names = (*CAMERA, *(n for n in CENTRE if n in given))
        return {n: self.take(x, n, given.get(n, 0.0)) for n in names}

    def find_camera(self, x: Real) -> dict[str, float]:
        """Return the camera of parameters (p,), by the names of its numbers."""
        return {name: float(each[0]) for name, each in self._find_cameras(x[np.newaxis]).items()}

    def _mount(self, rates: Real, x: Real) -> Real:
        """Return rates as a biased and tilted gyroscope shows them."""
        if not self.record.has_mount:
            return rates
        bias = np.stack([self.take(x, n) for n in MOUNT[:3]], axis=-1)
        return np.asarray(self._turn_sensor(rates, x) + bias[:, np.newaxis])

    def _turn_sensor(self, vectors: Real, x: Real) -> Real:
        """Return vectors (k, n, 3) of the body as a tilted sensor sees them."""
        if not self.record.has_mount:
            return vectors
        tilt = np.stack([self.take(x, n) for n in MOUNT[3:]] + [np.zeros(len(x))], axis=-1)
        turned = Rotation.from_rotvec(tilt).as_matrix()
        return np.asarray(vectors @ turned.swapaxes(-1, -2))

    def compare(self, shown: Real) -> Real:
        """Return the differences (k, n, r) between what is shown and the record."""
        values = self.record.values
        if self.kind.name == "attitude":
            return find_rotation_vectors(compose(invert(values), shown))
        left = shown - values
        if self.kind.rounds:
            left[..., -1] -= self.kind.rounds * np.round(left[..., -1] / self.kind.rounds)
        return left

    def find_residuals(self, x: Real) -> Real:
        """Return the residuals (n, r) of parameters (p,)."""
        try:
            return np.asarray(self.compare(self.show(x[np.newaxis]))[0])
        except ValueError:  # numbers beyond those of a top
            return np.full((len(self.record), len(self.kind.residuals)), BAD)

    def find_scales(self, x: Real) -> Real:
        """Return the size (p,) of each parameter: rates are those of the motion."""
        rates = np.abs(
            [x[self.place[n]] for n in ("wx", "wy", "spin", "p_psi/Ix") if n in self.place]
        )
        rate = float(np.sqrt(abs(x[0])) + rates.max())
        size = float(np.exp(self.record.camera.get("log_scale", 0.0)))
        if "log_scale" in self.place:
            size = float(np.exp(x[self.place["log_scale"]]))
        sizes = {"Mgl/Ix": max(abs(x[0]), 0.01 * rate**2), "u": size, "v": size}
        sizes |= dict.fromkeys(("gravity", *FORCE_BIASES), DEFAULT_GRAVITY)
        sizes["kick_time"] = 1 / max(rate, 1e-300)
        ones = "Iz/Ix", "log_scale", "elevation", "roll", "nearness", LENGTH, *TURNS, *MOUNT[3:]
        sizes |= dict.fromkeys(ones, 1.0)
        return np.array([sizes.get(name, rate) for name in self.names])

    def find_steps(self, x: Real, delta: float) -> Real:
        """Return steps of differences, (p,), by which the phases at the end change by delta."""
        return np.asarray(
            self.find_scales(x) * np.minimum(delta / self.find_phase(x), LARGEST_STEP)
        )

    def find_phase(self, x: Real) -> float:
        """Return the largest phase in rad by the end of the record."""
        return float(self.find_scales(x)[self.place["wx"]] * self.record.seconds)

    def find_jacobian(self, x: Real, central: bool = False) -> Real:
        """Return the derivatives (n, r, p) of the residuals, as differences of exact states."""
        steps = self.find_steps(x, CENTRAL_DELTA if central else DELTA)
        if "Iz/Ix" in self.place and not central and x[1] > 2 - 2 * steps[1]:
            steps[1] = -steps[1]
        sides = (1, -1) if central else (1,)
        moved = np.concatenate([x + side * np.diag(steps) for side in sides])
        if not central:
            moved = np.concatenate([moved, x[np.newaxis]])
        if "Iz/Ix" in self.place:
            moved[:, 1] = np.minimum(moved[:, 1], 2.0)
        left = self.compare(self.show(moved))
        count = len(x)
        far = left[count:]  # those of the other side, or of x itself
        taken = moved[:count] - (moved[count:] if central else x)
        # For phases beyond 1e10 rad a step changes no digit: NaN then ends the search.
        with np.errstate(invalid="ignore"):
            slopes = self.subtract(left[:count], far) / np.diag(taken)[:, np.newaxis, np.newaxis]
        return np.asarray(np.moveaxis(slopes, 0, -1))

    def subtract(self, first: Real, second: Real) -> Real:
        """Return a difference of residuals, without whole turns if it is an angle."""
        difference = first - second
        if self.kind.rounds:  # the residuals of two neighbours may lie on two sides of the period
            last = difference[..., -1]
            difference[..., -1] = last - self.kind.rounds * np.round(last / self.kind.rounds)
        return np.asarray(difference)


def _take(state: State) -> tuple[Real, Real]:
    return np.asarray(state.orientation), np.asarray(state.angular_velocity)


def change_rates(motions: Motions, times: Real, change: Real) -> Motions:
    """Return the motions (k,) after changes (k, 3) of the rates, in the world, at times (k,)."""
    q, omega = _take(motions.at_each(times))
    body = Rotation.from_quat(q[:, [1, 2, 3, 0]]).inv().apply(change)
    return Motions(motions.top, State(q, omega + body), motions.friction)


def find_axis(q: Real) -> Real:
    """Return the axes (..., 3) of attitudes (..., 4)."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    return np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=-1)


def point_along(axis: Real) -> Real:
    """Return an attitude (4,) whose z is the axis, with psi = 0."""
    theta, phi = np.arctan2(np.hypot(axis[0], axis[1]), axis[2]), np.arctan2(axis[0], -axis[1])
    return np.asarray(State.from_euler(theta=float(theta), phi=float(phi)).orientation)


def find_momentum(model: Model, x: Real) -> float:
    """Return p_psi/Ix."""
    place = model.place
    if "p_psi/Ix" in place:
        return float(x[place["p_psi/Ix"]])
    ratio = 1.0 if model.lacks_ratio else x[place["Iz/Ix"]]
    return float(ratio * x[place["spin"]])


def name_parameters(motion: Motion) -> dict[str, float]:
    """Return the parameters of a motion whose start is the reference of a model, by name."""
    top, friction = motion.top, motion.friction
    wx, wy, spin = (float(each) for each in motion.start.angular_velocity)
    named = {"Mgl/Ix": top.Mgl / top.Ix, "Iz/Ix": top.Iz / top.Ix, "spin": spin}
    named |= {"p_psi/Ix": top.Iz * spin / top.Ix, "wx": wx, "wy": wy}
    rates = friction.axial / top.Iz, friction.transverse / top.Ix
    return named | dict(zip(FRICTION, map(float, rates), strict=True))
