"""The client in C++: built and run where rclcpp is at hand, else read by a compiler."""

import re
import shutil
import subprocess

import pytest
from documents import ROOT
from programs import PATIENT, execute, running_node

from symtop_ros.ros.client.main import main
from workshop.load.domains import share_domain

DOMAIN = share_domain()
SOURCE = ROOT / "examples" / "start_top.cpp"
TEXT = SOURCE.read_text()
NODE, *FIELDS = re.search(r"and then: start_top (.*)", TEXT)[1].split()
BUILT = f"""
cmake_minimum_required(VERSION 3.8)
project(start_top CXX)
set(CMAKE_CXX_STANDARD 17)
{"".join(line.removeprefix("//   ") + chr(10) for line in TEXT.splitlines() if line[:5] == "//   ")}
"""
# What the client uses of rclcpp, with its types; it answers nothing.
RCLCPP = """
#pragma once
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <vector>
namespace rcl_interfaces {
namespace msg {
struct Parameter {};
struct SetParametersResult { bool successful; std::string reason; };
}
namespace srv { struct SetParametersAtomically {
  struct Request { std::vector<msg::Parameter> parameters; };
  struct Response { msg::SetParametersResult result; };
}; }
}
namespace rclcpp {
enum class FutureReturnCode { SUCCESS, INTERRUPTED, TIMEOUT };
struct Parameter {
  Parameter(const std::string&, double);
  rcl_interfaces::msg::Parameter to_parameter_msg() const;
};
template <class Service> struct Client {
  template <class Rep, class Period> bool wait_for_service(std::chrono::duration<Rep, Period>);
  std::shared_future<std::shared_ptr<typename Service::Response>> async_send_request(
      std::shared_ptr<typename Service::Request>);
};
struct Node {
  explicit Node(const std::string&);
  template <class Service> std::shared_ptr<Client<Service>> create_client(const std::string&);
};
std::vector<std::string> init_and_remove_ros_arguments(int, char const* const*);
template <class Future, class Rep, class Period> FutureReturnCode spin_until_future_complete(
    std::shared_ptr<Node>, const Future&, std::chrono::duration<Rep, Period>);
bool shutdown();
}
"""


def find_rclcpp():
    return (
        bool(shutil.which("ros2"))
        and not subprocess.run(
            ["ros2", "pkg", "prefix", "rclcpp"], capture_output=True, check=False
        ).returncode
    )


@pytest.mark.skipif(not find_rclcpp(), reason="no rclcpp: it is not on PyPI")
def test_it_is_built_and_the_node_answers(tmp_path):
    shutil.copy(SOURCE, tmp_path)
    (tmp_path / "CMakeLists.txt").write_text(BUILT)
    execute(["cmake", "-B", "build"], cwd=tmp_path, check=True, timeout=300)
    execute(["cmake", "--build", "build"], cwd=tmp_path, check=True, timeout=300)
    with running_node(DOMAIN, "scene:=cusps"):
        done = execute([tmp_path / "build" / "start_top", NODE, *FIELDS], timeout=60)
    assert done.returncode == 0
    assert "Solution 1 of 2" in done.stdout


@pytest.mark.skipif(not shutil.which("g++"), reason="no C++ compiler")
def test_a_compiler_reads_it(tmp_path):
    for name in (
        "rclcpp/rclcpp.hpp",
        "rcl_interfaces/msg/parameter.hpp",
        "rcl_interfaces/srv/set_parameters_atomically.hpp",
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(RCLCPP)
    warnings = ["-std=c++17", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
    execute(["g++", *warnings, "-I", tmp_path, SOURCE], check=True, timeout=120)


def test_a_node_answers_the_request_that_it_shows(capsys, monkeypatch, signals_as_before):
    """The same service, names and doubles, sent by top_ctl."""
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
    assert "/set_initial_conditions" in TEXT
    pairs = [f"{name}={value}" for name, value in zip(FIELDS[::2], FIELDS[1::2], strict=True)]
    with running_node(DOMAIN, "scene:=cusps"):
        assert main([*PATIENT, "--node", NODE, "start", *pairs]) == 0
    assert "Solution 1 of 2" in capsys.readouterr().out
