"""Needs of a build farm: keys of rosdep, a changelog that bloom reads, a Debian package."""

import re

import docutils.core
from documents import ROOT

from symtop_ros import __version__

MANIFEST = (ROOT / "package.xml").read_text()
CHANGELOG = ROOT / "CHANGELOG.rst"
DEPENDENCIES = re.findall(r"<(\w+)_depend>([\w-]+)</", MANIFEST)
# Keys that rosdep has for Ubuntu 24.04 (noble) and 26.04 (resolute), with packages of apt: a key
# for pip alone keeps bloom from releasing.
NAMES = ("numpy", "scipy", "yaml", "pytest", "coverage", "hypothesis", "setuptools")
KEYS = {f"python3-{name}" for name in NAMES}
# Packages of ROS 2 itself, in all its distributions from Jazzy on.
ROS = {
    "builtin_interfaces",
    "diagnostic_msgs",
    "geometry_msgs",
    "launch",
    "launch_ros",
    "nav_msgs",
    "rcl_interfaces",
    "rclpy",
    "rosgraph_msgs",
    "sensor_msgs",
    "std_msgs",
    "std_srvs",
    "tf2_msgs",
    "visualization_msgs",
}
LINK = re.compile(r"`[^`]*<([^>:]+)>`__")
HEAD = "^" * 32
SECTION = re.compile(r"^(Forthcoming|\d+\.\d+\.\d+ \(\d{4}-\d{2}-\d{2}\))\n-+$", re.MULTILINE)


def test_each_dependency_has_a_key_of_rosdep():
    named = {name for _, name in DEPENDENCIES}
    assert named - ROS <= KEYS
    assert named >= ROS


def test_the_changelog_has_the_form_of_catkin():
    text = CHANGELOG.read_text()
    assert text.startswith(f"{HEAD}\nChangelog for package symtop_ros\n{HEAD}\n\n")
    sections = SECTION.findall(text)
    assert sections[0] == "Forthcoming" or sections[0].startswith(f"{__version__} (")
    assert len(sections) == text.count("\n-----")
    docutils.core.publish_string(
        text,
        writer="null",
        settings_overrides={"report_level": 1, "halt_level": 1},  # the least is an error
    )
    files = [ROOT / link.partition("#")[0] for link in LINK.findall(text)]
    assert [file for file in files if not file.exists()] == []


def test_every_dependency_of_the_package_is_declared():
    needed = {name for kind, name in DEPENDENCIES if kind == "exec"}
    declaration = (ROOT / "QUALITY_DECLARATION.md").read_text()
    assert needed <= set(re.findall(r"`(.+?)`", declaration))
