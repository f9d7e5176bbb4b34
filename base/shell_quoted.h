// Words for a POSIX shell.
#pragma once

#include <string>
#include <string_view>

namespace gauntlet {

// The word as one argument, in single quotes where the shell would change it.
std::string ShellQuoted(std::string_view word);

}  // namespace gauntlet
