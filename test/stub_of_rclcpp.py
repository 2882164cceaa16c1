"""A stub of rclcpp, against which clients in C++ are compiled: it is not on PyPI."""

import shutil
from pathlib import Path

import pytest
from programs import execute

needs_compiler = pytest.mark.skipif(not shutil.which("g++"), reason="no C++ compiler")
HEADERS = (
    "rclcpp/rclcpp.hpp",
    "rcl_interfaces/msg/parameter.hpp",
    "rcl_interfaces/srv/set_parameters_atomically.hpp",
)
# What clients use of rclcpp, with its types; it answers nothing.
STUB = """
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


def assert_compiles(source: Path, folder: Path) -> None:
    """Compile a client, with the headers of the stub in a folder; a warning is an error."""
    for name in HEADERS:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(STUB)
    warnings = ["-std=c++17", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
    execute(["g++", *warnings, "-I", folder, source], check=True, timeout=120)
