#include "slurm/slurm_settings.h"

#include <fmt/format.h>

#include <cstdlib>
#include <functional>
#include <type_traits>

#include "base/nearest_name.h"
#include "search/experiment/toml_text.h"

namespace gauntlet::slurm {
namespace {

struct SlurmKey {
  std::string_view name;
  std::string_view description;
  // Takes an assignment's value. Error: what is wrong, to be read after the key's name.
  std::function<Status(SlurmSettings&, const Assignment&)> set;
  std::function<std::string(const SlurmSettings&)> get;
  bool is_text = true;
};

// The part of the settings whose members keys fill.
template <typename Part, typename Settings>
auto& PartOf(Settings& settings) {
  if constexpr (std::is_same_v<Part, JobRequest>) {
    return settings.worker_job;
  } else if constexpr (std::is_same_v<Part, PoolLimits>) {
    return settings.pool;
  } else {
    return settings;
  }
}

Result<std::string> TextOf(const Assignment& assignment, std::string_view description) {
  if (const auto* text = std::get_if<std::string>(&assignment.value)) return *text;
  if (!assignment.text.empty()) return assignment.text;
  if (const auto* number = std::get_if<std::int64_t>(&assignment.value)) return std::to_string(*number);
  return InvalidInput(fmt::format(" is text: {}", description));
}

template <typename Part>
SlurmKey Text(std::string_view name, std::string_view description, std::string Part::*member,
              Status (*check)(const std::string&) = nullptr) {
  const auto set = [=](SlurmSettings& settings, const Assignment& assignment) -> Status {
    TRY(const auto text, TextOf(assignment, description));
    if (check != nullptr) {
      TRY(check(text));
    }
    PartOf<Part>(settings).*member = text;
    return Ok{};
  };
  return {name, description, set,
          [=](const SlurmSettings& settings) { return PartOf<Part>(settings).*member; }};
}

Status CheckTimeLimit(const std::string& text) {
  const Result<long> limit = ParseTimeLimit(text);
  if (!limit) return InvalidInput(": " + limit.error().message);
  return Ok{};
}

template <typename Value>
SlurmKey Number(std::string_view name, std::string_view description, std::int64_t min, std::int64_t max,
                Value PoolLimits::*member) {
  const auto set = [=](SlurmSettings& settings, const Assignment& assignment) -> Status {
    const auto* number = std::get_if<std::int64_t>(&assignment.value);
    if (number == nullptr || *number < min || *number > max)
      return InvalidInput(fmt::format(" is a whole number, {} to {}", min, max));
    settings.pool.*member = static_cast<Value>(*number);
    return Ok{};
  };
  const auto get = [=](const SlurmSettings& settings) {
    if constexpr (std::is_same_v<Value, int>) {
      return fmt::format("{}", settings.pool.*member);
    } else {
      return fmt::format("{}", (settings.pool.*member).count());
    }
  };
  return {name, description, set, get, /*is_text=*/false};
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

SlurmKey MasterKey() {
  const auto set = [](SlurmSettings& settings, const Assignment& assignment) -> Status {
    const Result<std::string> text = TextOf(assignment, "");
    if (!text || (*text != "job" && *text != "here")) return InvalidInput(" is \"job\" or \"here\"");
    settings.master = *text == "job" ? MasterPlace::kJob : MasterPlace::kHere;
    return Ok{};
  };
  return {"master", "where the master runs: \"job\" of its own, or \"here\"", set,
          [](const SlurmSettings& settings) {
            return std::string(settings.master == MasterPlace::kJob ? "job" : "here");
          }};
}

SlurmKey ExtraKey() {
  constexpr std::string_view kDescription = "further sbatch options, \"--exclusive --mail-type=FAIL\"";
  const auto set = [=](SlurmSettings& settings, const Assignment& assignment) -> Status {
    TRY(const auto text, TextOf(assignment, kDescription));
    settings.worker_job.extra = SplitOptions(text);
    return Ok{};
  };
  return {"extra", kDescription, set, [](const SlurmSettings& settings) {
            return fmt::format("{}", fmt::join(settings.worker_job.extra, " "));
          }};
}

const std::vector<SlurmKey>& Keys() {
  constexpr std::int64_t kDay = 86400;
  static const std::vector<SlurmKey> keys = {
      Text("partition", "partition of the worker jobs", &JobRequest::partition),
      Text("account", "account that is charged", &JobRequest::account),
      Text("qos", "quality of service", &JobRequest::qos),
      Text("constraint", "features a node must have", &JobRequest::constraint),
      Text("memory", "memory of one allocation, \"2G\"", &JobRequest::memory),
      Text("time_limit", "of one allocation, \"01:00:00\"", &JobRequest::time_limit, CheckTimeLimit),
      Text("setup", "shell lines before the worker, \"module load zeromq\"", &JobRequest::setup),
      Number("workers_per_allocation", "runs simulated at the same time in one allocation, a CPU each", 1,
             1024, &PoolLimits::workers_per_allocation),
      Number("max_allocations", "jobs waiting and running together", 1, 10000, &PoolLimits::max_allocations),
      Number("max_queued", "jobs waiting in the queue at one time", 1, 1000, &PoolLimits::max_queued),
      Number("idle_timeout", "an allocation with nothing to do is given back after this, s", 1, kDay,
             &PoolLimits::idle_timeout),
      Number("start_timeout", "from a job's start to its worker's hello, s", 5, kDay,
             &PoolLimits::start_timeout),
      Number("query_interval", "at most one squeue in this time, s", 1, 3600, &PoolLimits::query_interval),
      Text("worker_command",
           "what starts a worker on a node; default: the gauntlet-worker beside this program",
           &SlurmSettings::worker_command),
      Text("worker_template", "path of an edited copy of slurm/worker.sbatch",
           &SlurmSettings::worker_template),
      Text("master_template", "path of an edited copy of slurm/master.sbatch",
           &SlurmSettings::master_template),
      Text("master_time_limit", "of the master's job", &SlurmSettings::master_time_limit, CheckTimeLimit),
      Text("master_partition", "partition of the master's job; default: that of the workers",
           &SlurmSettings::master_partition),
      Text("bind", "where the master listens to its workers; encrypted", &SlurmSettings::bind),
      Text("tag", "part of the jobs' names, drawn when the campaign is submitted", &SlurmSettings::tag),
      MasterKey(),
      ExtraKey(),
  };
  return keys;
}

Status Assign(SlurmSettings& settings, const Assignment& assignment, std::string_view name) {
  const SlurmKey* key = FindByName(Keys(), name);
  if (key == nullptr)
    return InvalidInput(fmt::format("{}: {}", assignment.where, UnknownName("Slurm setting", name, Keys())));
  const Status set = key->set(settings, assignment);
  if (set) return set;
  return InvalidInput(fmt::format("{}: {}{}", assignment.where, name, set.error().message));
}

}  // namespace

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
      TRY(Assign(settings, assignment, name));
    }
  }
  for (const std::string& set : sets) {
    TRY(auto assignment, ReadSet(set));
    assignment.where = "--slurm " + set;
    TRY(Assign(settings, assignment, assignment.path));
  }
  return settings;
}

std::string WriteSlurmSettings(const SlurmSettings& settings) {
  std::string text = "# How this campaign uses Slurm; `gauntlet resume` reads it.\n";
  for (const SlurmKey& key : Keys()) {
    const std::string value = key.get(settings);
    text += fmt::format("{} = {}  # {}\n", key.name, key.is_text ? QuoteToml(value) : value, key.description);
  }
  return text;
}

std::string UserSlurmFile() {
  if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config == '/')
    return std::string(config) + "/gauntlet/slurm.toml";
  const char* home = std::getenv("HOME");
  return home == nullptr ? "" : std::string(home) + "/.config/gauntlet/slurm.toml";
}

std::vector<SlurmKeyInfo> SlurmKeys() {
  std::vector<SlurmKeyInfo> infos;
  for (const SlurmKey& key : Keys())
    infos.push_back({std::string(key.name), key.get(SlurmSettings()), std::string(key.description)});
  return infos;
}

}  // namespace gauntlet::slurm
