// The tables of an experiment that have a language of their own: [generic] and the lists in it,
// [[generic.light]] and on, which define a scenario, [requirements], and [conditions].
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/key.h"
#include "base/result.h"
#include "controllers/behaviour.h"
#include "search/experiment/experiment.h"
#include "search/experiment/schema.h"
#include "search/experiment/toml_text.h"

namespace gauntlet {

// What it may hold, for who lists it; of a list its first element, "generic.light.1.x". Formulas are texts.
std::vector<KeyInfo> DefinitionKeys();

// Whether the path is in that table.
bool InDefinition(std::string_view path);

// What these of the assignments define, as the text of sim::RunSpec::definition; the later of one path win.
// Error: begins with the assignment's place, or with `file_name` when something is missing.
Result<std::string> ReadDefinition(std::span<const Assignment> assignments, const std::string& file_name);

// The table that ReadDefinition reads that text from; "" of none.
std::string WriteDefinition(const std::string& definition);

// The same as keys and values, as they are typed behind --set.
std::vector<std::pair<std::string, std::string>> DefinitionSettings(const std::string& definition);

// --- [requirements], what must hold of a run ---

bool InRequirements(std::string_view path);

// What these of the assignments require of a scenario with these metrics, as the text of
// sim::RunSettings::requirements: `step` first, sentences in their order, `failure` last; of one name the
// later wins, and one that is "" is taken back. "" when there are none. Error: begins with the assignment's
// place, or with `file_name` when something is missing.
Result<std::string> ReadRequirements(std::span<const Assignment> assignments, const std::string& file_name,
                                     const std::vector<controllers::MetricInfo>& metrics);

// Of a right experiment: which windows its runs are too short for, and what then holds; one sentence each.
std::vector<std::string> WindowsBeyondTheRun(const Experiment& experiment);

// The table that ReadRequirements reads that text from; "" of none.
std::string WriteRequirements(const std::string& requirements);

// The same as keys and values, as they are typed behind --set.
std::vector<std::pair<std::string, std::string>> RequirementSettings(const std::string& requirements);

// --- [conditions], the distribution over which a failure probability is asked for ---

bool InConditions(std::string_view path);

// What these of the assignments draw, as the text of Experiment::conditions. `keys`: of the experiment.
// Error: that of ParseVariedKeys, behind the assignment's place.
Result<std::string> ReadConditions(std::span<const Assignment> assignments, std::span<const Key> keys,
                                   const Experiment& experiment);

// The table that ReadConditions reads that text from; "" of none.
std::string WriteConditions(const std::string& conditions);

}  // namespace gauntlet
