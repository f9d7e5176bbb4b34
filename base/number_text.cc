#include "base/number_text.h"

#include <charconv>

namespace gauntlet {

std::string NumberText(double value) {
  char buffer[32];
  const std::to_chars_result result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, result.ptr);
}

std::string FormatCount(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, ",");
  return digits;
}

std::string Plural(std::uint64_t count, std::string_view noun) {
  return std::string(noun) + (count == 1 ? "" : "s");
}

std::string Counted(std::uint64_t count, std::string_view noun) {
  return std::to_string(count) + " " + Plural(count, noun);
}

std::string PointText(double x, double y) {
  return "(" + NumberText(x) + ", " + NumberText(y) + ")";
}

}  // namespace gauntlet
