// The style and the scripts of a report's pages: the files in master/pages/front, as text in the program.
#pragma once

#include <string_view>

namespace gauntlet {

extern const std::string_view kPageStyle;   // CSS
extern const std::string_view kPageScript;  // JavaScript; reads the element "data"

}  // namespace gauntlet
