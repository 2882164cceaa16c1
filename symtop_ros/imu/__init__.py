"""Records of an inertial sensor on the top, exact or with noise, without ROS."""

from symtop_ros.imu.record import ImuRecord, record_imu
from symtop_ros.simulation.sensor import CONSUMER, Imu

__all__ = ["CONSUMER", "Imu", "ImuRecord", "record_imu"]
