#include "slurm/cluster.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>

#include "base/nearest_name.h"
#include "base/system/regular_file.h"
#include "search/experiment/key_assignment.h"
#include "slurm/shipped_texts.h"

namespace gauntlet::slurm {
namespace {

constexpr std::array<std::string_view, 4> kPhases = {"queued", "running", "ending", "ended"};

std::vector<SettingsKey<Cluster>> MakeClusterKeys() {
  using C = Cluster;
  std::vector<SettingsKey<Cluster>> keys = {
      FieldKey<C, &C::name>("name", "the scheduler's, for sentences"),
      FieldKey<C, &C::submit>("submit", "command that takes a job's script on stdin"),
      FieldKey<C, &C::test>("test", "likewise, submits nothing and fails when the job could never start"),
      FieldKey<C, &C::look>("look", "command that prints id|state|node|reason|name of each job and task"),
      FieldKey<C, &C::cancel>("cancel", "command that ends the jobs whose ids are its arguments"),
      FieldKey<C, &C::job_id>("job_id", "regular expression; its first group in submit's answer is the id"),
      FieldKey<C, &C::task_id>("task_id", "id of an array's task, made of @JOB@ and @TASK@"),
      FieldKey<C, &C::exclude>("exclude", "options of submit that keep a job off @NODES@"),
      FieldKey<C, &C::node_separator>("node_separator", "what stands between these nodes"),
      FieldKey<C, &C::script>("script", "of a job, with @JOB_NAME@, @DIRECTIVES@ and @RUN@"),
      FieldKey<C, &C::connect>("connect", "command that reaches a host and runs a command there"),
      NumberKey<C, &C::give_up_after>("give_up_after", "", 0, 1e6,
                                      "failed starts in a row, without a word from any worker, that end it")};
  for (const std::string name : {"partition", "account", "qos", "constraint", "memory", "extra", "time_limit",
                                 "workers_per_allocation", "array"}) {
    SettingsKey<Cluster> key = FieldKey<C, &C::name>("directives." + name, "line of the script for it");
    key.get = [name](const Cluster& cluster) -> KeyValue {
      const auto line = cluster.directives.find(name);
      return line == cluster.directives.end() ? "" : line->second;
    };
    key.set = [name](Cluster& cluster, const KeyValue& value) {
      cluster.directives[name] = std::get<std::string>(value);
    };
    keys.push_back(key);
  }
  return keys;
}

// What holds one value.
const std::vector<SettingsKey<Cluster>>& ClusterKeys() {
  static const std::vector<SettingsKey<Cluster>> keys = MakeClusterKeys();
  return keys;
}

std::vector<std::string> AllKeys() {
  std::vector<std::string> names = {"like", "hosts", "never_starts"};
  names.insert(names.end(), kPhases.begin(), kPhases.end());
  for (const SettingsKey<Cluster>& key : ClusterKeys()) names.push_back(key.path);
  return names;
}

bool Has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

Status AddHost(const std::string& text, Cluster& cluster) {
  static const std::regex kForm(R"(([A-Za-z0-9_][A-Za-z0-9_.@-]*)(?::([1-9][0-9]{0,3}))?)");
  std::smatch match;
  if (!std::regex_match(text, match, kForm))
    return InvalidInput(fmt::format("hosts has '{}': give NAME or NAME:SLOTS, \"node7:16\"", text));
  cluster.hosts.push_back({match.str(1), match[2].matched ? std::stoi(match.str(2)) : 1});
  return Ok{};
}

// hosts, never_starts, or the states of a phase.
Status AssignList(std::string_view key, const std::vector<std::string>& texts, Cluster& cluster) {
  if (key == "never_starts") cluster.never_starts = texts;
  if (key == "hosts") cluster.hosts.clear();
  for (const std::string& text : texts) {
    if (key != "hosts") break;
    TRY(AddHost(text, cluster));
  }
  const auto* const phase = std::ranges::find(kPhases, key);
  if (phase == kPhases.end()) return Ok{};
  const auto meant = static_cast<JobPhase>(phase - kPhases.begin());
  std::erase_if(cluster.states, [&](const auto& state) { return state.second == meant; });
  for (const std::string& text : texts) cluster.states[text] = meant;
  return Ok{};
}

Status AssignNamed(const Assignment& assignment, Cluster& cluster) {
  const std::string_view path = assignment.path;
  if (path == "like") return Ok{};
  if (path != "hosts" && path != "never_starts" && std::ranges::count(kPhases, path) == 0) {
    const SettingsKey<Cluster>* key = FindByName(ClusterKeys(), path);
    if (key != nullptr) return Assign(*key, assignment, cluster);
    return InvalidInput(
        fmt::format("{}: {}", assignment.where, UnknownName("key of a cluster file", path, AllKeys())));
  }
  const auto* list = std::get_if<OtherToml>(&assignment.value);
  const Status assigned = list != nullptr && list->texts
                              ? AssignList(path, *list->texts, cluster)
                              : Status(InvalidInput(fmt::format("{} is {}, expected a list of texts", path,
                                                                KindOf(assignment.value))));
  if (assigned) return assigned;
  return InvalidInput(fmt::format("{}: {}", assignment.where, assigned.error().message));
}

// Later assignments on top of what the file is like, without a look at whether that makes a cluster.
Result<Cluster> Parse(std::string_view text, const std::string& file_name);

Result<Cluster> Shipped(std::string_view name) {
  if (const ShippedText* shipped = FindByName(kShippedClusters, name))
    return Parse(shipped->text, fmt::format("{}.toml", name));
  return InvalidInput(UnknownName("shipped cluster", name, kShippedClusters) +
                      " (a cluster file is given by its path: ./lab.toml)");
}

Result<Cluster> Parse(std::string_view text, const std::string& file_name) {
  TRY(const std::vector<Assignment> assignments, ReadToml(text, file_name));
  Cluster cluster;
  std::string base;
  for (const Assignment& assignment : assignments) {
    if (assignment.path == "like") base = TextOf(assignment.value);
    // Hosts need nothing else.
    if (assignment.path == "hosts" && base.empty()) base = "ssh";
  }
  if (!base.empty()) {
    TRY(cluster, Shipped(base));
  }
  for (const Assignment& assignment : assignments) {
    TRY(AssignNamed(assignment, cluster));
  }
  return cluster;
}

// "" when the expression has a group.
std::string WhyNoJobId(const std::string& expression) {
  try {
    return std::regex(expression).mark_count() > 0 ? "" : "has no group in brackets, which is the id";
  } catch (const std::regex_error& error) {
    return fmt::format("is no regular expression: {}", error.what());
  }
}

Status CheckPlaceholders(const Cluster& cluster) {
  const std::string arguments = "\"$@\"";
  const std::string script = cluster.script == kSlurmScripts ? "" : cluster.script;
  std::vector<std::array<std::string, 3>> needed = {{"script", script, "@JOB_NAME@"},
                                                    {"script", script, "@DIRECTIVES@"},
                                                    {"script", script, "@RUN@"},
                                                    {"task_id", cluster.task_id, "@JOB@"},
                                                    {"task_id", cluster.task_id, "@TASK@"},
                                                    {"exclude", cluster.exclude, "@NODES@"},
                                                    {"cancel", cluster.cancel, arguments},
                                                    {"connect", cluster.connect, arguments}};
  if (!cluster.exclude.empty()) needed.push_back({"submit", cluster.submit, arguments});
  for (const auto& [name, line] : cluster.directives)
    needed.push_back({"directives." + name, line, "@VALUE@"});
  for (const auto& [key, text, part] : needed) {
    if (!text.empty() && !Has(text, part)) return InvalidInput(fmt::format("{} lacks {}", key, part));
  }
  return Ok{};
}

Status Check(const Cluster& cluster) {
  const bool scheduler = cluster.connect.empty();
  if (!cluster.hosts.empty() && (scheduler || !cluster.submit.empty()))
    return InvalidInput("hosts have no scheduler: leave out hosts, or like and submit");
  if (!scheduler && cluster.hosts.empty())
    return InvalidInput("hosts is missing: hosts = [\"node7:16\", ...]");
  const std::vector<std::string_view> needed =
      scheduler ? std::vector<std::string_view>{"name", "submit", "look", "cancel", "job_id", "script"}
                : std::vector<std::string_view>{"name", "script"};
  for (const std::string_view name : needed) {
    if (ToSet(FindByName(ClusterKeys(), name)->get(cluster)).empty())
      return InvalidInput(
          fmt::format("{} is missing, or a shipped cluster to begin with: like = \"sge\"", name));
  }
  if (const std::string why = scheduler ? WhyNoJobId(cluster.job_id) : ""; !why.empty())
    return InvalidInput(fmt::format("job_id = '{}' {}", cluster.job_id, why));
  const auto array = cluster.directives.find("array");
  const bool arrays = array != cluster.directives.end() && !array->second.empty();
  if (cluster.task_id.empty() == arrays)
    return InvalidInput("give both task_id and directives.array, or neither");
  return CheckPlaceholders(cluster);
}

}  // namespace

Result<Cluster> ReadCluster(std::string_view text, const std::string& file_name) {
  TRY(Cluster cluster, Parse(text, file_name));
  if (const Status complete = Check(cluster); !complete)
    return InvalidInput(fmt::format("{}: {}", file_name, complete.error().message));
  return cluster;
}

const Cluster& SlurmCluster() {
  static const Cluster cluster = Shipped("slurm").value();
  return cluster;
}

bool IsClusterFile(std::string_view name) {
  return Has(name, "/") || name.ends_with(".toml");
}

Result<Cluster> FindCluster(const std::string& name) {
  if (!IsClusterFile(name)) {
    TRY(Cluster cluster, Shipped(name));
    if (const Status complete = Check(cluster); !complete)
      return InvalidInput(fmt::format("cluster = {}: {}", name, complete.error().message));
    return cluster;
  }
  const Result<std::string> text = ReadRegularFile(name);
  if (!text) return InvalidInput(fmt::format("cluster = {}: {}", name, text.error().message));
  return ReadCluster(*text, name);
}

}  // namespace gauntlet::slurm
