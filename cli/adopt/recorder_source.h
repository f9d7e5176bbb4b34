// argos/recorder/recorder.cpp, as text in the program.
#pragma once

#include <string_view>

namespace gauntlet {

extern const std::string_view kRecorderSource;

}  // namespace gauntlet
