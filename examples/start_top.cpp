// Ask a running top (top_node) for a start from what is seen, in C++ with rclcpp: let go at a tilt, it dips
// by an angle. The node finds the spin, begins the motion and lists all starts that have these properties.
//
// In a package of a workspace:
//
//   find_package(ament_cmake REQUIRED)
//   find_package(rclcpp REQUIRED)
//   find_package(rcl_interfaces REQUIRED)
//   add_executable(start_top start_top.cpp)
//   ament_target_dependencies(start_top rclcpp rcl_interfaces)
//
// and then: start_top /top theta 1.0 dip 0.1

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "rcl_interfaces/msg/parameter.hpp"
#include "rcl_interfaces/srv/set_parameters_atomically.hpp"
#include "rclcpp/rclcpp.hpp"

using SetParameters = rcl_interfaces::srv::SetParametersAtomically;
using namespace std::chrono_literals;

int main(int argc, char** argv) {
  const std::vector<std::string> words = rclcpp::init_and_remove_ros_arguments(argc, argv);
  if (words.size() < 4 || words.size() % 2 != 0) {
    std::cerr << "usage: start_top NODE NAME VALUE [NAME VALUE ...]" << std::endl;
    return 2;
  }
  auto request = std::make_shared<SetParameters::Request>();
  for (std::size_t k = 2; k + 1 < words.size(); k += 2) {
    rclcpp::Parameter field(words[k], std::strtod(words[k + 1].c_str(), nullptr));
    request->parameters.push_back(field.to_parameter_msg());
  }
  auto node = std::make_shared<rclcpp::Node>("start_top");
  auto client = node->create_client<SetParameters>(words[1] + "/set_initial_conditions");
  if (!client->wait_for_service(5s)) {
    std::cerr << "start_top: no answer from " << words[1] << " within 5 s" << std::endl;
    return 1;
  }
  auto answer = client->async_send_request(request);
  if (rclcpp::spin_until_future_complete(node, answer, 5s) != rclcpp::FutureReturnCode::SUCCESS) {
    std::cerr << "start_top: " << words[1] << " did not answer within 5 s" << std::endl;
    return 1;
  }
  const auto result = answer.get()->result;
  (result.successful ? std::cout : std::cerr) << result.reason << std::endl;
  rclcpp::shutdown();
  return result.successful ? 0 : 1;
}
