#include "base/system/program_path.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace gauntlet {
namespace {

// "" when there is none.
std::string Variable(const char* name) {
  const char* given = std::getenv(name);
  return given == nullptr ? "" : given;
}

}  // namespace

std::string MasterProgramPath() {
  if (std::string given = Variable("GAUNTLET_PROGRAM"); !given.empty()) return given;
  std::error_code error;
  const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? "gauntlet" : path.string();
}

std::string WorkerProgramPath() {
  if (std::string given = Variable("GAUNTLET_WORKER"); !given.empty()) return given;
  return std::filesystem::path(MasterProgramPath()).replace_filename("gauntlet-worker");
}

}  // namespace gauntlet
