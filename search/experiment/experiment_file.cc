#include "search/experiment/experiment_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/system/sha256.h"
#include "base/system/trusted_path.h"
#include "search/experiment/command_table.h"
#include "search/experiment/definition_table.h"
#include "search/experiment/key_assignment.h"
#include "search/experiment/toml_text.h"

namespace gauntlet {
namespace {

constexpr std::string_view kPluginsKey = "plugins";
// They decide which other keys there are.
constexpr std::array<std::string_view, 4> kBaseKeys = {"scenario", "scenario_plugin", "controller", "plugin"};

std::string NameFromFile(const std::string& file_name) {
  std::string name = std::filesystem::path(file_name).stem().string();
  for (char& c : name) {
    const bool good = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '.' || c == '_' || c == '-';
    if (!good) c = '-';
  }
  return name;
}

// Builds one experiment from assignments in order; the later ones win.
class Reader {
 public:
  Reader(std::vector<Assignment> assignments, std::string file_name, const Catalogue& catalogue)
      : assignments_(std::move(assignments)), file_name_(std::move(file_name)), catalogue_(catalogue) {}

  Result<Experiment> Read() {
    for (Key& key : CommonKeys(catalogue_)) AddWithDefault(std::move(key));
    AddWithDefault(PluginKey());
    AddWithDefault(ScenarioPluginKey());
    TRY(AssignAll(/*base=*/true));
    TRY(ResolveNames());
    TRY(AssignAll(/*base=*/false));
    TRY(Define());
    TRY(experiment_.requirements, ReadRequirements(assignments_, file_name_, scenario_->metrics));
    TRY(experiment_.conditions, ReadConditions(assignments_, keys_, experiment_));
    for (const Key& key : keys_) {
      if (SaidByRectangle(experiment_, key.path)) key.set(experiment_, key.default_value);
    }
    if (experiment_.name.empty()) experiment_.name = NameFromFile(file_name_);
    if (const std::optional<BrokenRule> broken = CheckRules(experiment_, catalogue_)) {
      return InvalidInput(fmt::format("{}: {}", PlaceOf(broken->path), broken->message));
    }
    return experiment_;
  }

 private:
  // `base`: kBaseKeys; else the others.
  Status AssignAll(bool base) {
    for (const Assignment& assignment : assignments_) {
      const bool is_base = std::ranges::count(kBaseKeys, assignment.path) > 0;
      if (base != is_base || InDefinition(assignment.path) || InCommand(assignment.path) ||
          InRequirements(assignment.path) || InConditions(assignment.path))
        continue;
      TRY(Assign(assignment));
    }
    return Ok{};
  }

  Status Assign(const Assignment& assignment) {
    if (assignment.path == kPluginsKey) return CheckPlugins(assignment);
    const Key* key = FindByName(keys_, assignment.path);
    if (key == nullptr) return UnknownKey(assignment);
    TRY(gauntlet::Assign(*key, assignment, experiment_));
    places_[key->path] = assignment.where;
    return Ok{};
  }

  Status UnknownKey(const Assignment& assignment) const {
    if (assignment.path == "slurm" || assignment.path.starts_with("slurm.")) {
      // How a cluster is used changes no result: `submit` reads this table.
      if (assignment.text.empty()) return Ok{};
      return InvalidInput(
          fmt::format("{}: settings of Slurm are given with --slurm KEY=VALUE", assignment.where));
    }
    const auto* other = std::get_if<OtherToml>(&assignment.value);
    const bool in_list = other != nullptr && other->kind == kListOfTables;
    const std::string path =
        in_list ? assignment.path.substr(0, assignment.path.rfind('.')) : assignment.path;
    const std::string example = FirstKeyOf(path);
    if (!example.empty() && other != nullptr && other->kind == "a table")
      return Ok{};  // an empty one is harmless
    if (!example.empty()) {
      return InvalidInput(fmt::format("{}: {} is a table of keys such as {}, not {}", assignment.where, path,
                                      example, KindOf(assignment.value)));
    }
    if (path == "search.mode") {
      return InvalidInput(
          fmt::format("{}: unknown key '{}'; write search.algorithm = \"steady-state\" or \"genetic\"",
                      assignment.where, path));
    }
    std::vector<std::string_view> known;
    for (const Key& key : keys_) known.push_back(key.path);
    known.insert(known.end(),
                 {kPluginsKey, "conditions.KEY", "requirements.NAME", "generic.KEY", "command.KEY"});
    return InvalidInput(fmt::format("{}: {}", assignment.where, gauntlet::UnknownKey(path, known)));
  }

  // The libraries are given to the catalogue by who has read their names (PluginFilesOf).
  static Status CheckPlugins(const Assignment& assignment) {
    if (!assignment.text.empty()) {
      return InvalidInput(fmt::format("{}: plug-ins are given with --plugin FILE, or in an experiment file",
                                      assignment.where));
    }
    if (const auto* other = std::get_if<OtherToml>(&assignment.value); other != nullptr && other->texts)
      return Ok{};
    return InvalidInput(fmt::format("{}: {} is {}, expected a list of files: [\"libmine.so\"]",
                                    assignment.where, kPluginsKey, KindOf(assignment.value)));
  }

  // "search.algorithm" of "search"; "" when there is no such table.
  std::string FirstKeyOf(const std::string& table) const {
    for (const Key& key : keys_) {
      if (key.path.starts_with(table + ".")) return key.path;
    }
    return table == "scenario_parameters" || table == "controller_parameters" ? table + ".NAME" : "";
  }

  // Looks scenario and controller up and adds the keys of their parameters, with defaults.
  Status ResolveNames() {
    if (experiment_.scenario.empty()) {
      return InvalidInput(fmt::format("{}: scenario is missing; known: {}", PlaceOf("scenario"),
                                      NamesOf(catalogue_.scenarios)));
    }
    TRY(scenario_, ResolveRow<controllers::ScenarioInfo>(
                       "scenario", experiment_.scenario, catalogue_.scenarios,
                       &controllers::PluginInfo::scenarios, experiment_.scenario_plugin));
    const controllers::ScenarioInfo* scenario = scenario_;
    if (experiment_.controller.empty()) experiment_.controller = scenario->default_controller;
    TRY(const auto controller,
        ResolveRow<controllers::ControllerInfo>("controller", experiment_.controller, catalogue_.controllers,
                                                &controllers::PluginInfo::controllers, experiment_.plugin));
    if (!scenario->Takes(*controller)) {
      return InvalidInput(fmt::format("{}: controller '{}' is written for the scenario '{}', not for '{}'",
                                      PlaceOf("controller"), controller->name, controller->scenario,
                                      scenario->name));
    }
    for (Key& key : ScenarioParameterKeys(*scenario)) AddWithDefault(std::move(key));
    for (Key& key : ControllerParameterKeys(*controller)) AddWithDefault(std::move(key));
    return Ok{};
  }

  // What [generic] says, of the scenario that it is for. What [command] says is known (ReadCommand).
  Status Define() {
    using controllers::command::kScenario;
    if (experiment_.scenario != kScenario) {
      TRY(RefuseStray(InCommand, kScenario));
    }
    if (!scenario_->check_definition) return RefuseStray(InDefinition, "generic");
    TRY(experiment_.definition, ReadDefinition(assignments_, file_name_));
    return Ok{};
  }

  // A key of the table of another scenario.
  Status RefuseStray(bool (*in_table)(std::string_view), std::string_view scenario) const {
    const auto stray = std::ranges::find_if(assignments_, in_table, &Assignment::path);
    if (stray == assignments_.end()) return Ok{};
    return InvalidInput(fmt::format("{}: {} defines the scenario '{}', and this is '{}'", stray->where,
                                    stray->path, scenario, experiment_.scenario));
  }

  // The row of that name, built in or a plug-in's. `what` it is, the key that names it; `rows` of a plug-in.
  // `plugin`: the hash that was given for it; becomes that of the plug-in that brings the row.
  template <typename Info>
  Result<const Info*> ResolveRow(const std::string& what, const std::string& name,
                                 std::span<const Info> built_in,
                                 std::vector<Info> controllers::PluginInfo::*rows, std::string& plugin) {
    std::string given = std::exchange(plugin, "");
    if (const Info* row = FindByName(built_in, name)) return row;
    const bool command =
        name == (what == "scenario" ? controllers::command::kScenario : controllers::command::kController);
    if (command && given.empty())
      given = what == "scenario" ? catalogue_.command : experiment_.scenario_plugin;
    if (!given.empty() && controllers::FindPlugin(given) == nullptr) {
      const std::string key = what == "controller" ? "plugin" : "scenario_plugin";
      return InvalidInput(
          fmt::format("{}: {} = \"{}\": this library is not here; it stands in plugins/ "
                      "of the campaign that the experiment is from",
                      PlaceOf(key), key, given));
    }
    std::vector<std::string> plugins = catalogue_.plugins;
    if (!experiment_.scenario_plugin.empty()) plugins.insert(plugins.begin(), experiment_.scenario_plugin);
    if (!given.empty()) plugins.insert(plugins.begin(), given);
    std::vector<Info> known(built_in.begin(), built_in.end());
    for (const std::string& hash : plugins) {
      const std::vector<Info>& more = controllers::FindPlugin(hash)->*rows;
      if (const Info* row = FindByName(more, name)) {
        plugin = hash;
        return row;
      }
      known.insert(known.end(), more.begin(), more.end());
    }
    if (command)
      return InvalidInput(
          fmt::format("{}: the {} '{}' needs a table [command] in the experiment's file, with "
                      "run, metrics, fitness and failure at least",
                      PlaceOf(what), what, name));
    return InvalidInput(
        fmt::format("{}: {}", PlaceOf(what), UnknownName(what, name, std::span<const Info>(known))));
  }

  void AddWithDefault(Key key) {
    key.set(experiment_, key.default_value);
    keys_.push_back(std::move(key));
  }

  std::string PlaceOf(const std::string& path) const {
    const auto found = places_.find(path);
    return found == places_.end() ? file_name_ : found->second;
  }

  std::vector<Assignment> assignments_;
  std::string file_name_;
  Catalogue catalogue_;
  Experiment experiment_;
  const controllers::ScenarioInfo* scenario_ = nullptr;  // the experiment's
  std::vector<Key> keys_;
  std::map<std::string, std::string> places_;  // path -> where it was assigned last
};

}  // namespace

Result<Experiment> ParseExperiment(std::string_view text, const std::string& file_name,
                                   const std::vector<std::string>& sets, const Catalogue& catalogue) {
  // Messages quote what was written there.
  Result<std::vector<Assignment>> assignments = ReadToml(text, file_name);
  if (!assignments.ok()) return Printable(assignments.error());
  for (const std::string& set : sets) {
    Result<Assignment> assignment = ReadSet(set);
    if (!assignment.ok()) return Printable(assignment.error());
    assignments->push_back(std::move(*assignment));
  }
  Result<Experiment> experiment = Reader(std::move(*assignments), file_name, catalogue).Read();
  if (!experiment.ok()) return Printable(experiment.error());
  return experiment;
}

std::string PluginFileIn(const std::string& folder, const std::string& hash) {
  const std::string command = fmt::format("{}/{}{}", folder, hash, kCommandEnding);
  std::error_code missing;
  return std::filesystem::exists(command, missing) ? command : fmt::format("{}/{}.so", folder, hash);
}

Result<std::vector<std::string>> PluginFilesOf(const ExperimentText& experiment) {
  const Result<std::vector<Assignment>> assignments = ReadToml(experiment.text, experiment.file_name);
  if (!assignments) return Printable(assignments.error());
  const std::filesystem::path folder = std::filesystem::path(experiment.file_name).parent_path();
  std::vector<std::string> files;
  const bool is_command = std::ranges::any_of(*assignments, [](const Assignment& assignment) {
    return assignment.path == "scenario" && TextOf(assignment.value) == controllers::command::kScenario;
  });
  for (const Assignment& assignment : *assignments) {
    const auto* other = std::get_if<OtherToml>(&assignment.value);
    if (assignment.path == kPluginsKey && other != nullptr && other->texts) {
      for (const std::string& name : *other->texts) files.push_back(folder / name);
    }
    const auto* hash = std::get_if<std::string>(&assignment.value);
    const bool names_library = assignment.path == "plugin" || assignment.path == "scenario_plugin";
    if (!names_library || hash == nullptr || !IsSha256(*hash)) continue;
    std::string file = PluginFileIn((folder / "plugins").string(), *hash);
    std::error_code missing;
    // One that is not beside the experiment may be given by --plugin.
    if (is_command && !std::filesystem::exists(file, missing)) continue;
    files.push_back(std::move(file));
  }
  // Somebody else's file does not choose what runs in our name.
  for (const std::filesystem::path file : files) {
    if (!IsForeign(experiment.file_name)) break;
    const std::string name = file.filename();
    TRY(CheckOnlyWeWrite(file.parent_path(), std::array<std::string_view, 1>{name}));
  }
  return files;
}

std::string WriteExperiment(const Experiment& experiment, const std::vector<std::string>& header,
                            const Catalogue& catalogue) {
  std::vector<Key> keys = CommonKeys(catalogue);
  const auto insert_before_tables = [&keys](std::vector<Key> more) {
    const auto in_table = [](const Key& key) { return key.path.starts_with("arena."); };
    keys.insert(std::ranges::find_if(keys, in_table), more.begin(), more.end());
  };
  const auto* scenario = experiment.scenario_plugin.empty()
                             ? FindByName(catalogue.scenarios, experiment.scenario)
                             : controllers::FindScenario(experiment);
  if (scenario != nullptr) insert_before_tables(ScenarioParameterKeys(*scenario));
  const auto* controller = experiment.plugin.empty()
                               ? FindByName(catalogue.controllers, experiment.controller)
                               : controllers::FindController(experiment);
  if (controller != nullptr) insert_before_tables(ControllerParameterKeys(*controller));
  if (!experiment.plugin.empty())
    keys.insert(std::ranges::find(keys, "controller", &Key::path) + 1, PluginKey());
  if (!experiment.scenario_plugin.empty())
    keys.insert(std::ranges::find(keys, "scenario", &Key::path) + 1, ScenarioPluginKey());

  if (const auto* search = FindByName(catalogue.searches, experiment.search.algorithm))
    std::erase_if(keys, [&](const Key& key) {
      if (SaidByRectangle(experiment, key.path)) return true;
      return key.rare && !Reads(*search, key.path) && key.get(experiment) == key.default_value;
    });

  std::string text;
  for (const std::string& line : header) text += line.empty() ? "#\n" : fmt::format("# {}\n", line);
  std::string last_table;
  for (const Key& key : keys) {
    const std::size_t dot = key.path.find('.');
    const std::string table = dot == std::string::npos ? "" : key.path.substr(0, dot);
    if (table != last_table) text += fmt::format("\n[{}]\n", table);
    last_table = table;
    text += LineOf(key.path.substr(table.empty() ? 0 : dot + 1), key, key.get(experiment));
  }
  text += WriteDefinition(experiment.definition);
  text += WriteRequirements(experiment.requirements);
  text += WriteConditions(experiment.conditions);
  return text;
}

}  // namespace gauntlet
