#include "master/cli/common_options.h"

#include <sched.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <random>
#include <system_error>

#include <fmt/format.h>

#include "master/cli/table.h"
#include "master/directory/campaign_directory.h"
#include "master/experiment/experiment_file.h"
#include "master/search/search_table.h"

namespace gauntlet::master {
namespace {

std::optional<std::uint64_t> ParseUnsigned(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

int AvailableCores() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof(cores), &cores) != 0) return 1;
  return std::clamp(CPU_COUNT(&cores), 1, kMostWorkers);
}

}  // namespace

Result<int> ParseWorkers(const std::string& text) {
  if (text.empty()) return AvailableCores();
  const std::optional<std::uint64_t> workers = ParseUnsigned(text);
  if (!workers || *workers < 1 || *workers > static_cast<std::uint64_t>(kMostWorkers)) {
    return InvalidInput(
        fmt::format("--workers {}: must be a whole number from 1 to {}; this machine has {} cores", text,
                    kMostWorkers, AvailableCores()));
  }
  return static_cast<int>(*workers);
}

Result<double> ParseShare(const std::string& option, const std::string& text) {
  if (text.empty()) return 0.0;
  double share = -1.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), share);
  if (error == std::errc() && end == text.data() + text.size() && share >= 0.0 && share <= 1.0) return share;
  return InvalidInput(fmt::format("{} {}: must be a share from 0 to 1, e.g. 0.05", option, text));
}

Result<std::uint64_t> ParseSeed(const std::string& text) {
  if (text == "random") {
    std::random_device device;
    return (static_cast<std::uint64_t>(device()) << 32) | device();
  }
  if (const std::optional<std::uint64_t> seed = ParseUnsigned(text)) return *seed;
  return InvalidInput(
      fmt::format("--seed {}: must be a whole number from 0 to 18446744073709551615, or 'random'", text));
}

Result<int> ParseMetricsPort(const std::string& text) {
  const std::optional<std::uint64_t> port = ParseUnsigned(text);
  if (port && *port <= 65535) return static_cast<int>(*port);
  return InvalidInput(
      fmt::format("--metrics-port {}: must be a port from 1 to 65535, or 0 for any free one", text));
}

Result<std::uint64_t> ParseRunId(const std::string& text) {
  const std::optional<std::uint64_t> id = ParseUnsigned(text);
  if (id && *id >= 1) return *id;
  return InvalidInput(fmt::format("{} is no run: RUN_ID is a whole number, see 'gauntlet show DIR'", text));
}

Result<Experiment> LoadExperimentWith(const CommonOptions& options, const std::vector<ExtraSet>& extra) {
  std::vector<ExtraSet> all;
  if (!options.generations.empty())
    all.push_back({"--generations", "search.generations=" + options.generations});
  if (!options.population.empty()) all.push_back({"--population", "search.population=" + options.population});
  all.insert(all.end(), extra.begin(), extra.end());

  std::optional<std::uint64_t> seed;
  if (!options.seed.empty()) {
    const Result<std::uint64_t> parsed = ParseSeed(options.seed);
    if (!parsed) return parsed.error();
    seed = *parsed;
  }
  std::vector<std::string> sets = options.sets;
  for (const ExtraSet& one : all) {
    const std::string key = one.set.substr(0, one.set.find('=') + 1);
    for (const std::string& set : options.sets) {
      if (!set.starts_with(key) || set == one.set) continue;
      return InvalidInput(
          fmt::format("--set {}: {} already says {}; give one of them", set, one.option, one.set));
    }
    sets.push_back(one.set);
  }
  Result<Experiment> experiment = LoadExperiment(options.experiment, sets, BuiltInCatalogue());
  if (!experiment) {
    // The person typed --generations 0, not --set search.generations=0.
    Error error = experiment.error();
    for (const ExtraSet& one : all) {
      const std::string place = "--set " + one.set + ":";
      if (error.message.starts_with(place)) {
        const std::string value = one.set.substr(one.set.find('=') + 1);
        error.message = one.option + " " + value + ":" + error.message.substr(place.size());
        break;
      }
    }
    return error;
  }
  if (seed) experiment->seed = *seed;
  return experiment;
}

std::string DefaultDirectory(const std::string& experiment_name, std::time_t now) {
  std::tm utc{};
  gmtime_r(&now, &utc);
  const std::string base =
      fmt::format("campaigns/{}-{:04}{:02}{:02}T{:02}{:02}{:02}Z", experiment_name, utc.tm_year + 1900,
                  utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec);
  std::string directory = base;
  std::error_code error;
  for (int i = 2; std::filesystem::exists(directory, error); ++i) directory = fmt::format("{}-{}", base, i);
  return directory;
}

Result<std::string> NewDirectory(const CommonOptions& options, const Experiment& experiment) {
  if (options.directory.empty()) return DefaultDirectory(experiment.name, std::time(nullptr));
  if (Status creatable = CampaignDirectory::CheckCreatable(options.directory); !creatable)
    return creatable.error();
  return options.directory;
}

}  // namespace gauntlet::master
