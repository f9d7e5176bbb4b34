// ROS. Where it is installed, that one counts.
#pragma once

#if __has_include_next(<ros/ros.h>)
#include_next <ros/ros.h>
#else
#error \
    "No run of Gauntlet has ROS: compile the part of the controller that decides, and leave its nodes and messages out"
#endif
