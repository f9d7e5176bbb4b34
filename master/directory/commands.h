// The commands that a master was told of: definitions of programs, which are plug-ins whose rows come from
// data (controllers/command/definition.h). Beside a definition, HASH.command, lies the folder files/ with
// what its runs find in theirs, by SHA-256.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "controllers/command/definition.h"
#include "controllers/registry.h"
#include "search/experiment/experiment_file.h"

namespace gauntlet {

// The folder of a definition's files, beside it.
inline constexpr const char* kCommandFiles = "files";

// What the experiment's text and these "key=value" define, with its files, which are read and copied: what
// becomes of them afterwards changes nothing. They are regular ones below the experiment's folder, or among
// `allowed`, paths that the user has named. Its SHA-256; nothing of an experiment without a table [command].
// Error: as ReadCommand, or what is wrong with a file.
Result<std::optional<std::string>> AddCommandOf(const ExperimentText& experiment,
                                                const std::vector<std::string>& sets,
                                                const std::vector<std::string>& allowed);

// Makes the command known whose definition is in this file, HASH.command; its SHA-256. Error: it cannot be
// read, or is none.
Result<std::string> AddCommandFile(const std::string& file);

// The definition of a command that is known.
Result<controllers::command::Definition> CommandOf(const std::string& hash);

// Copies the files of a definition from beside it to this folder.
Status CopyCommandFiles(const std::string& file, const std::string& folder);

// How its runs begin: nothing is known of its robots. For PluginInfo::begin.
Result<sim::RunBeginning> BeginCommand(const sim::RunSpec& spec);

}  // namespace gauntlet
