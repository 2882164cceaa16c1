"""The promises of SECURITY.md for one machine."""

import socket
import subprocess
from itertools import product

import pytest
from listening import tcp_addresses
from log_files import Run
from programs import command, run, running
from rclpy.parameter import Parameter
from ros.node.running_top import RunningTop
from trials import choose
from waiting import until

from symtop_ros.replay import viewer
from workshop.load.domains import share_domain

pytestmark = pytest.mark.untraced
DOMAIN = share_domain()
PANEL = ("top_panel", "--node", "/top", "--port", "0", "--no-browser")
PROGRAMS = (("top_node",), ("top_ctl", "state"), ("top_live", "--web"), PANEL)


SECURED = list(product(PROGRAMS, (".", "missing")))
OFTEN = [*SECURED[:2], *SECURED[2::2]]


# Without a keystore all programs fail on the same way: top_node stands for them in `make test`.
@pytest.mark.parametrize("case", choose(SECURED, OFTEN))
def test_told_to_be_secure_a_program_does_not_run_without(case, tmp_path, monkeypatch):
    words, keystore = case
    name = words[0]
    (tmp_path / "enclaves" / "top" / name).mkdir(parents=True)  # of which all files are missing
    monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
    monkeypatch.setenv("ROS_SECURITY_STRATEGY", "Enforce")
    monkeypatch.setenv("ROS_SECURITY_KEYSTORE", str(tmp_path / keystore))
    result = run(*words, "--ros-args", "--enclave", f"/top/{name}", domain=DOMAIN)
    assert result.returncode == 1
    last = result.stderr.splitlines()[-1]
    assert last.startswith(f"{name}: ")
    assert f"of this program in domain {DOMAIN}, see SECURITY.md" in last


@pytest.mark.slow
@pytest.mark.parametrize("program", ["top_replay", "top_live"])
def test_a_viewer_in_the_browser_is_served_to_this_machine_only(program, tmp_path):
    log = Run(seconds=0.5).write(tmp_path)
    port = viewer.free_port()
    words = [str(log)] if program == "top_replay" else ["--port", str(port)]
    silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    with running(command(program, *words, "--web"), DOMAIN, **silent) as process:
        addresses = until(lambda: len(found := tcp_addresses(process.pid)) > 1 and found)
    assert {address for address, _ in addresses} == {"127.0.0.1"}
    for address in addresses:  # the viewer has ended with the program
        with socket.socket() as probe:
            assert probe.connect_ex(address) != 0


def test_no_text_that_can_be_set_from_afar_is_a_path():
    with RunningTop() as run:
        found = run.top.get_parameters_by_prefix("").items()
        texts = {name: each.value for name, each in found if each.type_ == Parameter.Type.STRING}
        assert {"scene", "record.directory", "world_frame"} <= set(texts)
        for name, value in texts.items():
            granted, why = run.change({name: "/tmp/elsewhere"})
            assert not granted
            assert "read-only" in why or " must be " in why, (name, why)
            assert run.top.get_parameter(name).value == value
        assert not run.change({"record.path": "/tmp/else"})[0]
