"""`top_imu`: records of an inertial sensor, exact or noisy, without ROS."""

from symtop_ros.run.simulation.sensor.imu import CONSUMER, Imu, Magnetometer
from symtop_ros.truth.imu.record import ImuRecord, record_imu

__all__ = ["CONSUMER", "Imu", "ImuRecord", "Magnetometer", "record_imu"]
