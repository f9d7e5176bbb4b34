// Durations as a person says them.
#pragma once

#include <string>

namespace gauntlet {

// "0.8 s", "42 s", "3 min 05 s", "2 h 10 min", "5 d 3 h"; "-" when not finite or negative.
std::string FormatDuration(double seconds);

}  // namespace gauntlet
