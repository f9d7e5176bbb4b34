// Numbers as people write them, for messages: the shortest text that reads back as the same number, the same
// in every locale.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace gauntlet {

std::string NumberText(double value);
// "1,234,567".
std::string FormatCount(std::uint64_t count);
// "case" of one, else "cases".
std::string Plural(std::uint64_t count, std::string_view noun);
// "1 case", "12 cases".
std::string Counted(std::uint64_t count, std::string_view noun);
// "(x, y)"
std::string PointText(double x, double y);

}  // namespace gauntlet
