// Lists in text: "a,b,c".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gauntlet {

// The parts of the text between the separators, empty ones included: one more than there are separators.
std::vector<std::string> Split(std::string_view text, char separator);

}  // namespace gauntlet
