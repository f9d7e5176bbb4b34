#include "base/version.h"

namespace gauntlet {

std::string VersionText(const std::string& program) {
#if defined(__clang__)
  constexpr char kCompiler[] = __VERSION__;
#else
  constexpr char kCompiler[] = "GCC " __VERSION__;
#endif
  return program + " " GAUNTLET_VERSION "\ncommit " GAUNTLET_COMMIT ", compiled by " + kCompiler;
}

}  // namespace gauntlet
