// ROS 2. Where it is installed, that one counts.
#pragma once

#if __has_include_next(<rclcpp/rclcpp.hpp>)
#include_next <rclcpp/rclcpp.hpp>
#else
#error \
    "No run of Gauntlet has ROS: compile the part of the controller that decides, and leave its nodes and messages out"
#endif
