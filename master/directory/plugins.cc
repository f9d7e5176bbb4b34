#include "master/directory/plugins.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/nearest_name.h"
#include "base/system/atomic_file.h"
#include "base/system/sha256.h"
#include "controllers/registry.h"
#include "controllers/rows/row_checks.h"
#include "master/directory/commands.h"
#include "master/dispatch/pool/worker_program.h"
#include "proto/json_text.h"
#include "proto/run_beginning.h"
#include "proto/run_codec.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using controllers::ControllerInfo;

// Stands where a runner has the plug-in's controller: its robots do nothing, since a master only counts them.
class AbsentController : public sim::Controller {
 public:
  sim::DeviceSet Devices() const override { return {}; }
  void Step(const sim::ControlStep&) override {}
};

controllers::ControllerFactory MakeAbsent(const sim::Parameters&) {
  return {[](const controllers::ControllerContext&) { return std::make_unique<AbsentController>(); }};
}

// Answers of plug-ins to how runs begin, by the plug-in and by the SHA-256 of the spec that was asked about.
class Answers {
 public:
  std::optional<std::string> Find(const std::string& plugin, const std::string& spec) {
    const std::lock_guard lock(mutex_);
    const auto found = by_plugin_[plugin].find(spec);
    return found == by_plugin_[plugin].end() ? std::nullopt : std::optional(found->second);
  }
  void Add(const std::string& plugin, const std::string& spec, std::string answer) {
    const std::lock_guard lock(mutex_);
    by_plugin_[plugin].insert_or_assign(spec, std::move(answer));
  }
  std::map<std::string, std::string> Of(const std::string& plugin) {
    const std::lock_guard lock(mutex_);
    return by_plugin_[plugin];
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::map<std::string, std::string>> by_plugin_;
};

Answers& AllAnswers() {
  static Answers answers;
  return answers;
}

// Asks a process, once for each spec; again when what was kept of its answer does not read back.
Result<sim::RunBeginning> Begin(const sim::RunSpec& spec) {
  const std::string key = Sha256(proto::EncodeRunSpec(spec));
  const std::string place = "the plug-in " + controllers::FindPlugin(spec.scenario_plugin)->file;
  if (const auto known = AllAnswers().Find(spec.scenario_plugin, key)) {
    if (Result<sim::RunBeginning> beginning = proto::ReadBeginning(*known, place)) return beginning;
  }
  TRY(const std::string answer, DescribeBeginning(spec));
  Result<sim::RunBeginning> beginning = proto::ReadBeginning(answer, place);
  if (beginning) AllAnswers().Add(spec.scenario_plugin, key, answer);
  return beginning;
}

Error TakenTwice(const std::string& first, const std::string& second, std::string_view what,
                 std::string_view name) {
  return InvalidInput(
      fmt::format("the plug-ins {} and {} both bring a {} '{}': give one of them "
                  "another name, or leave one plug-in out",
                  first, second, what, name));
}

}  // namespace

Result<std::string> AddPluginFile(const std::string& file) {
  if (file.ends_with(".toml")) {
    TRY(const ExperimentText experiment, ReadExperimentText(file));
    TRY(const std::optional<std::string> command, AddCommandOf(experiment, {}, {}));
    if (command) return *command;
    return InvalidInput(fmt::format("plug-in: {} has no table [command]", file));
  }
  std::error_code missing;
  if (std::filesystem::exists(file, missing) && !std::filesystem::is_regular_file(file, missing))
    return InvalidInput(fmt::format("plug-in: {} is no regular file", file));
  const Result<std::string> bytes = ReadSmallFile(file, controllers::kMaxPluginBytes);
  if (!bytes) return InvalidInput("plug-in: " + bytes.error().message);
  std::string hash = Sha256(*bytes);
  // Whatever it is called: a campaign that somebody else filled does not speak for the user.
  if (std::filesystem::exists(std::filesystem::path(file).parent_path() / (hash + ".json"), missing)) {
    TRY(CheckCopyIsOurs(file));
  }
  if (controllers::FindPlugin(hash) != nullptr) {
    controllers::NamePlugin(hash, file);
    return hash;
  }
  if (IsCommandFile(file)) return AddCommandFile(file);
  TRY(const std::string description, DescribePlugin(file));
  TRY(AddDescribedPlugin(hash, file, description, file));
  return hash;
}

Status AddPluginFile(const std::string& file, std::vector<std::string>& hashes) {
  TRY(const std::string hash, AddPluginFile(file));
  if (std::ranges::count(hashes, hash) > 0) return Ok{};
  const controllers::PluginInfo& added = *controllers::FindPlugin(hash);
  for (const std::string& other : hashes) {
    const controllers::PluginInfo& known = *controllers::FindPlugin(other);
    for (const ControllerInfo& controller : added.controllers) {
      if (FindByName(known.controllers, controller.name) != nullptr)
        return TakenTwice(known.file, file, "controller", controller.name);
    }
    for (const controllers::ScenarioInfo& scenario : added.scenarios) {
      if (FindByName(known.scenarios, scenario.name) != nullptr)
        return TakenTwice(known.file, file, "scenario", scenario.name);
    }
  }
  hashes.push_back(hash);
  return Ok{};
}

Result<std::vector<std::string>> AddPluginFiles(const std::vector<std::string>& files) {
  std::vector<std::string> hashes;
  for (const std::string& file : files) {
    TRY(AddPluginFile(file, hashes));
  }
  return hashes;
}

Result<Catalogue> CatalogueFor(const ExperimentText& experiment, const std::vector<std::string>& sets,
                               const std::vector<std::string>& files,
                               const std::vector<std::string>& allowed) {
  TRY(std::vector<std::string> all, PluginFilesOf(experiment));
  all.insert(all.end(), files.begin(), files.end());
  Catalogue catalogue = BuiltInCatalogue();
  TRY(catalogue.plugins, AddPluginFiles(all));
  TRY(const std::optional<std::string> command, AddCommandOf(experiment, sets, allowed));
  catalogue.command = command.value_or("");
  return catalogue;
}

Status AddDescribedPlugin(const std::string& hash, const std::string& file, const std::string& description,
                          const std::string& place, bool brought_along) {
  if (controllers::FindPlugin(hash) != nullptr) return Ok{};
  TRY(const nlohmann::json json, ParseJson(description, place));
  TRY(controllers::PluginRows rows, controllers::ReadRows(json, place));
  for (ControllerInfo& row : rows.controllers) row.make = MakeAbsent;
  controllers::PluginInfo plugin{.hash = hash,
                                 .file = file,
                                 .brought_along = brought_along,
                                 .description = description,
                                 .controllers = std::move(rows.controllers),
                                 .scenarios = std::move(rows.scenarios)};
  if (!plugin.scenarios.empty()) plugin.begin = IsCommandFile(file) ? BeginCommand : Begin;
  return controllers::AddPlugin(std::move(plugin));
}

std::map<std::string, std::string> AnswersOf(const std::string& hash) {
  return AllAnswers().Of(hash);
}

void AddAnswer(const std::string& hash, const std::string& spec, std::string answer) {
  AllAnswers().Add(hash, spec, std::move(answer));
}

}  // namespace gauntlet
