"""Needs of a build farm: keys of rosdep, a changelog that bloom reads, a Debian package."""

import gzip
import os
import re
import subprocess
import sys
import venv
from pathlib import Path

import docutils.core
import pytest
import yaml

from symtop_ros import __version__

ROOT = Path(__file__).parents[1]
MANIFEST = (ROOT / "package.xml").read_text()
CHANGELOG = ROOT / "CHANGELOG.rst"
DEPENDENCIES = re.findall(r"<(\w+)_depend>([\w-]+)</", MANIFEST)
# Keys that rosdep has for Ubuntu 24.04 (noble) and 26.04 (resolute), with packages of apt: a key
# for pip alone keeps bloom from releasing.
KEYS = {
    f"python3-{name}"
    for name in ("numpy", "scipy", "yaml", "pytest", "coverage", "hypothesis", "setuptools")
}
# Packages of ROS 2 itself, in all its distributions from Jazzy on.
ROS = {
    *("builtin_interfaces", "diagnostic_msgs", "geometry_msgs", "launch", "launch_ros", "nav_msgs"),
    *("rcl_interfaces", "rclpy", "rosgraph_msgs", "sensor_msgs", "std_msgs", "std_srvs"),
    *("tf2_msgs", "visualization_msgs"),
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


def write_index(folder):
    """Write an index of ROS with one distribution, and the keys of rosdep; return variables."""
    folder.mkdir()
    keys = "".join(f"{key}: {{ubuntu: [{key}]}}\n" for key in sorted(KEYS))
    (folder / "python.yaml").write_text(keys)
    (folder / "sources.d").mkdir()
    (folder / "sources.d/20-default.list").write_text(f"yaml {(folder / 'python.yaml').as_uri()}\n")
    repositories = {
        name: {
            "release": {
                "packages": [name],
                "tags": {"release": "release"},
                "version": "1.0.0-1",
                "url": f"https://example.org/{name}.git",
            }
        }
        for name in sorted({*ROS, "ros_workspace"})
    }
    file = {"release_platforms": {"ubuntu": ["noble"]}, "repositories": repositories}
    file |= {"type": "distribution", "version": 2}
    xmls = {"release_package_xmls": {}, "source_repo_package_xmls": {}}
    cache = {"distribution_file": [file], "name": "jazzy", **xmls, "type": "cache", "version": 2}
    jazzy = {"distribution": ["jazzy.yaml"], "distribution_type": "ros2", "python_version": 3}
    jazzy |= {"distribution_cache": (folder / "cache.yaml.gz").as_uri()}
    jazzy |= {"distribution_status": "active"}
    index = {"distributions": {"jazzy": jazzy}, "type": "index", "version": 4}
    head = "%YAML 1.1\n---\n"
    (folder / "jazzy.yaml").write_text(head + yaml.safe_dump(file))
    (folder / "cache.yaml.gz").write_bytes(gzip.compress(yaml.safe_dump(cache).encode()))
    (folder / "index-v4.yaml").write_text(head + yaml.safe_dump(index))
    return {
        "ROS_HOME": str(folder / "home"),
        "ROSDEP_SOURCE_PATH": str(folder / "sources.d"),
        "ROSDISTRO_INDEX_URL": (folder / "index-v4.yaml").as_uri(),
    }


@pytest.mark.long
def test_bloom_makes_a_debian_package_of_what_is_declared(tmp_path):
    # In a separate environment: bloom wants another empy than ROS.
    venv.create(tmp_path / "venv", with_pip=True)
    programs = tmp_path / "venv/bin"
    install = [programs / "python", "-m", "pip", "install", "--quiet", "bloom", "rosdep"]
    subprocess.run(install, check=True, timeout=300)
    environment = {
        **os.environ,
        **write_index(tmp_path / "index"),
        "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
    }
    package = tmp_path / "package"
    package.mkdir()
    for name in ("package.xml", "CHANGELOG.rst", "LICENSE", "setup.py", "build_kernel.py"):
        (package / name).write_bytes((ROOT / name).read_bytes())
    generate = ["bloom-generate", "rosdebian", "--ros-distro", "jazzy"]
    for words in (
        ["rosdep", "update"],
        [*generate, "--os-name", "ubuntu", "--os-version", "noble"],
    ):
        subprocess.run(
            words, cwd=package, env=environment, check=True, timeout=120, stdin=subprocess.DEVNULL
        )
    control = (package / "debian/control").read_text()
    needed = re.search(r"^Depends: (.*)$", control, re.MULTILINE)[1]
    assert "ros-jazzy-rclpy" in needed
    assert "mpmath" not in needed + control
    changes = (package / "debian/changelog").read_text()
    assert "the heavy symmetric top in closed form" in changes
    assert sys.prefix not in changes
