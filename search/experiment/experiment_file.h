// Experiments as TOML: reading with overrides, writing resolved, and the shipped ones by name. Everything is
// checked before anything starts.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment.h"
#include "search/experiment/schema.h"

namespace gauntlet {

// Reads an experiment that names what is in the catalogue; its [slurm] table is left to
// slurm/slurm_settings.h. `sets` are "key=value" and win over the file, the last of one key over the earlier.
// Whatever is not given has its default, so all parameters of scenario and controller are resolved; the name
// defaults to the file's. Errors begin with the place, "file:line:column" or "--set key=value", and name key,
// value and what is allowed; an unknown key comes with the nearest known one.
Result<Experiment> ParseExperiment(std::string_view text, const std::string& file_name,
                                   const std::vector<std::string>& sets, const Catalogue& catalogue);

// Reads a shipped experiment by its name, or a file by its path (with a '/' or ending in ".toml"). Errors as
// above, or kNotFound with the nearest shipped name, or kIo.
Result<Experiment> LoadExperiment(const std::string& name_or_path, const std::vector<std::string>& sets,
                                  const Catalogue& catalogue);

struct ExperimentText {
  std::string text;
  std::string file_name;
};
// The text that LoadExperiment would read.
Result<ExperimentText> ReadExperimentText(const std::string& name_or_path);

// Of a definition of a command (controllers/command/definition.h), where a library has ".so".
inline constexpr const char* kCommandEnding = ".command";
inline bool IsCommandFile(std::string_view file) {
  return file.ends_with(kCommandEnding);
}
// FOLDER/HASH.command where there is one, else FOLDER/HASH.so.
std::string PluginFileIn(const std::string& folder, const std::string& hash);

// The libraries that an experiment's text asks for: those of plugins = ["FILE", ...], by a path relative to
// the file, and the copy that a resolved experiment has beside it. Errors as above; of a file that belongs to
// somebody else also those of CheckOnlyWeWrite about a library and its folder.
Result<std::vector<std::string>> PluginFilesOf(const ExperimentText& experiment);

// The resolved experiment, every default written out, with what each key means. ParseExperiment gives back an
// equal one. `header` are comment lines for the top, without '#'.
std::string WriteExperiment(const Experiment& experiment, const std::vector<std::string>& header,
                            const Catalogue& catalogue);

struct ShippedExperiment {
  std::string name;  // the file's, without ".toml": what the command line takes
  std::filesystem::path path;
  std::string description;
  std::string scenario;
  std::string controller;
  std::string error;  // why the file cannot be read; "" when it can
};

// Where shipped experiments are looked for, the first folder that has the name wins:
// $GAUNTLET_EXPERIMENTS_DIR alone when it is set; else <folder of the program>/../share/gauntlet/experiments,
// then experiments/ of the sources.
std::vector<std::filesystem::path> ExperimentDirectories();
// The TOML files there, or in this folder of each, by their names without ".toml".
std::map<std::string, std::filesystem::path> ShippedFiles(const std::string& folder = "");

// All shipped experiments by name.
std::vector<ShippedExperiment> ListExperiments(const Catalogue& catalogue);

}  // namespace gauntlet
