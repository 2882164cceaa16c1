"""`top_imu`: records of an inertial sensor, exact or noisy, without ROS. Nothing imports it."""

from symtop_ros.imu.record import ImuRecord, record_imu
from symtop_ros.simulation.sensor import CONSUMER, Imu

__all__ = ["CONSUMER", "Imu", "ImuRecord", "record_imu"]
