#include "slurm/slurm_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <optional>

#include "base/nearest_name.h"
#include "search/experiment/key_assignment.h"

namespace gauntlet::slurm {
namespace {

template <auto... Path>
SlurmKey Text(const std::string& name, const std::string& description) {
  return FieldKey<SlurmSettings, Path...>(name, description);
}

// A text of the worker jobs.
template <auto Member>
SlurmKey JobText(const std::string& name, const std::string& description) {
  return Text<&SlurmSettings::worker_job, Member>(name, description);
}

template <auto... Path>
SlurmKey TimeLimit(const std::string& name, const std::string& description) {
  SlurmKey key = Text<Path...>(name, description);
  key.check = [name](const KeyValue& value) -> std::optional<std::string> {
    const Result<long> limit = ParseTimeLimit(std::get<std::string>(value));
    return limit ? std::nullopt : std::optional(fmt::format("{}: {}", name, limit.error().message));
  };
  return key;
}

template <auto Member>
SlurmKey Limit(const std::string& name, double min, double max, const std::string& description) {
  return NumberKey<SlurmSettings, &SlurmSettings::pool, Member>(name, "", min, max, description);
}

// "--exclusive --comment=a b" is two options: one begins at each dash that follows a blank.
std::vector<std::string> SplitOptions(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\n";
  std::vector<std::string> options;
  for (std::size_t begin = text.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    std::size_t end = begin;
    do {
      end = text.find('-', end + 1);
    } while (end != std::string_view::npos && kBlanks.find(text[end - 1]) == std::string_view::npos);
    const std::string_view option = text.substr(begin, end - begin);
    options.emplace_back(option.substr(0, option.find_last_not_of(kBlanks) + 1));
    begin = end;
  }
  return options;
}

SlurmKey ExtraKey() {
  SlurmKey key;
  key.path = "extra";
  key.type = KeyType::kText;
  key.description = "further options of the scheduler, \"--exclusive --mail-type=FAIL\"";
  key.get = [](const SlurmSettings& settings) -> KeyValue {
    return fmt::format("{}", fmt::join(settings.worker_job.extra, " "));
  };
  key.set = [](SlurmSettings& settings, const KeyValue& value) {
    settings.worker_job.extra = SplitOptions(std::get<std::string>(value));
  };
  return key;
}

std::vector<SlurmKey> MakeKeys() {
  using S = SlurmSettings;
  constexpr double kDay = 86400;
  std::vector<SlurmKey> keys = {
      Text<&S::cluster>("cluster", "slurm, sge, pbs, or the path of a cluster file (docs/clusters.md)"),
      JobText<&JobRequest::partition>("partition", "partition of the worker jobs"),
      JobText<&JobRequest::account>("account", "account that is charged"),
      JobText<&JobRequest::qos>("qos", "quality of service"),
      JobText<&JobRequest::constraint>("constraint", "features a node must have"),
      JobText<&JobRequest::memory>("memory", "memory of one allocation, \"2G\""),
      TimeLimit<&S::worker_job, &JobRequest::time_limit>("time_limit", "of one allocation, \"01:00:00\""),
      JobText<&JobRequest::setup>("setup", "shell lines before the worker, \"module load zeromq\""),
      Limit<&PoolLimits::workers_per_allocation>(
          "workers_per_allocation", 1, 1024, "runs simulated at the same time in one allocation, a CPU each"),
      Limit<&PoolLimits::max_allocations>("max_allocations", 1, 10000, "jobs waiting and running together"),
      Limit<&PoolLimits::max_queued>("max_queued", 1, 1000, "jobs waiting in the queue at one time"),
      Limit<&PoolLimits::idle_timeout>("idle_timeout", 1, kDay,
                                       "an allocation with nothing to do is given back after this, s"),
      Limit<&PoolLimits::start_timeout>("start_timeout", 5, kDay,
                                        "from a job's start to its worker's hello, s"),
      Limit<&PoolLimits::query_interval>("query_interval", 1, 3600,
                                         "the queue is looked at once in this time at most, s"),
      Text<&S::worker_command>(
          "worker_command",
          "what starts a worker on a node; default: the gauntlet-worker beside this program"),
      Text<&S::worker_template>(
          "worker_template", "path of an edited copy of slurm/worker.sbatch, or of another cluster's script"),
      Text<&S::master_template>(
          "master_template", "path of an edited copy of slurm/master.sbatch, or of another cluster's script"),
      TimeLimit<&S::master_time_limit>("master_time_limit", "of the master's job"),
      Text<&S::master_partition>("master_partition",
                                 "partition of the master's job; default: that of the workers"),
      Text<&S::bind>("bind", "where the master listens to its workers; encrypted"),
      Text<&S::tag>("tag", "part of the jobs' names, drawn when the campaign is submitted"),
      ChoiceKey<S, &S::master>("master", {"job", "here"},
                               "where the master runs: \"job\" of its own, or \"here\""),
      ExtraKey(),
  };
  for (SlurmKey& key : keys) key.default_value = key.get(S());
  return keys;
}

Status AssignNamed(Assignment assignment, std::string_view name, SlurmSettings& settings) {
  const SlurmKey* key = FindByName(SlurmKeys(), name);
  if (key == nullptr) {
    return InvalidInput(
        fmt::format("{}: {}", assignment.where, UnknownName("Slurm setting", name, SlurmKeys())));
  }
  // memory = 2000 means the text.
  const auto* number = std::get_if<std::int64_t>(&assignment.value);
  if (number != nullptr && assignment.text.empty()) assignment.text = fmt::format("{}", *number);
  return Assign(*key, assignment, settings);
}

}  // namespace

const std::vector<SlurmKey>& SlurmKeys() {
  static const std::vector<SlurmKey> keys = MakeKeys();
  return keys;
}

Result<SlurmSettings> ReadSlurmSettings(const std::vector<SlurmSource>& files,
                                        const std::vector<std::string>& sets) {
  constexpr std::string_view kTable = "slurm.";
  SlurmSettings settings;
  for (const SlurmSource& file : files) {
    TRY(const auto assignments, ReadToml(file.text, file.name));
    for (const Assignment& assignment : assignments) {
      std::string_view name = assignment.path;
      if (!file.whole_file) {
        if (!name.starts_with(kTable)) continue;
        name.remove_prefix(kTable.size());
      }
      TRY(AssignNamed(assignment, name, settings));
    }
  }
  for (const std::string& set : sets) {
    TRY(const auto assignment, ReadSet(set, "--slurm"));
    TRY(AssignNamed(assignment, assignment.path, settings));
  }
  return settings;
}

std::string WriteSlurmSettings(const SlurmSettings& settings) {
  std::string text = "# How this campaign uses its cluster; `gauntlet resume` reads it.\n";
  for (const SlurmKey& key : SlurmKeys()) text += LineOf(key.path, key, key.get(settings));
  return text;
}

std::string UserSlurmFile() {
  if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config == '/')
    return std::string(config) + "/gauntlet/slurm.toml";
  const char* home = std::getenv("HOME");
  return home == nullptr ? "" : std::string(home) + "/.config/gauntlet/slurm.toml";
}

}  // namespace gauntlet::slurm
