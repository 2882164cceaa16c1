"""Types of the public names of the library, as a checker of types sees them in a caller's code.

`test/lint.py types` runs mypy over this file; nothing runs it. A test compares its names with the
public ones.
"""

from pathlib import Path
from typing import assert_type

import numpy as np

from symtop_ros import physics as p
from symtop_ros.base.arrays import Real
from symtop_ros.physics import gpu, reference
from symtop_ros.ros.node import top_node
from symtop_ros.truth import imu
from symtop_ros.truth.testset import score

ONE = p.Top(Ix=1.0, Iz=0.5, Mgl=2.0)
MANY = p.Top(Ix=1.0, Iz=0.5, Mgl=[1.0, 2.0])
START = p.State.from_euler(theta=0.5, psi_dot=9.0)
STARTS = p.State.from_euler(theta=[0.4, 0.5], psi_dot=9.0)
ARRAY = np.array([1.0, 2.0])
MOTION = p.Motion(ONE, START)
MOTIONS = p.Motions(MANY, START)
PART = p.Part("disc", mass=1.0, distance=0.5, size=0.25)


def see_bodies() -> None:
    """Tops, bodies, friction."""
    assert_type(ONE, p.Top[float])
    assert_type(MANY, p.Top[Real])
    assert_type(p.Top(ARRAY, 0.5, 1.0), p.Top[Real])
    assert_type(ONE.Mgl, float)
    assert_type(MANY.Mgl, Real)
    assert_type(ONE.moments, tuple[float, float, float])
    assert_type(ONE.critical_spin, float)
    assert_type(MANY.critical_spin, Real)
    assert_type(ONE.energy(START), float)
    assert_type(ONE.energy(STARTS), Real)
    assert_type(MANY.energy(STARTS), Real)
    assert_type(ONE.axial_momentum(START), float)
    assert_type(MANY.vertical_momentum(STARTS), Real)
    assert_type(ONE.angular_momentum(START), Real)
    assert_type(ONE.sleeping_is_stable(START), bool)
    assert_type(p.Friction(axial=1e-6), p.Friction[float])
    assert_type(p.Friction(axial=ARRAY), p.Friction[Real])
    assert_type(p.Body.from_top(ONE), p.Body)
    assert_type(p.Body.from_parts([PART]).top, p.Top[float])
    assert_type(p.BODIES, dict[str, tuple[p.Part, ...]])
    assert_type(p.SIZES, dict[str, str])
    assert_type(p.DEFAULT_GRAVITY, float)


def see_starts() -> None:
    """States, angles, rates, and starts from what is seen."""
    assert_type(START, p.State[float])
    assert_type(STARTS, p.State[Real])
    assert_type(p.State((1, 0, 0, 0), (0, 0, 9)), p.State[float])
    assert_type(START.euler_angles, p.Angles[float])
    assert_type(STARTS.euler_angles.theta, Real)
    assert_type(START.euler_rates, p.Rates[float])
    assert_type(STARTS.euler_rates.psi_dot, Real)
    assert_type(START.orientation, Real)
    assert_type(p.regular_precession_rates(ONE, 0.5, 9.0), tuple[float, float])
    assert_type(p.regular_precession_rates(MANY, 0.5, 9.0), tuple[Real, Real])
    assert_type(p.regular_precession_rates(ONE, ARRAY, 9.0), tuple[Real, Real])
    assert_type(p.solve_start(ONE, theta=0.5, psi_dot=9.0), tuple[p.Solution, ...])
    assert_type(p.solve_start(ONE, theta=0.5, psi_dot=9.0)[0].state, p.State[float])
    questions: tuple[str, ...] = p.QUESTIONS  # each a literal
    assert_type(questions[0], str)


def see_motions() -> None:
    """Motions, one and many, and what follows from them."""
    assert_type(MOTION.at(1.0), p.State[float])
    assert_type(MOTION.at([1.0, 2.0]), p.State[Real])
    assert_type(MOTION.at(ARRAY), p.State[Real])
    assert_type(MOTION.kind, p.Kind)
    assert_type(MOTION.turning_angles, tuple[float, float])
    assert_type(MOTION.certify(1.0), p.Certificate[float])
    assert_type(MOTION.certify([1.0, 2.0]).attitude, Real)
    assert_type(MOTIONS.certify(1.0), p.Certificate[Real])
    assert_type(MOTION.piece_at(1.0), p.Piece)
    assert_type(MOTION.euler_rates(STARTS), p.Rates[Real])
    assert_type(MOTION.at(p.ExactTimes(5)), p.State)
    assert_type(MOTIONS.at(1.0), p.State[Real])
    assert_type(MOTIONS.turning_angles, tuple[Real, Real])
    assert_type(MOTIONS.precession_period, Real)
    assert_type(p.find_period(1.0), float)
    assert_type(p.find_period(ARRAY), Real)
    assert_type(p.EffectivePotential.from_state(ONE, START).energy, float)
    assert_type(p.theta_acceleration(ONE, 0.5, 1.0, 9.0), Real)
    assert_type(p.theta_torque(ONE, 0.5, 1.0, 9.0), Real)
    assert_type(p.precessing_frame_torques(ONE, 0.5, 1.0, 9.0), p.FrameTorques)
    assert_type(p.angular_acceleration(MOTION, START), Real)
    assert_type(p.point_acceleration(MOTION, START, (0, 0, 1)), Real)
    assert_type(p.specific_force(MOTION, START, (0, 0, 1)), Real)
    assert_type(p.balance(MOTION, 2.0, 1.0), p.Balance)
    ledger = p.Ledger.from_times(MOTION, 0.0, 1.0)
    assert_type(ledger, p.Ledger)
    assert_type(ledger.gravity, p.Contribution)
    assert_type(ledger.gained, p.Energies)
    assert_type(p.Exchange.from_ledger(ledger), p.Exchange)
    assert_type(p.kernel_version(), str)


def see_kicks() -> None:
    """Kicks keep one one, and many many."""
    assert_type(p.hurry(START), p.State[float])
    assert_type(p.hurry(STARTS), p.State[Real])
    assert_type(p.hurry(START, [1.1, 1.2]), p.State[Real])
    assert_type(p.set_precession_rate(START, 3.0), p.State[float])
    assert_type(p.set_precession_rate(START, ARRAY), p.State[Real])
    assert_type(p.push_axle(ONE, START, 1e-5), p.State[float])
    assert_type(p.push_axle(MANY, START, 1e-5), p.State[Real])
    assert_type(p.apply_impulse(ONE, START, (0, 0, 1)), p.State)
    assert_type(p.precession_rate(START), float)
    assert_type(p.precession_rate(STARTS), Real)
    assert_type(p.validate_hold("spin_rate"), p.Hold)
    assert_type(p.HOLDS, tuple[p.Hold, ...])
    assert_type(p.Pushes(1e-5, 20.0, 3).rate, float)
    assert_type(p.MOST_PUSHES, int)
    assert_type(p.PUSH_RATES, tuple[float, float])


def see_verdicts() -> None:
    """A record for one, a record of arrays for many."""
    assert_type(p.perrys_rule(ONE, START), p.Verdict)
    assert_type(p.perrys_rule(MANY, START), p.Verdicts)
    assert_type(p.perrys_rule(ONE, STARTS, 1.4), p.Verdicts)
    assert_type(p.perrys_rule(ONE, START, [1.2, 1.4]), p.Verdicts)
    assert_type(p.perrys_rule(ONE, START).cause, p.Cause)
    assert_type(p.perrys_rule(ONE, START).direction, p.Direction)
    verdict = p.kick_verdict(MOTION, START, "spin_rate")
    assert_type(verdict, p.KickVerdict)
    assert_type(verdict.highest, p.Lift)
    assert_type(verdict.means, p.MeanChange | None)
    assert_type(p.clamp_verdict(ONE, START), p.ClampVerdict)
    assert_type(p.compare_hurried(ONE, 0.5, 3.0, 9.0), p.HurryEffect)
    assert_type(p.gimbal_shares((1e-3, 0.0, 2e-3)), p.GimbalShares)


def see_references() -> None:
    """Any number of digits, and the same motions on a GPU."""
    assert_type(reference.exact_state(ONE, START, 1.0), reference.ProvedState)
    assert_type(reference.exact_constants(ONE, START), reference.ProvedConstants)
    assert_type(reference.exact_constants(ONE, START).kind, str)
    motions = gpu.Motions(MANY, START)
    assert_type(motions.at(ARRAY), gpu.States)
    assert_type(motions.at_each(ARRAY), gpu.States)
    assert_type(motions[0], p.Motion)
    assert_type(gpu.DeviceError("no GPU"), gpu.DeviceError)


def see_sensors() -> None:
    """A sensor that is fixed to the body."""
    sensor = imu.Imu(rate=100.0)
    assert_type(sensor, imu.Imu)
    record = imu.record_imu(MOTION, sensor, 1.0)
    assert_type(record, imu.ImuRecord)
    assert_type(record.attitudes, Real)
    assert_type(imu.Magnetometer(), imu.Magnetometer)
    assert_type(imu.CONSUMER, imu.Imu)


def see_scores() -> None:
    """The scorer of the test set."""
    problem = score.read_problems()["cusps"]
    assert_type(problem, score.Problem)
    assert_type(score.read_trajectory(Path("t.csv"), problem), tuple[Real, Real | None])
    assert_type(score.score_trajectory(Path("t.csv"), problem), score.Score)


def see_nodes() -> None:
    """A top in the process of a program."""
    assert_type(top_node.TopNode(), top_node.TopNode)
