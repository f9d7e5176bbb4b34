// Numbers as people write them, for messages: the shortest text that reads back as the same number, the same
// in every locale.
#pragma once

#include <string>

namespace gauntlet {

std::string NumberText(double value);
// "(x, y)"
std::string PointText(double x, double y);

}  // namespace gauntlet
