// The table of an experiment that defines the scenario `command`: [command] and the lists in it,
// [[command.metric]] and on.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/key.h"
#include "base/result.h"
#include "controllers/command/definition.h"
#include "search/experiment/experiment_file.h"
#include "search/experiment/toml_text.h"

namespace gauntlet {

// What it may hold, for who lists it: "command.wall_limit", of a list its first element.
std::vector<KeyInfo> CommandKeys();

// Whether the path is in that table.
bool InCommand(std::string_view path);

// What the experiment's text and the "key=value" of `sets`, which win, define; nothing of an experiment
// without such a table. Its files are named and not yet read. Error: begins with the place of what is wrong.
Result<std::optional<controllers::command::Definition>> ReadCommand(const ExperimentText& experiment,
                                                                    const std::vector<std::string>& sets);

}  // namespace gauntlet
