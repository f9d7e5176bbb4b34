#include "cli/options/options.h"

#include <sched.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <system_error>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/parse_number.h"
#include "master/directory/campaign_directory.h"
#include "master/directory/plugins.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr int kMostWorkers = 1024;

// A decimal number below 2^64, or "random", which draws one from the operating system.
Result<std::uint64_t> ParseSeed(const std::string& text) {
  if (text == "random") {
    std::random_device device;
    return (static_cast<std::uint64_t>(device()) << 32) | device();
  }
  if (const auto seed = ParseNumber<std::uint64_t>(text)) return *seed;
  return InvalidInput(
      fmt::format("--seed {}: must be a whole number from 0 to 18446744073709551615, or 'random'", text));
}

}  // namespace

CLI::Option* AddValue(CLI::App& command, const char* name, const char* type, std::string& value,
                      const char* help) {
  return command.add_option(name, value, help)->type_name(type);
}

void AddValue(CLI::App& command, const char* name, const char* type, std::vector<std::string>& values,
              const char* help) {
  command.add_option(name, values, help)->type_name(type)->allow_extra_args(false);
}

void AddMessageOptions(CLI::App& command, MessageOptions& options) {
  command.add_flag("--json", options.json, "print the result as one JSON document");
  command.add_flag("--quiet", options.quiet, "print no progress and no messages, except errors");
  command.add_flag("--no-progress", options.no_progress, "print no progress");
}

void AddServingOptions(CLI::App& command, ServingOptions& options) {
  AddValue(
      command, "--audit", "P", options.audit,
      "share of the runs, 0 to 1, that a second worker simulates too; differences are reported (default: "
      "0; not stored: give it to 'resume' again)");
  AddValue(command, "--metrics-port", "PORT", options.metrics_port,
           "serve Prometheus metrics on this port of 127.0.0.1 (0: any free port)");
  AddMessageOptions(command, options);
}

void AddRunningOptions(CLI::App& command, RunningOptions& options) {
  AddValue(command, "--workers", "N", options.workers,
           "number of worker processes on this machine (default: one for each core)");
  AddServingOptions(command, options);
}

void AddJobsOption(CLI::App& command, RunningOptions& options) {
  AddValue(command, "--slurm", "KEY=VALUE", options.slurm,
           "workers are jobs of a cluster, as 'gauntlet submit' has them, while this process stays their "
           "master, e.g. "
           "--slurm cluster=slurm; repeatable");
}

void AddBindOptions(CLI::App& command, BindOptions& options) {
  AddValue(
      command, "--bind", "ENDPOINT", options.endpoint,
      "the address to which workers connect: tcp://ADDRESS:PORT (IPv4; 0.0.0.0: every interface; port *: "
      "any free port) or ipc://PATH");
  command.add_flag(
      "--insecure", options.insecure,
      "no encryption and no keys: everybody who reaches the address, which includes every user of this "
      "machine, can send results");
}

void AddExperimentOptions(CLI::App& command, ExperimentOptions& options) {
  command
      .add_option("EXPERIMENT", options.experiment,
                  "a shipped experiment ('gauntlet list experiments' names them) or a TOML file")
      ->required();
  AddValue(command, "--dir", "DIR", options.directory,
           "directory of the campaign: new or empty (default: campaigns/EXPERIMENT-<UTC time>)");
  AddValue(command, "--seed", "S|random", options.seed,
           "seed of the campaign (default: the experiment's, 1)");
  AddValue(command, "--set", "KEY=VALUE", options.sets,
           "change one value of the experiment, e.g. --set search.mutation_probability=0.1; repeatable");
  AddPluginOption(command, options.plugins);
  AddValue(command, "--allow-file", "FILE", options.allowed_files,
           "of a command: a file from elsewhere that every run finds in its folder; repeatable");
}

void AddPluginOption(CLI::App& command, std::vector<std::string>& plugins) {
  AddValue(command, "--plugin", "LIB.so", plugins,
           "load a library of yours, so that its controllers and scenarios can be named, e.g. --set "
           "controller=mine; repeatable");
}

void AddSizeOptions(CLI::App& command, SizeOptions& options) {
  AddValue(command, "--generations", "G", options.generations, "short for --set search.generations=G");
  AddValue(command, "--population", "P", options.population, "short for --set search.population=P");
}

void AddSweepOptions(CLI::App& command, SweepOptions& options, const std::string& example) {
  AddValue(command, "--sweep", "KEY=A,B,...", options.sweeps,
           ("one search for each value, e.g. --sweep " + example +
            "; if repeated, one search for each combination")
               .c_str());
  AddValue(command, "--seeds", "1..20|1,5,9", options.seeds,
           "one search for each seed; with --sweep, for each combination and seed");
}

void AddSlurmOptions(CLI::App& command, SlurmOptions& options) {
  AddValue(command, "--master", "job|here", options.master,
           "job (default): the master is a job as well; here: the master runs in this process")
      ->check(CLI::IsMember({"job", "here"}));
  AddValue(command, "--slurm", "KEY=VALUE", options.settings,
           "a setting of the jobs or of the pool, e.g. --slurm partition=short; repeatable");
}

void AddLocalOptions(CLI::App& command, LocalOptions& options, bool sizes) {
  AddExperimentOptions(command, options.experiment);
  AddSizeOptions(command, options.size);
  AddRunningOptions(command, options.running);
  AddJobsOption(command, options.running);
  command.add_flag(
      "--dry-run", options.dry_run,
      "simulate only a few runs and write nothing; print how many runs there would be, about how "
      "long they would take on this machine, and how much disk space they would need");
  if (sizes) return;
  for (const char* option : {"--generations", "--population"}) command.get_option(option)->group("");
}

void AddDirectory(CLI::App& command, std::string& directory) {
  command.add_option("DIR", directory, "directory of the campaign")->required();
}

int AvailableCores() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof(cores), &cores) != 0) return 1;
  return std::clamp(CPU_COUNT(&cores), 1, kMostWorkers);
}

Result<int> ParseWorkers(const std::string& text) {
  if (text.empty()) return AvailableCores();
  const auto workers = ParseNumber<int>(text);
  if (workers && *workers >= 1 && *workers <= kMostWorkers) return *workers;
  return InvalidInput(
      fmt::format("--workers {}: must be a whole number from 1 to {}; this machine has {} cores", text,
                  kMostWorkers, AvailableCores()));
}

Result<double> ParseShare(const std::string& option, const std::string& text) {
  if (text.empty()) return 0.0;
  const auto share = ParseNumber<double>(text);
  if (share && *share >= 0.0 && *share <= 1.0) return *share;
  return InvalidInput(fmt::format("{} {}: must be a share from 0 to 1, e.g. 0.05", option, text));
}

Result<int> ParsePort(const std::string& option, const std::string& text) {
  if (text.empty()) return 0;
  if (const auto port = ParseNumber<std::uint16_t>(text)) return *port;
  return InvalidInput(
      fmt::format("{} {}: must be a port from 1 to 65535, or 0 for any free one", option, text));
}

std::vector<ExtraSet> SetsOf(const SizeOptions& options) {
  std::vector<ExtraSet> sets;
  if (!options.generations.empty())
    sets.push_back({"--generations", "search.generations", options.generations});
  if (!options.population.empty()) sets.push_back({"--population", "search.population", options.population});
  return sets;
}

Result<std::vector<std::string>> JoinSets(const std::vector<std::string>& sets,
                                          const std::vector<ExtraSet>& extra) {
  std::vector<std::string> all = sets;
  for (std::size_t i = 0; i < extra.size(); ++i) {
    const auto& [option, key, value] = extra[i];
    const std::string one = fmt::format("{}={}", key, value);
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (!all[j].starts_with(key + "=") || all[j] == one) continue;
      const std::string other =
          j < sets.size() ? fmt::format("--set {}", all[j]) : extra[j - sets.size()].AsTyped();
      const std::string_view name = std::string_view(option).substr(0, option.find('='));
      return InvalidInput(fmt::format("{}: {} already says {}; give one of them", other, name, one));
    }
    all.push_back(one);
  }
  return all;
}

std::string ExtraSet::AsTyped() const {
  return option + (option.ends_with('=') ? "" : " ") + value;
}

// The person typed --generations 0, not --set search.generations=0.
Error AsTyped(Error error, const std::vector<ExtraSet>& extra) {
  for (const ExtraSet& set : extra) {
    const std::string place = fmt::format("--set {}={}:", set.key, set.value);
    if (!error.message.starts_with(place)) continue;
    error.message.replace(0, place.size(), set.AsTyped() + ":");
    break;
  }
  return error;
}

Result<Experiment> LoadExperimentWith(const ExperimentOptions& options, const std::vector<ExtraSet>& extra) {
  TRY(const std::uint64_t seed, options.seed.empty() ? 0 : ParseSeed(options.seed));
  TRY(const std::vector<std::string> sets, JoinSets(options.sets, extra));
  TRY(const ExperimentText text, ReadExperimentText(options.experiment));
  TRY(const Catalogue catalogue, CatalogueFor(text, sets, options.plugins, options.allowed_files));
  Result<Experiment> experiment = ParseExperiment(text.text, text.file_name, sets, catalogue);
  if (!experiment) return AsTyped(experiment.error(), extra);
  if (!options.seed.empty()) experiment->seed = seed;
  return experiment;
}

std::string DefaultDirectory(const std::string& experiment_name, std::time_t now) {
  const std::string base = fmt::format("campaigns/{}-{:%Y%m%dT%H%M%SZ}", experiment_name, fmt::gmtime(now));
  std::string directory = base;
  std::error_code error;
  for (int i = 2; std::filesystem::exists(directory, error); ++i) directory = fmt::format("{}-{}", base, i);
  return directory;
}

Result<std::string> NewDirectory(const std::string& wanted, const Experiment& experiment) {
  if (wanted.empty()) return DefaultDirectory(experiment.name, std::time(nullptr));
  TRY(CampaignDirectory::CheckCreatable(wanted));
  return wanted;
}

}  // namespace gauntlet
