#include "slurm/slurm_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <optional>

#include "base/nearest_name.h"
#include "master/experiment/toml_text.h"

namespace gauntlet::master {
namespace {

using std::chrono::seconds;

struct SlurmKey {
  std::string_view name;
  std::string_view description;
  // What is wrong with the value, or nothing. One of the two is set.
  std::function<std::string&(SlurmSettings&)> text;
  std::function<std::int64_t(const SlurmSettings&)> get_number;
  std::function<void(SlurmSettings&, std::int64_t)> set_number;
  std::int64_t min = 0;
  std::int64_t max = 0;
  bool is_time_limit = false;
};

SlurmKey Text(std::string_view name, std::string_view description,
              std::function<std::string&(SlurmSettings&)> field) {
  SlurmKey key;
  key.name = name;
  key.description = description;
  key.text = std::move(field);
  return key;
}

SlurmKey TimeLimit(std::string_view name, std::string_view description,
                   std::function<std::string&(SlurmSettings&)> field) {
  SlurmKey key = Text(name, description, std::move(field));
  key.is_time_limit = true;
  return key;
}

SlurmKey Count(std::string_view name, std::string_view description, std::int64_t min, std::int64_t max,
               int slurm::PoolLimits::*field) {
  SlurmKey key;
  key.name = name;
  key.description = description;
  key.get_number = [field](const SlurmSettings& settings) { return settings.pool.*field; };
  key.set_number = [field](SlurmSettings& settings, std::int64_t value) {
    settings.pool.*field = static_cast<int>(value);
  };
  key.min = min;
  key.max = max;
  return key;
}

SlurmKey Seconds(std::string_view name, std::string_view description, std::int64_t min, std::int64_t max,
                 seconds slurm::PoolLimits::*field) {
  SlurmKey key;
  key.name = name;
  key.description = description;
  key.get_number = [field](const SlurmSettings& settings) { return (settings.pool.*field).count(); };
  key.set_number = [field](SlurmSettings& settings, std::int64_t value) {
    settings.pool.*field = seconds(value);
  };
  key.min = min;
  key.max = max;
  return key;
}

const std::vector<SlurmKey>& Keys() {
  using S = SlurmSettings;
  constexpr std::int64_t kDay = 86400;
  static const std::vector<SlurmKey> keys = {
      Text("partition", "partition of the worker jobs",
           [](S& s) -> std::string& { return s.worker_job.partition; }),
      Text("account", "account that is charged", [](S& s) -> std::string& { return s.worker_job.account; }),
      Text("qos", "quality of service", [](S& s) -> std::string& { return s.worker_job.qos; }),
      Text("constraint", "features a node must have",
           [](S& s) -> std::string& { return s.worker_job.constraint; }),
      Text("memory", "memory of one allocation, \"2G\"",
           [](S& s) -> std::string& { return s.worker_job.memory; }),
      TimeLimit("time_limit", "of one allocation, \"01:00:00\"",
                [](S& s) -> std::string& { return s.worker_job.time_limit; }),
      Text("setup", "shell lines before the worker, \"module load zeromq\"",
           [](S& s) -> std::string& { return s.worker_job.setup; }),
      Count("workers_per_allocation", "runs simulated at the same time in one allocation, a CPU each", 1,
            1024, &slurm::PoolLimits::workers_per_allocation),
      Count("max_allocations", "jobs waiting and running together", 1, 10000,
            &slurm::PoolLimits::max_allocations),
      Count("max_queued", "jobs waiting in the queue at one time", 1, 1000, &slurm::PoolLimits::max_queued),
      Seconds("idle_timeout", "an allocation with nothing to do is given back after this, s", 1, kDay,
              &slurm::PoolLimits::idle_timeout),
      Seconds("start_timeout", "from a job's start to its worker's hello, s", 5, kDay,
              &slurm::PoolLimits::start_timeout),
      Seconds("query_interval", "at most one squeue in this time, s", 1, 3600,
              &slurm::PoolLimits::query_interval),
      Text("worker_command",
           "what starts a worker on a node; default: the gauntlet-worker beside this program",
           [](S& s) -> std::string& { return s.worker_command; }),
      Text("worker_template", "path of an edited copy of slurm/worker.sbatch",
           [](S& s) -> std::string& { return s.worker_template; }),
      Text("master_template", "path of an edited copy of slurm/master.sbatch",
           [](S& s) -> std::string& { return s.master_template; }),
      TimeLimit("master_time_limit", "of the master's job",
                [](S& s) -> std::string& { return s.master_time_limit; }),
      Text("master_partition", "partition of the master's job; default: that of the workers",
           [](S& s) -> std::string& { return s.master_partition; }),
      Text("bind", "where the master listens to its workers; encrypted unless only this machine reaches it",
           [](S& s) -> std::string& { return s.bind; }),
      Text("tag", "part of the jobs' names, drawn when the campaign is submitted",
           [](S& s) -> std::string& { return s.tag; }),
  };
  return keys;
}

constexpr std::string_view kMaster = "master";
constexpr std::string_view kMasterDescription = "where the master runs: \"job\" of its own, or \"here\"";

constexpr std::string_view kExtra = "extra";
constexpr std::string_view kExtraDescription = "further sbatch options, \"--exclusive --mail-type=FAIL\"";

// "--exclusive --comment=a b" is two options: one begins at each dash that follows a blank.
std::vector<std::string> SplitOptions(std::string_view text) {
  std::vector<std::string> options;
  std::string option;
  const auto finish = [&] {
    const std::size_t end = option.find_last_not_of(" \t\n");
    if (end != std::string::npos) options.push_back(option.substr(0, end + 1));
    option.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool blank_before = i > 0 && (text[i - 1] == ' ' || text[i - 1] == '\n' || text[i - 1] == '\t');
    if (text[i] == '-' && blank_before) finish();
    if (option.empty() && (text[i] == ' ' || text[i] == '\n' || text[i] == '\t')) continue;
    option += text[i];
  }
  finish();
  return options;
}

std::string JoinOptions(const std::vector<std::string>& options) {
  return fmt::format("{}", fmt::join(options, " "));
}

Error UnknownKey(const Assignment& assignment, std::string_view name) {
  std::vector<std::string_view> known = {kExtra, kMaster};
  for (const SlurmKey& key : Keys()) known.push_back(key.name);
  const std::string nearest = NearestName(name, known);
  return InvalidInput(fmt::format("{}: unknown Slurm setting '{}'{}", assignment.where, name,
                                  nearest.empty() ? fmt::format("; known: {}", fmt::join(known, ", "))
                                                  : fmt::format("; did you mean '{}'?", nearest)));
}

std::optional<std::string> TextOf(const Assignment& assignment) {
  if (const auto* text = std::get_if<std::string>(&assignment.value)) return *text;
  if (!assignment.text.empty()) return assignment.text;
  if (const auto* number = std::get_if<std::int64_t>(&assignment.value)) return std::to_string(*number);
  return std::nullopt;
}

Status Assign(SlurmSettings& settings, const Assignment& assignment, std::string_view name) {
  if (name == kExtra) {
    const std::optional<std::string> text = TextOf(assignment);
    if (!text)
      return InvalidInput(fmt::format("{}: {} is text, {}", assignment.where, name, kExtraDescription));
    settings.worker_job.extra = SplitOptions(*text);
    return Ok{};
  }
  if (name == kMaster) {
    const std::optional<std::string> text = TextOf(assignment);
    if (text != "job" && text != "here")
      return InvalidInput(fmt::format("{}: master is \"job\" or \"here\"", assignment.where));
    settings.master = text == "job" ? MasterPlace::kJob : MasterPlace::kHere;
    return Ok{};
  }
  const auto key =
      std::find_if(Keys().begin(), Keys().end(), [&](const SlurmKey& k) { return k.name == name; });
  if (key == Keys().end()) return UnknownKey(assignment, name);
  if (key->text) {
    const std::optional<std::string> text = TextOf(assignment);
    if (!text)
      return InvalidInput(fmt::format("{}: {} is text: {}", assignment.where, name, key->description));
    if (key->is_time_limit) {
      const Result<long> limit = slurm::ParseTimeLimit(*text);
      if (!limit)
        return InvalidInput(fmt::format("{}: {}: {}", assignment.where, name, limit.error().message));
    }
    key->text(settings) = *text;
    return Ok{};
  }
  const auto* number = std::get_if<std::int64_t>(&assignment.value);
  if (number == nullptr || *number < key->min || *number > key->max) {
    return InvalidInput(
        fmt::format("{}: {} is a whole number, {} to {}", assignment.where, name, key->min, key->max));
  }
  key->set_number(settings, *number);
  return Ok{};
}

}  // namespace

Result<SlurmSettings> ReadSlurmSettings(const std::vector<SlurmSource>& files,
                                        const std::vector<std::string>& sets) {
  constexpr std::string_view kTable = "slurm.";
  SlurmSettings settings;
  for (const SlurmSource& file : files) {
    const Result<std::vector<Assignment>> assignments = ReadToml(file.text, file.name);
    if (!assignments) return assignments.error();
    for (const Assignment& assignment : *assignments) {
      std::string_view name = assignment.path;
      if (!file.whole_file) {
        if (!name.starts_with(kTable)) continue;
        name.remove_prefix(kTable.size());
      }
      if (const Status assigned = Assign(settings, assignment, name); !assigned) return assigned.error();
    }
  }
  for (const std::string& set : sets) {
    Result<Assignment> assignment = ReadSet(set);
    if (!assignment) return assignment.error();
    assignment->where = "--slurm " + set;
    if (const Status assigned = Assign(settings, *assignment, assignment->path); !assigned)
      return assigned.error();
  }
  return settings;
}

std::string WriteSlurmSettings(const SlurmSettings& settings) {
  std::string text = "# How this campaign uses Slurm; `gauntlet resume` reads it.\n";
  SlurmSettings copy = settings;
  for (const SlurmKey& key : Keys()) {
    const std::string value =
        key.text ? QuoteToml(key.text(copy)) : fmt::format("{}", key.get_number(settings));
    text += fmt::format("{} = {}  # {}\n", key.name, value, key.description);
  }
  text += fmt::format("{} = \"{}\"  # {}\n", kMaster, settings.master == MasterPlace::kJob ? "job" : "here",
                      kMasterDescription);
  text += fmt::format("{} = {}  # {}\n", kExtra, QuoteToml(JoinOptions(settings.worker_job.extra)),
                      kExtraDescription);
  return text;
}

std::string UserSlurmFile() {
  if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config == '/')
    return std::string(config) + "/gauntlet/slurm.toml";
  const char* home = std::getenv("HOME");
  return home == nullptr ? "" : std::string(home) + "/.config/gauntlet/slurm.toml";
}

std::vector<SlurmKeyInfo> SlurmKeys() {
  SlurmSettings defaults;
  std::vector<SlurmKeyInfo> infos;
  for (const SlurmKey& key : Keys()) {
    infos.push_back({std::string(key.name),
                     key.text ? key.text(defaults) : fmt::format("{}", key.get_number(defaults)),
                     std::string(key.description)});
  }
  infos.push_back({std::string(kMaster), "job", std::string(kMasterDescription)});
  infos.push_back({std::string(kExtra), "", std::string(kExtraDescription)});
  return infos;
}

}  // namespace gauntlet::master
