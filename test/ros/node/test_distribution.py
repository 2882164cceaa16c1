"""The distribution of ROS, and the profiles of config/ that its Fast DDS understands."""

import sys

import pytest
from programs import environment, execute

from symtop_ros.ros.node import host
from symtop_ros.ros.node.host import VARIABLES, distribution_name, use_profile
from symtop_ros.run.simulation.presets import config_folder
from workshop.load.domains import share_domain
from workshop.load.links import LOSSY_FILES


@pytest.fixture(autouse=True)
def _own_environment(monkeypatch):
    for name in (*VARIABLES, "ROS_DISTRO"):
        monkeypatch.setenv(name, "")


@pytest.mark.parametrize(
    ("version", "name", "variable"),
    [
        ("3.3.16", "humble", "FASTRTPS_DEFAULT_PROFILES_FILE"),
        ("7.1.6", "jazzy", "FASTRTPS_DEFAULT_PROFILES_FILE"),
        ("9.1.2", "kilted", "FASTDDS_DEFAULT_PROFILES_FILE"),
        ("99.0.0", "", "FASTDDS_DEFAULT_PROFILES_FILE"),
    ],
)
def test_the_version_of_rclpy_tells_the_distribution(version, name, variable, monkeypatch):
    monkeypatch.setattr(host.metadata, "version", lambda _: version)
    assert distribution_name() == name
    use_profile("fastdds_discovery.xml")
    chosen = {each: host.os.environ[each] for each in VARIABLES}
    assert chosen.pop(variable).endswith("config/fastdds_discovery.xml")
    assert set(chosen.values()) == {""}


def test_the_installed_distribution_is_known():
    assert distribution_name() in host.NAMES.values()


def test_a_sourced_ros_names_itself(monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "rolling")
    assert distribution_name() == "rolling"


@pytest.mark.parametrize("variable", VARIABLES)
def test_a_profile_of_the_user_is_kept(variable, monkeypatch):
    monkeypatch.setenv(variable, "mine.xml")
    use_profile("fastdds_discovery.xml")
    assert sorted(host.os.environ[each] for each in VARIABLES) == ["", "mine.xml"]


DOMAIN = share_domain()
NODE = "import rclpy; rclpy.init(); rclpy.create_node('profiled'); rclpy.shutdown()"
LOSSY = LOSSY_FILES[distribution_name()]


def said_with(profile):
    """Start a node with a profile; return what it prints."""
    variables = environment(DOMAIN) | dict.fromkeys(VARIABLES, str(config_folder() / profile))
    result = execute([sys.executable, "-c", NODE], env=variables, check=True)
    return result.stdout + result.stderr


@pytest.mark.parametrize("profile", ["fastdds_discovery.xml", "fastdds_loopback.xml", LOSSY])
def test_a_profile_is_read_without_a_complaint(profile):
    assert "XMLPARSER" not in said_with(profile)


def test_one_that_is_not_understood_is_complained_of():
    (other,) = set(LOSSY_FILES.values()) - {LOSSY}
    assert "XMLPARSER" in said_with(other)
