#include "worker/plugin/plugin_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "controllers/registry.h"
#include "controllers/rows/row_checks.h"
#include "controllers/run_start.h"
#include "proto/json_text.h"
#include "proto/run_beginning.h"
#include "sdk/plugin.h"

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

// Its rows, with their functions.
Result<controllers::PluginRows> Load(const PluginFile& file) {
  TRY(const sdk::Plugin* plugin, Open(file));
  const Result<std::string> text = plugin->rows();
  if (!text) return Refusal(file.name, text.error().message);
  TRY(const nlohmann::json json, ParseJson(*text, file.name));
  TRY(controllers::PluginRows rows, controllers::ReadRows(json, fmt::format("the plug-in {}", file.name)));
  for (ControllerInfo& row : rows.controllers) {
    row.make = [plugin, name = row.name](const sim::Parameters& resolved) {
      return plugin->make(name, resolved);
    };
  }
  for (ScenarioInfo& row : rows.scenarios) {
    // Obstacles are no business of what a scenario demands of its arenas: whatever case a master asks with,
    // the runs of the search have the same answer.
    row.requirements = [plugin, name = row.name](const sim::Parameters& parameters,
                                                 const sim::TestCase& test_case) {
      sim::TestCase empty = test_case;
      empty.obstacles.clear();
      return plugin->requirements(name, parameters, empty);
    };
    row.create = [plugin, name = row.name](const sim::RunSpec& spec,
                                           controllers::ControllerFactory controller) {
      return plugin->create(name, spec, std::move(controller));
    };
  }
  return rows;
}

}  // namespace

Status LoadPlugin(const PluginFile& file) {
  TRY(controllers::PluginRows rows, Load(file));
  return controllers::AddPlugin({.hash = file.hash,
                                 .file = file.name,
                                 .controllers = std::move(rows.controllers),
                                 .scenarios = std::move(rows.scenarios)});
}

Result<std::string> DescribePlugin(const PluginFile& file) {
  TRY(const controllers::PluginRows rows, Load(file));
  return controllers::WriteRows(rows);
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
