#include "base/system/program_path.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace gauntlet {
namespace {

std::string FromEnvironment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::filesystem::path ThisExecutable() {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? "gauntlet" : path;
}

}  // namespace

std::string MasterProgramPath() {
  const std::string given = FromEnvironment("GAUNTLET_PROGRAM");
  return given.empty() ? ThisExecutable().string() : given;
}

std::string WorkerProgramPath() {
  const std::string given = FromEnvironment("GAUNTLET_WORKER");
  return given.empty() ? ThisExecutable().replace_filename("gauntlet-worker").string() : given;
}

}  // namespace gauntlet
