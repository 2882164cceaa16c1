"""Build script of the ament_python package: the same tree from pip and from colcon."""

import re
import sys
from glob import glob
from pathlib import Path

from setuptools import Extension, find_packages, setup
from setuptools.command.build_py import build_py
from setuptools.command.install_lib import install_lib

NAME = "symtop_ros"
VERSION = re.search(r'__version__ = "(.+)"', Path(NAME, "__init__.py").read_text())[1]
# `colcon build --symlink-install` runs this file by a link, from a folder without the README.
README = Path(__file__).resolve().with_name("README.md")

# ROS 2 from PyPI, with Fast DDS, for machines without one. It is an extra, never a requirement: on
# a machine with a ROS from apt it would be a second one. The two distributions exclude each other.
MESSAGES = ("geometry", "sensor", "std", "diagnostic", "visualization", "nav")


def ros(distro: str, rclpy: str, rmw: str, messages: str) -> list[str]:
    """Return the wheels of a distribution, given the versions of its packages."""
    return [
        f"ros-rclpy[fastrtps]{rclpy}",
        f"ros-{distro}-rclpy{rclpy}",
        f"ros-{distro}-rmw-fastrtps-cpp{rmw}",
        *(f"ros-{distro}-{name}-msgs{messages}" for name in MESSAGES),
        f"ros-{distro}-std-srvs{messages}",
        "mcap>=1.5",  # logs; from 1.5 on the writer can flush a chunk
        "google-re2>=1.1",  # filters of ~/get_entities, in linear time
    ]


KILTED = ros("kilted", ">=9.1,<10", ">=9.3,<10", ">=5.5,<6")
JAZZY = ros("jazzy", ">=7.1,<8", ">=8.4,<9", ">=5.3,<5.5")  # the LTS
# Logs in 3D. Needs no ROS. Rerun needs NumPy 2, which a ROS from apt does not have: there, install
# this extra into another environment.
PLAYBACK = [
    "mcap>=1.5",
    # Layouts are of types that Rerun calls unstable: each release is tried before it is let in.
    "rerun-sdk>=0.38,<0.42",
]
# Motions on an NVIDIA GPU: symtop_ros.physics.gpu. `ctk` brings NVRTC, which compiles the kernel.
GPU = {
    "gpu-cuda12": ["cupy-cuda12x[ctk]>=14"],
    "gpu-cuda13": ["cupy-cuda13x[ctk]>=14"],
}
# Figures and tables: of top_judge, and of the workshop in a checkout.
REPORT = [
    "matplotlib>=3.8",
    "pyarrow>=14",  # Parquet tables
    "rerun-sdk>=0.41",
    "tqdm>=4.60",  # progress bars
]
# Motions with any number of digits: symtop_ros.physics.reference.
REFERENCE = ["python-flint>=0.9"]  # balls, numbers with a proved radius
# The same without a proof, for tests and the report of a checkout.
DIGITS = [
    *REFERENCE,
    "mpmath>=1.4",
    "gmpy2>=2.1.5",  # mpmath uses it, and takes a third of the time; the first for Python 3.11
]
# Programs that `make -C workshop report` compares with, if they are installed.
PEERS = [
    *DIGITS,  # errors are measured from it
    "heyoka>=7",
    "cyrk>=0.20",
    "mujoco>=4",
    "drake>=1.40",
    "pin>=3.4",
    "exudyn>=1.13",
    "diffrax>=0.7",
    "ahrs>=0.4",
    "vqf>=2",
    "imufusion>=1.3",  # attitude filters
    "usd-core>=26",  # validates the stages of the top
    "distributed>=2024.8",  # a local cluster of Dask computes a map
]
TEST = [
    "pytest>=8",
    "pytest-xdist>=3.6",  # several tests at a time
    "coverage>=7.10",  # 7.10 can measure programs that tests start
    "hypothesis>=6.100",  # random tops and requests
    "rosbags>=0.11",  # an independent reader of logs
    "psutil>=6",  # addresses that programs listen on
    "pillow>=10",  # rendered scenes are compared
    "playwright>=1.40",  # drives a browser that is installed
    "axe-playwright-python>=0.1.7",  # looks for what keeps people from using the page
    *DIGITS,
    "mujoco>=4",  # reads the MJCF of the top
    "ahrs>=0.4",  # filters that are fed with its sensor
    "docutils>=0.22",  # reads the changelog
    "av>=14",  # writes films of the tests
    "zxing-cpp>=2.2",  # reads the code of a link, as a camera does
]
# The HTML site of `make docs`.
DOCS = [
    "sphinx>=8",
    "myst-parser>=4",  # Markdown
    "numpydoc>=1.8",
    "furo>=2024.8",  # theme
    "sphinx-mathjax-offline>=0.0.2",  # MathJax, so that the pages need no network
]
LINT = [
    "mypy>=1.11",
    "ruff>=0.6",
    "clang-format>=18",  # the kernel, by .clang-format
    "scipy-stubs>=1.14",  # types for SciPy
    "codespell>=2.2",
    # a test builds the package in a workspace, as with --packages-select and setup.bash
    "colcon-ros>=0.5",
    "colcon-package-selection>=0.2",
    "colcon-bash>=0.5",
]

# `colcon build --symlink-install` runs this file by a link: the other one is next to the real one.
sys.path.insert(0, str(README.parent))
from build_kernel import BuildKernel  # noqa: E402

LIBRARY = Extension(f"{NAME}.physics.kernel.libsymtop", [f"{NAME}/physics/kernel/symtop.cpp"])
COMMANDS = {"build_ext": BuildKernel}
try:
    from setuptools.command.bdist_wheel import bdist_wheel  # from 70.1 on
except ImportError:
    try:
        from wheel.bdist_wheel import bdist_wheel
    except ImportError:  # colcon needs none
        bdist_wheel = None
if bdist_wheel:

    class BuildWheel(bdist_wheel):
        """Marks the wheel: it is for a platform, and for every Python 3."""

        def get_tag(self) -> tuple[str, str, str]:
            return "py3", "none", super().get_tag()[2]

    COMMANDS["bdist_wheel"] = BuildWheel


def remove_others(folder: str, files: list[str]) -> None:
    """Remove what an earlier build left of the package: modules that are gone would be found.

    The compiled kernel stays where it is built: it is compiled anew if its sources have changed.
    """
    kept = {Path(each) for each in files}
    for path in Path(folder, NAME).rglob("*"):
        if path.is_file() and path not in kept and path.stem != "libsymtop":
            path.unlink()


class BuildPython(build_py):
    """Builds in silence if Python may write no bytecode, as colcon asks."""

    def run(self) -> None:
        """Build, and remove what is gone."""
        super().run()
        if not self.editable_mode:
            remove_others(self.build_lib, self.get_outputs())

    def byte_compile(self, files: list[str]) -> None:
        if not sys.dont_write_bytecode:
            super().byte_compile(files)


class InstallPython(install_lib):
    """The same for the installed files: colcon installs over those of before."""

    def run(self) -> None:
        """Install, and remove what is gone."""
        super().run()
        remove_others(self.install_dir, self.get_outputs())

    def byte_compile(self, files: list[str]) -> None:
        if not sys.dont_write_bytecode:
            super().byte_compile(files)


setup(
    name=NAME,
    version=VERSION,
    packages=find_packages(include=[NAME, f"{NAME}.*"]),
    ext_modules=[LIBRARY],
    cmdclass={**COMMANDS, "build_py": BuildPython, "install_lib": InstallPython},
    package_data={
        NAME: [
            "py.typed",
            "run/log/definitions.json",
            "run/simulation/run_fields.json",
            "page/web/*.css",
            "page/web/js/*.js",
            "page/web/js/*/*.js",
            "page/web/*.html",
            "page/web/*.yaml",
            "page/web/record.json",
            "page/web/texts/*.json",
            "page/web/*.wasm",
            "page/web/symbols.*",
            # the kernel for programs in C, C++ and Rust
            "physics/kernel/*.h*",
            "physics/kernel/*.cpp",
            "physics/kernel/*/*.hpp",
            # the same on a GPU
            "physics/gpu/*.npy",
            "physics/gpu/device/*",
            "physics/gpu/device/shim/*",
            "words/*.json",
        ],
        f"{NAME}.truth.fit": ["*.csv"],
        f"{NAME}.truth.testset": [
            "*.md",
            "*.xz",
            "LICENSE",
        ],
    },
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        # scenes, the SROS2 policy, profiles for Fast DDS, layouts of viewers
        (f"share/{NAME}/config", sorted(glob("config/*.*"))),
        (f"share/{NAME}/launch", sorted(glob("launch/*.launch.py"))),
        # `ros2 run` looks here. pip installs console scripts into bin only, and reads no setup.cfg;
        # colcon writes them to this folder as well (setup.cfg), over files that do the same.
        (f"lib/{NAME}", sorted(glob("resource/top_*"))),
    ],
    zip_safe=False,
    python_requires=">=3.11",
    install_requires=[
        "numpy>=1.24",  # any NumPy of a supported ROS 2
        # Those of Debian 12, the oldest system with Python 3.11: earlier wheels are for others.
        "scipy>=1.10",  # noise of the sensor, the judge; the physics does without
        "pyyaml>=6.0",  # scene files
    ],
    extras_require={
        "ros": JAZZY,
        "kilted": KILTED,
        "jazzy": JAZZY,
        "playback": PLAYBACK,
        "reference": REFERENCE,
        "report": REPORT,
        "peers": PEERS,
        "test": TEST,
        "lint": LINT,
        "docs": DOCS,
        **GPU,
    },
    entry_points={
        "console_scripts": [
            f"top_node = {NAME}.programs:top_node",
            f"top_ctl = {NAME}.programs:top_ctl",
            f"top_replay = {NAME}.programs:top_replay",
            f"top_live = {NAME}.programs:top_live",
            f"top_panel = {NAME}.programs:top_panel",
            f"top_judge = {NAME}.programs:top_judge",
            f"top_testset = {NAME}.programs:top_testset",
            f"top_model = {NAME}.programs:top_model",
            f"top_imu = {NAME}.programs:top_imu",
            f"top_fit = {NAME}.programs:top_fit",
        ]
    },
    author="The symtop_ros authors",
    author_email="symtop_ros@example.org",
    maintainer="The symtop_ros authors",
    maintainer_email="symtop_ros@example.org",
    description="The heavy symmetric top as a ROS 2 node: exact motion, kicks as services",
    long_description=README.read_text(encoding="utf-8"),
    long_description_content_type="text/markdown",
    license="Apache-2.0",
    keywords=["symmetric top", "rigid body", "precession", "ground truth", "ROS 2"],
    # placeholders, as in package.xml: the package has no public address yet
    url="https://example.org/symtop_ros",
    project_urls={"Source": "https://example.org/symtop_ros.git"},
    classifiers=[
        "Development Status :: 4 - Beta",
        "Intended Audience :: Education",
        "Intended Audience :: Science/Research",
        "Operating System :: POSIX :: Linux",
        "Programming Language :: Python :: 3",
        "Programming Language :: Python :: 3 :: Only",
        "Programming Language :: Python :: 3.11",
        "Programming Language :: Python :: 3.12",
        "Programming Language :: Python :: 3.13",
        "Programming Language :: Python :: 3.14",
        "Topic :: Education",
        "Topic :: Scientific/Engineering :: Physics",
        "Typing :: Typed",
    ],
)
