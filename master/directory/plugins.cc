#include "master/directory/plugins.h"

#include <fmt/format.h>

#include <deque>
#include <map>
#include <memory>
#include <utility>

#include "base/system/atomic_file.h"
#include "base/system/sha256.h"
#include "controllers/registry.h"
#include "master/dispatch/worker_program.h"
#include "proto/plugin_description.h"

namespace gauntlet::master {
namespace {

using controllers::ControllerContext;
using controllers::ControllerFactory;
using controllers::ControllerInfo;
using controllers::ParameterInfo;

// Stands where a runner has the plug-in's controller: a master only counts the robots of a swarm.
class AbsentController : public sim::Controller {
 public:
  sim::DeviceSet Devices() const override { return {}; }
  void Step(const sim::ControlStep&) override {}
};

ControllerFactory MakeAbsent(const sim::Parameters&) {
  return {[](const ControllerContext&) { return std::make_unique<AbsentController>(); }};
}

// A row and the texts that it refers to.
struct DescribedRow {
  proto::DescribedController text;
  std::vector<ParameterInfo> parameters;
};

// Rows are referred to as long as this process lives, and stay where they are.
ControllerInfo RowOf(proto::DescribedController described) {
  static std::deque<DescribedRow> rows;
  DescribedRow& row = rows.emplace_back(std::move(described));
  for (const proto::DescribedParameter& one : row.text.parameters) {
    row.parameters.push_back({.name = one.name,
                              .unit = one.unit,
                              .default_value = one.default_value,
                              .min = one.min,
                              .max = one.max,
                              .integer = one.integer,
                              .description = one.description});
  }
  return {row.text.name, row.text.scenario, row.text.description, row.parameters, MakeAbsent};
}

}  // namespace

Result<std::string> AddPluginFile(const std::string& file) {
  const Result<std::string> bytes = ReadSmallFile(file, proto::kMaxPluginBytes);
  if (!bytes) return InvalidInput("plug-in: " + bytes.error().message);
  std::string hash = Sha256(*bytes);
  if (controllers::FindPlugin(hash) != nullptr) return hash;
  const Result<std::string> description = DescribePlugin(file);
  if (!description) return description.error();
  if (Status added = AddDescribedPlugin(hash, file, *description, file); !added) return added.error();
  return hash;
}

Result<std::vector<std::string>> AddPluginFiles(const std::vector<std::string>& files) {
  std::vector<std::string> hashes;
  std::map<std::string_view, std::string> owners;  // of names, by file
  for (const std::string& file : files) {
    Result<std::string> hash = AddPluginFile(file);
    if (!hash) return hash.error();
    if (std::ranges::count(hashes, *hash) > 0) continue;
    for (const ControllerInfo& controller : controllers::FindPlugin(*hash)->controllers) {
      const auto [owner, is_new] = owners.emplace(controller.name, file);
      if (is_new) continue;
      return InvalidInput(
          fmt::format("the plug-ins {} and {} both bring a controller '{}': give one of them "
                      "another name, or leave one plug-in out",
                      owner->second, file, controller.name));
    }
    hashes.push_back(*std::move(hash));
  }
  return hashes;
}

Status AddDescribedPlugin(const std::string& hash, const std::string& file, const std::string& description,
                          const std::string& place) {
  if (controllers::FindPlugin(hash) != nullptr) return Ok{};
  Result<proto::PluginDescription> read = proto::ReadDescription(description, place);
  if (!read) return read.error();
  controllers::PluginInfo plugin{.hash = hash, .file = file, .description = description, .controllers = {}};
  for (proto::DescribedController& controller : read->controllers)
    plugin.controllers.push_back(RowOf(std::move(controller)));
  return controllers::AddPlugin(std::move(plugin));
}

}  // namespace gauntlet::master
