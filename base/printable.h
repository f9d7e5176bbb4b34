// Text that came from outside, made fit for one line of a message, a log or a terminal.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace gauntlet {

// The text with its control characters (ESC, line breaks, also U+0080 to U+009F) and its bytes that are not
// UTF-8 written as escapes of C: names of files may hold anything, and a terminal obeys some of it.
std::string Printable(std::string_view text);
// An error whose message quotes such text.
Error Printable(Error error);

}  // namespace gauntlet
