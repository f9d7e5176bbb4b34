// Finding experiment files: by path, or by name among the shipped ones.
#include <fmt/format.h>

#include <cstdlib>
#include <system_error>
#include <utility>

#include "base/nearest_name.h"
#include "base/system/atomic_file.h"
#include "base/system/program_path.h"
#include "search/experiment/experiment_file.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

// No experiment is this long: a larger file was named by mistake.
constexpr std::size_t kMaxFileBytes = 1 << 20;

Result<std::string> ReadFile(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return InvalidInput(fmt::format("'{}' is a folder, not an experiment file", path.string()));
  }
  Result<std::string> text = ReadSmallFile(path.string(), kMaxFileBytes);
  if (text.ok()) return text;
  if (text.error().kind == ErrorKind::kNotFound) {
    return Error{ErrorKind::kNotFound, fmt::format("there is no experiment file '{}'", path.string())};
  }
  if (text.error().kind != ErrorKind::kCorrupt) return text;
  return InvalidInput(
      fmt::format("'{}' is larger than {} bytes: no experiment file", path.string(), kMaxFileBytes));
}

}  // namespace

std::vector<fs::path> ExperimentDirectories() {
  if (const char* override_directory = std::getenv("GAUNTLET_EXPERIMENTS_DIR")) return {override_directory};
  const fs::path programs = fs::path(MasterProgramPath()).parent_path();
  std::vector<fs::path> directories;
  for (const char* place : {"../share/gauntlet/experiments", GAUNTLET_EXPERIMENTS_FROM_PROGRAM})
    directories.push_back((programs / place).lexically_normal());
  return directories;
}

std::map<std::string, fs::path> ShippedFiles(const std::string& folder) {
  std::map<std::string, fs::path> files;
  for (const fs::path& directory : ExperimentDirectories()) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory / folder, error)) {
      if (entry.path().extension() == ".toml") files.emplace(entry.path().stem().string(), entry.path());
    }
  }
  return files;
}

std::vector<ShippedExperiment> ListExperiments(const Catalogue& catalogue) {
  std::vector<ShippedExperiment> list;
  for (const auto& [name, path] : ShippedFiles()) {
    ShippedExperiment shipped{
        .name = name, .path = path, .description = "", .scenario = "", .controller = "", .error = ""};
    const Result<Experiment> experiment = LoadExperiment(path.string(), {}, catalogue);
    if (experiment.ok()) {
      shipped.description = experiment->description;
      shipped.scenario = experiment->scenario;
      shipped.controller = experiment->controller;
    } else {
      shipped.error = experiment.error().message;
    }
    list.push_back(std::move(shipped));
  }
  return list;
}

Result<Experiment> LoadExperiment(const std::string& name_or_path, const std::vector<std::string>& sets,
                                  const Catalogue& catalogue) {
  TRY(const auto source, ReadExperimentText(name_or_path));
  return ParseExperiment(source.text, source.file_name, sets, catalogue);
}

Result<ExperimentText> ReadExperimentText(const std::string& name_or_path) {
  const auto read = [](const fs::path& path) -> Result<ExperimentText> {
    TRY(auto text, ReadFile(path));
    return ExperimentText{std::move(text), path.string()};
  };
  if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml"))
    return read(name_or_path);
  const std::map<std::string, fs::path> files = ShippedFiles();
  if (const auto found = files.find(name_or_path); found != files.end()) return read(found->second);
  if (files.empty()) {
    std::vector<std::string> places;
    for (const fs::path& directory : ExperimentDirectories()) places.push_back(directory.string());
    return Error{
        ErrorKind::kNotFound,
        fmt::format("there is no experiment '{}', because none can be read in {}: the program has to stand "
                    "where it was installed or built, or GAUNTLET_EXPERIMENTS_DIR name their folder",
                    name_or_path, fmt::join(places, " or "))};
  }
  std::vector<std::string_view> names;
  for (const auto& [name, path] : files) names.push_back(name);
  const std::string nearest = NearestName(name_or_path, names);
  const std::string hint = nearest.empty() ? fmt::format("; shipped: {}", fmt::join(names, ", "))
                                           : fmt::format("; did you mean '{}'?", nearest);
  return Error{ErrorKind::kNotFound,
               fmt::format("unknown experiment '{}'{} (a file is named by a path ending in .toml)",
                           name_or_path, hint)};
}

}  // namespace gauntlet
