// The schema of experiments: one table of keys that reading TOML, --set, validation, writing, `list --json`
// and the identity of saved searches share.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/key.h"
#include "controllers/registry.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

struct Key : SettingsKey<Experiment> {
  Key() = default;
  // Without access to its place yet.
  Key(const std::string& its_path, KeyType its_type, const std::string& its_description) {
    path = its_path;
    type = its_type;
    description = its_description;
  }
  Key(SettingsKey<Experiment> key) : SettingsKey<Experiment>(std::move(key)) {}

  bool for_people = false;   // has no influence on any run
  bool of_searches = false;  // has none where the search does not read it (Reads)
  bool disturbs =
      false;  // says what is wrong with robots: "faults", "random_faults.NAME", "noise.DEVICE.NAME"
  bool came_later = false;  // than stored campaigns: left out of identities where it has its default
  bool rare = false;        // not written where it has its default and the search does not read it
};

// A broken rule that concerns more than one key, and the key to point at.
struct BrokenRule {
  std::string path;
  std::string message;
};

// What an experiment may say of a search.
struct SearchInfo {
  std::string_view name;                    // as in search.algorithm
  std::string_view description;             // one line
  std::vector<std::string_view> keys = {};  // what it reads: common keys, "genome." for a whole table
  std::span<const controllers::ParameterInfo> parameters = {};  // keys "search.NAME" that are its own
  std::string_view length = {};  // the key that only says how long it goes on; "" = there is none
  std::optional<BrokenRule> (*check)(const Experiment&) = nullptr;  // rules between its keys
};
// Whether the search reads the key "search.NAME" or "genome.NAME".
bool Reads(const SearchInfo& search, std::string_view path);

// What an experiment may name.
struct Catalogue {
  std::span<const controllers::ScenarioInfo> scenarios;
  std::span<const controllers::ControllerInfo> controllers;
  std::span<const SearchInfo> searches;
  std::vector<std::string> plugins = {};  // SHA-256 of those whose rows may be named too
  std::string command = {};               // of these, the experiment's own command, which may have namesakes
};

// Keys of every experiment, those of all searches among them, in the order they are written. Defaults are
// those of Experiment{}.
std::vector<Key> CommonKeys(const Catalogue& catalogue);
// "plugin": the plug-in that brings the controller. Written only where there is one.
Key PluginKey();
// "scenario_plugin": the one that brings the scenario. Likewise.
Key ScenarioPluginKey();
// A parameter's value, or its default when it was not given.
double ValueOf(const controllers::ParameterInfo& info, const sim::Parameters& given);
// One key per parameter: "scenario_parameters.NAME" and "controller_parameters.NAME".
std::vector<Key> ScenarioParameterKeys(const controllers::ScenarioInfo& scenario);
std::vector<Key> ControllerParameterKeys(const controllers::ControllerInfo& controller);

// Whether the experiment does not read the key, because its arena's rectangle says it.
bool SaidByRectangle(const Experiment& experiment, std::string_view path);

// The first rule between keys that the experiment breaks. `experiment.search.algorithm` is in the catalogue.
std::optional<BrokenRule> CheckRules(const Experiment& experiment, const Catalogue& catalogue);

}  // namespace gauntlet
