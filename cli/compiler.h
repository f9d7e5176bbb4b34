// The C++ compiler of this machine: c++, or the one that CXX names.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "base/result.h"

namespace gauntlet {

// `arguments` follow the compiler's name. `what` is compiled and stands in errors. What the compiler says of
// errors goes to `said`. Errors: there is no such compiler; it does not compile.
Status RunCompiler(std::vector<std::string> arguments, const std::string& what, std::ostream& said);

// The call of it, to be pasted into a shell.
std::string CompilerCall(const std::vector<std::string>& arguments);

}  // namespace gauntlet
