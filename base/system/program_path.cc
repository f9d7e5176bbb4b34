#include "base/system/program_path.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace gauntlet {
namespace {

// What the environment's `variable` names, else `name` beside this executable; "": itself.
std::string ProgramPath(const char* variable, const char* name) {
  const char* given = std::getenv(variable);
  if (given != nullptr && *given != '\0') return given;
  std::error_code error;
  std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) path = "gauntlet";
  return *name == '\0' ? path.string() : path.replace_filename(name).string();
}

}  // namespace

std::string MasterProgramPath() {
  return ProgramPath("GAUNTLET_PROGRAM", "");
}

std::string WorkerProgramPath() {
  return ProgramPath("GAUNTLET_WORKER", "gauntlet-worker");
}

}  // namespace gauntlet
