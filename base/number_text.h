// Numbers as people write them, for messages: the shortest text that reads back as the same number, the same
// in every locale.
#pragma once

#include <cstdint>
#include <string>

namespace gauntlet {

std::string NumberText(double value);
// "1,234,567".
std::string FormatCount(std::uint64_t count);
// "(x, y)"
std::string PointText(double x, double y);

}  // namespace gauntlet
