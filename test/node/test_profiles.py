"""The profiles of config/ are understood by the Fast DDS of this ROS 2."""

import sys

import pytest
from programs import LOSSY_PROFILES, environment, execute

from symtop_ros.node.host import VARIABLES, distribution_name
from symtop_ros.simulation.presets import config_folder
from workshop.load.domains import claim_domain

pytestmark = pytest.mark.untraced
DOMAIN = claim_domain()
NODE = "import rclpy; rclpy.init(); rclpy.create_node('profiled'); rclpy.shutdown()"
LOSSY = LOSSY_PROFILES[distribution_name()]


def said_with(profile):
    """Start a node with a profile; return what it prints."""
    variables = environment(DOMAIN) | dict.fromkeys(VARIABLES, str(config_folder() / profile))
    result = execute([sys.executable, "-c", NODE], env=variables, check=True)
    return result.stdout + result.stderr


@pytest.mark.parametrize("profile", ["fastdds_discovery.xml", "fastdds_loopback.xml", LOSSY])
def test_a_profile_is_read_without_a_complaint(profile):
    assert "XMLPARSER" not in said_with(profile)


def test_one_that_is_not_understood_is_complained_of():
    (other,) = set(LOSSY_PROFILES.values()) - {LOSSY}
    assert "XMLPARSER" in said_with(other)
