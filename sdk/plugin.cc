#include "sdk/plugin.h"

// Headers of libstdc++ ask it of the C library, and before glibc 2.32 there was none to link plug-ins with.
// 0: count references as if there were several threads, which is right with one, too.
extern "C" __attribute__((visibility("hidden"))) char __libc_single_threaded;
char __libc_single_threaded = 0;

namespace gauntlet::sdk {
namespace {

Error Missing(const std::string& row, const std::string& what) {
  return InvalidInput(row + "' has no " + what);
}

// What a master would have to ask for, or cannot do without.
Status CheckFunctions(const controllers::ScenarioInfo& row) {
  if (!row.create || !row.requirements) {
    return Missing("scenario '" + row.name, std::string(row.create ? "requirements" : "create") +
                                                ": ScenarioRow(...) puts a whole row together");
  }
  if (!row.failures.passages && !row.check_definition) return Ok{};
  return InvalidInput("scenario '" + row.name + "' has " +
                      (row.failures.passages ? "passages" : "check_definition") +
                      ", which is for built-in scenarios alone: leave it out");
}

}  // namespace

Result<std::string> TellRows(const controllers::PluginRows& rows) {
  for (const controllers::ControllerInfo& row : rows.controllers) {
    if (!row.make) return Missing("controller '" + row.name, "factory");
  }
  for (const controllers::ScenarioInfo& row : rows.scenarios) {
    TRY(CheckFunctions(row));
  }
  return controllers::WriteRows(rows);
}

}  // namespace gauntlet::sdk
