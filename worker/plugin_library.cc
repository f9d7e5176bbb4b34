#include "worker/plugin_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <exception>
#include <utility>
#include <vector>

#include "controllers/registry.h"
#include "proto/plugin_description.h"
#include "sdk/plugin.h"

namespace gauntlet::worker {
namespace {

using controllers::ControllerInfo;

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

proto::DescribedController DescriptionOf(const ControllerInfo& row) {
  proto::DescribedController controller = {.name = std::string(row.name),
                                           .scenario = std::string(row.scenario),
                                           .description = std::string(row.description),
                                           .parameters = {}};
  for (const controllers::ParameterInfo& info : row.parameters) {
    controller.parameters.push_back({.name = std::string(info.name),
                                     .unit = std::string(info.unit),
                                     .default_value = info.default_value,
                                     .min = info.min,
                                     .max = info.max,
                                     .integer = info.integer,
                                     .description = std::string(info.description)});
  }
  return controller;
}

struct Loaded {
  std::vector<ControllerInfo> rows;
  proto::PluginDescription description;
};

Result<Loaded> Load(const PluginFile& file) {
  const Result<const sdk::Plugin*> plugin = Open(file);
  if (!plugin) return plugin.error();
  Loaded loaded;
  try {
    loaded.rows = (*plugin)->controllers();
  } catch (const std::exception& error) {
    return Refusal(file.name, fmt::format("its list of controllers throws: {}", error.what()));
  }
  for (const ControllerInfo& row : loaded.rows) {
    loaded.description.controllers.push_back(DescriptionOf(row));
    if (!row.make) return Refusal(file.name, fmt::format("controller '{}' has no factory", row.name));
  }
  if (const Status right = proto::CheckDescription(loaded.description); !right)
    return Refusal(file.name, right.error().message);
  return loaded;
}

}  // namespace

Status LoadPlugin(const PluginFile& file) {
  Result<Loaded> loaded = Load(file);
  if (!loaded) return loaded.error();
  return controllers::AddPlugin({file.hash, file.name, "", std::move(loaded->rows)});
}

Result<std::string> DescribePlugin(const PluginFile& file) {
  const Result<Loaded> loaded = Load(file);
  if (!loaded) return loaded.error();
  return proto::WriteDescription(loaded->description);
}

}  // namespace gauntlet::worker
