#include "base/check.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace gauntlet {

void CheckFailed(const char* condition, const char* file, int line, const std::string& message) {
  std::fprintf(stderr, "%s:%d: check failed: %s: %s\n", file, line, condition, message.c_str());
  std::signal(SIGABRT, SIG_DFL);  // this is no lack of anything, whatever a handler would say
  std::abort();
}

}  // namespace gauntlet
