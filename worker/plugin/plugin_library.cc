#include "worker/plugin/plugin_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <exception>
#include <utility>
#include <vector>

#include "controllers/registry.h"
#include "controllers/run_start.h"
#include "proto/run_beginning.h"
#include "sdk/plugin.h"
#include "worker/plugin/plugin_rows.h"

namespace gauntlet::worker {
namespace {

using controllers::ControllerInfo;
using controllers::ScenarioInfo;

Error Refusal(const std::string& file, const std::string& why) {
  return InvalidInput(fmt::format("the plug-in {}: {}", file, why));
}

// What the linker says, without the path by which the file was opened: it may be that of a descriptor.
std::string WhyNotOpened(const std::string& path) {
  const char* error = dlerror();
  std::string why = error == nullptr ? "it cannot be loaded" : error;
  if (why.starts_with(path + ": ")) why.erase(0, path.size() + 2);
  return why;
}

// Nothing of the library is called before its data says that this program can.
Result<const sdk::Plugin*> Open(const PluginFile& file) {
  void* library = dlopen(file.path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return Refusal(file.name, WhyNotOpened(file.path));
  const auto* plugin = static_cast<const sdk::Plugin*>(dlsym(library, sdk::kPluginSymbol));
  if (plugin == nullptr) {
    return Refusal(file.name, fmt::format("it exports no '{}': write GAUNTLET_PLUGIN(...) in one of its "
                                          "sources (sdk/plugin.h)",
                                          sdk::kPluginSymbol));
  }
  if (plugin->abi != sdk::kPluginAbi) {
    return Refusal(file.name, fmt::format("it was made for version {} of the plug-in interface, this program "
                                          "has version {}: compile it against the headers of this one",
                                          plugin->abi, sdk::kPluginAbi));
  }
  if (std::string_view(plugin->fingerprint) != sdk::kPluginFingerprint.c_str()) {
    return Refusal(file.name,
                   fmt::format("it was compiled against other headers, or in another way, than this "
                               "program: compile it again. plug-in: {}; program: {}",
                               plugin->fingerprint, sdk::kPluginFingerprint.c_str()));
  }
  return plugin;
}

struct Loaded {
  std::vector<ControllerInfo> controllers;
  std::vector<ScenarioInfo> scenarios;
  proto::PluginDescription description;
};

// What a master would have to ask for, or cannot do without.
Status CheckScenarioRow(const ScenarioInfo& row) {
  if (!row.create || !row.requirements) {
    return InvalidInput(fmt::format("scenario '{}' has no {}: ScenarioRow(...) puts a whole row together",
                                    row.name, row.create ? "requirements" : "create"));
  }
  if (row.passages || row.check_definition) {
    return InvalidInput(
        fmt::format("scenario '{}' has {}, which is for built-in scenarios alone: leave it out", row.name,
                    row.passages ? "passages" : "check_definition"));
  }
  return Ok{};
}

// Obstacles are no business of what a scenario demands of its arenas: whatever case a master asks with, the
// runs of the search have the same answer.
void AskWithoutObstacles(ScenarioInfo& row) {
  row.requirements = [asked = std::move(row.requirements)](const sim::Parameters& parameters,
                                                           const sim::TestCase& test_case) {
    sim::TestCase empty = test_case;
    empty.obstacles.clear();
    return asked(parameters, empty);
  };
}

Result<Loaded> Load(const PluginFile& file) {
  TRY(const sdk::Plugin* plugin, Open(file));
  Loaded loaded;
  try {
    if (plugin->controllers != nullptr) loaded.controllers = plugin->controllers();
  } catch (const std::exception& error) {
    return Refusal(file.name, fmt::format("its list of controllers throws: {}", error.what()));
  }
  try {
    if (plugin->scenarios != nullptr) loaded.scenarios = plugin->scenarios();
  } catch (const std::exception& error) {
    return Refusal(file.name, fmt::format("its list of scenarios throws: {}", error.what()));
  }
  for (const ControllerInfo& row : loaded.controllers) {
    loaded.description.controllers.push_back(DescriptionOf(row));
    if (!row.make) return Refusal(file.name, fmt::format("controller '{}' has no factory", row.name));
  }
  for (ScenarioInfo& row : loaded.scenarios) {
    loaded.description.scenarios.push_back(DescriptionOf(row));
    if (const Status right = CheckScenarioRow(row); !right) return Refusal(file.name, right.error().message);
    AskWithoutObstacles(row);
  }
  if (const Status right = proto::CheckDescription(loaded.description); !right)
    return Refusal(file.name, right.error().message);
  return loaded;
}

}  // namespace

Status LoadPlugin(const PluginFile& file) {
  TRY(Loaded loaded, Load(file));
  return controllers::AddPlugin(
      {file.hash, file.name, "", std::move(loaded.controllers), std::move(loaded.scenarios)});
}

Result<std::string> DescribePlugin(const PluginFile& file) {
  TRY(const Loaded loaded, Load(file));
  return proto::WriteDescription(loaded.description);
}

Result<std::string> DescribeBeginning(const sim::RunSpec& spec) {
  TRY(const sim::RunBeginning beginning, controllers::BeginningOf(spec));
  if (const Status right = proto::CheckBeginning(beginning); !right) {
    const controllers::PluginInfo* plugin = controllers::FindPlugin(spec.scenario_plugin);
    return Refusal(plugin == nullptr ? "" : plugin->file,
                   fmt::format("scenario '{}': {}", spec.scenario, right.error().message));
  }
  return proto::WriteBeginning(beginning);
}

}  // namespace gauntlet::worker
