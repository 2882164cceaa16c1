"""The start of the node: it imports what its run needs, and nothing else."""

from programs import run_python

from workshop.load.domains import share_domain

DOMAIN = share_domain()
# Each took 1 to 30 ms of a start, for what few runs ask for.
UNNEEDED = {"difflib", "http.client", "mcap", "numpy.ma", "rerun", "ssl", "urllib.request", "xml"}
CODE = """
import sys
import rclpy
import symtop_ros.ros.node.main
from symtop_ros.ros.node.top_node import TopNode
rclpy.init(domain_id=int(sys.argv[1]))
node = TopNode()
print(*sys.modules)
node.destroy_node()
rclpy.shutdown()
"""


def test_it_imports_nothing_that_a_run_without_a_log_does_not_need():
    done = run_python(CODE, DOMAIN)
    assert done.returncode == 0, done.stderr
    loaded = set(done.stdout.split())
    assert "symtop_ros.ros.node.top_node" in loaded
    assert not loaded & UNNEEDED
