// The plug-ins that a master was told of. It loads none itself: it asks gauntlet-worker what a library
// brings, and knows names, parameters and ranges from then on (controllers/registry.h). How a run of a
// plug-in's scenario begins it asks gauntlet-worker too, and remembers the answer.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment_file.h"

namespace gauntlet {

// Makes the library's controllers and scenarios known, whose file the user names; its SHA-256. An
// experiment's file, NAME.toml, stands for the command that it defines. Error: it cannot be read, it is a
// campaign's copy that somebody else could have written, or why gauntlet-worker refuses it; what is built in
// has the name of one.
Result<std::string> AddPluginFile(const std::string& file);

// The same, and adds it to those of `hashes`, which are known. Error: also that one of them brings a
// controller, or a scenario, of one name.
Status AddPluginFile(const std::string& file, std::vector<std::string>& hashes);

// The same of several files, in their order.
Result<std::vector<std::string>> AddPluginFiles(const std::vector<std::string>& files);

// What the experiment may name: what is built in, what its text asks for (PluginFilesOf), `files`, and what
// its table [command] defines (AddCommandOf, with `sets` and `allowed`).
Result<Catalogue> CatalogueFor(const ExperimentText& experiment, const std::vector<std::string>& sets,
                               const std::vector<std::string>& files = {},
                               const std::vector<std::string>& allowed = {});

// The same of a library that was described before: `description` as controllers/rows/plugin_rows.h writes it,
// which is called `place` in errors; `brought_along` as in controllers::PluginInfo.
Status AddDescribedPlugin(const std::string& hash, const std::string& file, const std::string& description,
                          const std::string& place, bool brought_along = false);

// What the plug-in has answered to how runs begin (proto/run_beginning.h), by the SHA-256 of the serialized
// spec, so that it need not be asked again.
std::map<std::string, std::string> AnswersOf(const std::string& hash);
void AddAnswer(const std::string& hash, const std::string& spec, std::string answer);

}  // namespace gauntlet
