// Words for a POSIX shell.
#pragma once

#include <string>
#include <string_view>

namespace gauntlet {

// The word as one argument, in single quotes where the shell would change it.
std::string ShellQuoted(std::string_view word);
// A path in a command that somebody pastes into bash: never taken for an option, and with bytes that a
// terminal does not show as they are in bash's $'...'.
std::string PastedPath(std::string_view path);

}  // namespace gauntlet
