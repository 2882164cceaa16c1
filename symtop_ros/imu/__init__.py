"""`top_imu`: records of an inertial sensor, exact or noisy, without ROS. Nothing imports it."""

from symtop_ros.imu.record import ImuRecord, record_imu
from symtop_ros.simulation.sensor.imu import CONSUMER, Imu, Magnetometer

__all__ = ["CONSUMER", "Imu", "ImuRecord", "Magnetometer", "record_imu"]
