// Lists in text: "a,b,c", and what stands around their parts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gauntlet {

// The parts of the text between the separators, empty ones included: one more than there are separators.
std::vector<std::string> Split(std::string_view text, char separator);

// What stands between blanks.
std::vector<std::string> WordsOf(std::string_view text);

// The text without the blanks, tabs and line ends around it.
std::string_view Trimmed(std::string_view text);

}  // namespace gauntlet
