#include "slurm/cluster.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>
#include <utility>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/system/regular_file.h"
#include "search/experiment/key_assignment.h"

namespace gauntlet::slurm {
namespace {

// The last four are phases, in the order of JobPhase.
constexpr std::array<std::string_view, 6> kLists = {"hosts",   "never_starts", "queued",
                                                    "running", "ending",       "ended"};
constexpr int kNotPhases = 2;
constexpr std::array<std::pair<std::string_view, std::string Cluster::*>, 11> kTexts = {
    {{"name", &Cluster::name},
     {"submit", &Cluster::submit},
     {"test", &Cluster::test},
     {"look", &Cluster::look},
     {"cancel", &Cluster::cancel},
     {"job_id", &Cluster::job_id},
     {"task_id", &Cluster::task_id},
     {"exclude", &Cluster::exclude},
     {"node_separator", &Cluster::node_separator},
     {"script", &Cluster::script},
     {"connect", &Cluster::connect}}};
constexpr std::string_view kArguments = "\"$@\"";
constexpr std::string_view kDirectives = "directives.";
constexpr std::string_view kAdvice = "advice.";
constexpr std::array<std::string_view, 9> kDirectiveNames = {
    "partition", "account", "qos", "constraint", "memory", "extra", "time_limit", "workers_per_allocation",
    "array"};

const SettingsKey<Cluster>& GiveUpAfter() {
  static const auto key =
      NumberKey<Cluster, &Cluster::give_up_after>("give_up_after", "", 0, 1e6, "failed starts");
  return key;
}

std::string UnknownKey(std::string_view path) {
  std::vector<std::string> known = {"like"};
  known.insert(known.end(), kLists.begin(), kLists.end());
  for (const auto& [name, member] : kTexts) known.emplace_back(name);
  known.push_back(GiveUpAfter().path);
  for (const std::string_view name : kDirectiveNames) known.push_back(std::string(kDirectives).append(name));
  return UnknownName("key of a cluster file", path, known);
}

// Where the text of a key stands; nullptr when the key has none.
std::string* TextAt(std::string_view path, Cluster& cluster) {
  for (const auto& [name, member] : kTexts) {
    if (name == path) return &(cluster.*member);
  }
  if (path.starts_with(kAdvice) && path != kAdvice)
    return &cluster.advice[std::string(path.substr(kAdvice.size()))];
  if (!path.starts_with(kDirectives)) return nullptr;
  path.remove_prefix(kDirectives.size());
  return std::ranges::count(kDirectiveNames, path) == 0 ? nullptr : &cluster.directives[std::string(path)];
}

bool Has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

Status SetHosts(const std::vector<std::string>& texts, const std::string& where, Cluster& cluster) {
  static const std::regex kForm(R"(([A-Za-z0-9_][A-Za-z0-9_.@-]*)(?::([1-9][0-9]{0,3}))?)");
  cluster.hosts.clear();
  for (const std::string& text : texts) {
    std::smatch match;
    if (!std::regex_match(text, match, kForm))
      return InvalidInput(
          fmt::format("{}: hosts has '{}': give NAME or NAME:SLOTS, \"node7:16\"", where, text));
    if (std::ranges::count(cluster.hosts, match.str(1), &ClusterHost::name) > 0)
      return InvalidInput(fmt::format("{}: hosts has {} twice", where, match.str(1)));
    cluster.hosts.push_back({match.str(1), match[2].matched ? std::stoi(match.str(2)) : 1});
  }
  return Ok{};
}

Status AssignNamed(const Assignment& assignment, Cluster& cluster) {
  const std::string& path = assignment.path;
  if (path == "like") return Ok{};
  if (path == GiveUpAfter().path) return Assign(GiveUpAfter(), assignment, cluster);
  if (std::string* text = TextAt(path, cluster)) {
    TRY(const KeyValue value, ValueFor({.path = path, .type = KeyType::kText}, assignment));
    *text = std::get<std::string>(value);
    return Ok{};
  }
  const auto* const list = std::ranges::find(kLists, path);
  if (list == kLists.end()) return InvalidInput(fmt::format("{}: {}", assignment.where, UnknownKey(path)));
  const auto* value = std::get_if<OtherToml>(&assignment.value);
  if (value == nullptr || !value->texts)
    return InvalidInput(fmt::format("{}: {} is {}, expected a list of texts", assignment.where, path,
                                    KindOf(assignment.value)));
  const std::vector<std::string>& texts = *value->texts;
  if (path == "hosts") return SetHosts(texts, assignment.where, cluster);
  if (path == "never_starts") {
    cluster.never_starts = texts;
    return Ok{};
  }
  const auto meant = static_cast<JobPhase>(list - kLists.begin() - kNotPhases);
  std::erase_if(cluster.states, [&](const auto& state) { return state.second == meant; });
  for (const std::string& state : texts) cluster.states[state] = meant;
  return Ok{};
}

// Later assignments on top of what the file is like, without a look at whether that makes a cluster.
Result<Cluster> Parse(std::string_view text, const std::string& file_name);

Result<Cluster> Shipped(std::string_view name) {
  if (const ShippedCluster* shipped = FindByName(kShippedClusters, name))
    return Parse(shipped->text, fmt::format("{}.toml", name));
  return InvalidInput(UnknownName("shipped cluster", name, kShippedClusters) +
                      " (a cluster file is given by its path: ./lab.toml)");
}

Result<Cluster> Parse(std::string_view text, const std::string& file_name) {
  TRY(const std::vector<Assignment> assignments, ReadToml(text, file_name));
  Cluster cluster;
  std::string base;
  bool has_hosts = false;
  for (const Assignment& assignment : assignments) {
    if (assignment.path == "like") base = TextOf(assignment.value);
    if (assignment.path == "hosts") has_hosts = true;
  }
  if (has_hosts && !base.empty() && base != "ssh")
    return InvalidInput(file_name + ": hosts have no scheduler: leave out hosts, or like");
  if (has_hosts) base = "ssh";
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
  std::vector<std::array<std::string_view, 3>> needed = {{"task_id", cluster.task_id, "@JOB@"},
                                                         {"task_id", cluster.task_id, "@TASK@"},
                                                         {"exclude", cluster.exclude, "@NODES@"},
                                                         {"cancel", cluster.cancel, kArguments},
                                                         {"connect", cluster.connect, kArguments}};
  for (const std::string_view name : {"@JOB_NAME@", "@DIRECTIVES@", "@RUN@"}) {
    if (cluster.script != kSlurmScripts) needed.push_back({"script", cluster.script, name});
  }
  if (!cluster.exclude.empty()) needed.push_back({"submit", cluster.submit, kArguments});
  for (const auto& [key, text, part] : needed) {
    if (!text.empty() && !Has(text, part)) return InvalidInput(fmt::format("{} lacks {}", key, part));
  }
  for (const auto& [name, line] : cluster.directives) {
    if (!line.empty() && !Has(line, "@VALUE@"))
      return InvalidInput(fmt::format("{}{} lacks @VALUE@", kDirectives, name));
  }
  return Ok{};
}

Status Check(Cluster cluster) {
  if (cluster.hosts.empty() && !cluster.connect.empty())
    return InvalidInput("hosts is missing: hosts = [\"node7:16\", ...]");
  for (const std::string_view name : {"name", "submit", "look", "cancel", "job_id", "script", "connect"}) {
    if (TextAt(name, cluster)->empty() && (name != "connect" || !cluster.hosts.empty()))
      return InvalidInput(
          fmt::format("{} is missing, or a shipped cluster to begin with: like = \"sge\"", name));
  }
  if (const std::string why = WhyNoJobId(cluster.job_id); !why.empty())
    return InvalidInput(fmt::format("job_id = '{}' {}", cluster.job_id, why));
  if (cluster.task_id.empty() != cluster.directives["array"].empty())
    return InvalidInput("give both task_id and directives.array, or neither");
  return CheckPlaceholders(cluster);
}

}  // namespace

Result<Cluster> ReadCluster(std::string_view text, const std::string& file_name) {
  Result<Cluster> cluster = Parse(text, file_name);
  if (!cluster) return Printable(cluster.error());
  if (const Status complete = Check(*cluster); !complete)
    return Printable(InvalidInput(fmt::format("{}: {}", file_name, complete.error().message)));
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
  if (!IsClusterFile(name)) return ReadCluster("like = " + QuoteToml(name), "cluster = " + name);
  const Result<std::string> text = ReadRegularFile(name);
  if (!text) return InvalidInput(fmt::format("cluster = {}: {}", name, text.error().message));
  return ReadCluster(*text, name);
}

}  // namespace gauntlet::slurm
