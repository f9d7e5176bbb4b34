// GAUNTLET_CHECK: a broken invariant ends the process with the values that broke it, in release builds too.
#pragma once

#include <string>

namespace gauntlet {

[[noreturn]] void CheckFailed(const char* condition, const char* file, int line, const std::string& message);

}  // namespace gauntlet

// `message` is evaluated only when the condition is false.
#define GAUNTLET_CHECK(condition, message)                                \
  do {                                                                    \
    if (!(condition)) [[unlikely]] {                                      \
      ::gauntlet::CheckFailed(#condition, __FILE__, __LINE__, (message)); \
    }                                                                     \
  } while (false)
