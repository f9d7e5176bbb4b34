// What a compiler says of a controller's sources, for a person.
#pragma once

#include <string>

namespace gauntlet {

// The lines of the output of CMake and the compiler that tell of errors, the first twenty, each once; then,
// of every header that was not found, what it belongs to and what to do, and of a macro how to define it. All
// of the output when no line tells of an error.
std::string BuildErrors(const std::string& output);

}  // namespace gauntlet
