// The controllers of a plug-in that was written for ARGoS, as rows of the registry.
#pragma once

#include <span>
#include <vector>

#include "controllers/behaviour.h"

namespace gauntlet::argos_form {

// A line of an .argos file's <controllers>: an element, or an attribute of the last element, or its text,
// which has the name "". Children of <controllers> have the depth 0. Two attributes of theirs are of the
// robots that have the controller, and have names that no attribute has.
struct ConfigurationLine {
  int depth = 0;
  const char* name = nullptr;
  const char* value = nullptr;  // null: an element
};

inline constexpr const char* kRobotsLine = " robots";  // what the robots' ids begin with
inline constexpr const char* kMessageLine =
    " rab_data_size";  // bytes of their messages, when the file says it

// A row for every controller that the library's sources register. It is called as it is registered; when
// several sections of the file are for it, those after the first are called by their ids. Each numeric
// attribute below <params> is a parameter, called by its path (`wheel_turning.max_speed`; `obstacle-2.x` of
// the second <obstacle>), whose default is the file's. `lines` live as long as the library, and so do the
// rows. Throws std::runtime_error when two classes are registered by one name, and when there are sections
// but none is for a controller of the library.
std::vector<controllers::ControllerInfo> ControllerRows(std::span<const ConfigurationLine> lines);

}  // namespace gauntlet::argos_form
