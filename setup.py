"""Build script of the ament_python package: the same tree from pip and from colcon."""

import re
from glob import glob
from pathlib import Path

from setuptools import find_packages, setup

NAME = "symtop_ros"
VERSION = re.search(r'__version__ = "(.+)"', Path(NAME, "__init__.py").read_text())[1]

# ROS 2 itself, for machines without one. Never a requirement: beside a ROS from apt these would
# be a second ROS. Kilted's wheels, with Fast DDS as the middleware.
ROS = [
    "ros-rclpy[fastrtps]",
    "ros-kilted-rclpy>=9.1",
    "ros-kilted-rmw-fastrtps-cpp>=9.3",  # the middleware that rclpy loads
    "ros-kilted-geometry-msgs>=5.5",
    "ros-kilted-sensor-msgs>=5.5",
    "ros-kilted-std-msgs>=5.5",
    "ros-kilted-diagnostic-msgs>=5.5",
    "ros-kilted-std-srvs>=5.5",
    "mcap>=1.5",  # what runs are recorded with; 1.5 flushes chunks
]
# Logs in 3D. Needs no ROS, and NumPy 2: beside a ROS from apt, an environment of its own.
PLAYBACK = [
    "mcap>=1.5",
    "rerun-sdk>=0.41",
]
# What top_report draws.
REPORT = [
    "matplotlib>=3.8",
    "pyarrow>=14",  # tables in Parquet
    "rerun-sdk>=0.41",
    "tqdm>=4.60",  # how far it has got
]
# What top_report measures beside SciPy, each where it is installed.
PEERS = [
    "heyoka>=7",
    "mujoco>=3.3",
    "drake>=1.40",
    "pin>=3.4",
    "exudyn>=1.13",
    "diffrax>=0.7",
]
TEST = [
    "pytest>=8",
    "coverage>=7.10",  # 7.10 measures programs that tests start
    "hypothesis>=6.100",  # random tops, and the worst of them again
    "rosbags>=0.10",  # an independent reader of logs
    "pillow>=10",  # rendered scenes are looked at
    "mpmath>=1.3",  # the reference: elliptic functions to any number of digits
]
LINT = [
    "mypy>=1.11",
    "ruff>=0.6",
    "scipy-stubs>=1.14",  # SciPy has no types of its own
    "colcon-common-extensions>=0.3",  # a test builds the package as a workspace would
]

setup(
    name=NAME,
    version=VERSION,
    packages=find_packages(include=[NAME, f"{NAME}.*"]),
    package_data={NAME: ["py.typed", "report/precision/reference.json"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        # scenes; a policy for SROS2, and profiles for Fast DDS
        (f"share/{NAME}/config", sorted(glob("config/*.yaml") + glob("config/*.xml"))),
        # where `ros2 run` looks; pip puts console scripts into bin only
        (f"lib/{NAME}", sorted(glob("resource/top_*"))),
    ],
    zip_safe=False,
    python_requires=">=3.10",
    install_requires=[
        "numpy>=1.24",  # arrays; any NumPy that a supported ROS 2 brings
        "scipy>=1.8",  # Carlson's elliptic integral R_F came with 1.8
    ],
    extras_require={
        "ros": ROS,
        "playback": PLAYBACK,
        "report": REPORT,
        "peers": PEERS,
        "test": TEST,
        "lint": LINT,
    },
    entry_points={
        "console_scripts": [
            f"top_node = {NAME}.programs:top_node",
            f"top_ctl = {NAME}.programs:top_ctl",
            f"top_replay = {NAME}.programs:top_replay",
            f"top_live = {NAME}.programs:top_live",
            f"top_report = {NAME}.programs:top_report",
        ]
    },
    author="The symtop_ros authors",
    author_email="symtop_ros@example.org",
    maintainer="The symtop_ros authors",
    maintainer_email="symtop_ros@example.org",
    description="The heavy symmetric top as a ROS 2 node: exact motion, kicks as services",
    long_description=Path("README.md").read_text(encoding="utf-8"),
    long_description_content_type="text/markdown",
    license="Apache-2.0",
)
