#include "base/number_text.h"

#include <charconv>

namespace gauntlet {

std::string NumberText(double value) {
  char buffer[32];
  const std::to_chars_result result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, result.ptr);
}

std::string PointText(double x, double y) {
  std::string text = "(";
  text.append(NumberText(x)).append(", ").append(NumberText(y)).append(")");
  return text;
}

}  // namespace gauntlet
