#include "slurm/job_script.h"

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "base/shell_quoted.h"
#include "slurm/job_status.h"

namespace gauntlet::slurm {
namespace {

using Values = std::map<std::string, std::string>;

// Whether the lines behind the directives are those of kRunJob.
constexpr std::string_view kRun = "@RUN@";
bool IsRun(std::string_view job_template) {
  return job_template.find(kRun) != std::string_view::npos;
}

// What a template need not name: the margin, and what @RUN@ names or all of Slurm's templates name instead.
bool IsOptional(std::string_view name, bool run) {
  using Names = std::vector<std::string_view>;
  const Names others = run ? Names{"CPUS", "SLOTS", "LOG", "ACCESS", "WORKER", "MASTER", "TIME"}
                           : Names{"STEM", "LOGS", "COMMAND", "SECONDS"};
  return name == "MARGIN" || std::ranges::count(others, name) > 0;
}

// Replaces each @NAME@; "@" in other places (--signal=B:TERM@120) stands.
Result<std::string> Fill(std::string_view job_template, const Values& values) {
  const std::string text = Replaced(std::string(job_template), kRun, kRunJob);
  static const std::regex kName("@([A-Z_]+)@");
  std::string result;
  std::set<std::string> used;
  const char* rest = text.data();
  const char* end = text.data() + text.size();
  for (std::cregex_iterator match(rest, end, kName); match != std::cregex_iterator(); ++match) {
    const std::string name = match->str(1);
    const auto value = values.find(name);
    if (value == values.end())
      return InvalidInput("the job template names @" + name + "@, which is not known");
    result.append(rest, (*match)[0].first).append(value->second);
    used.insert(name);
    rest = (*match)[0].second;
  }
  for (const auto& [name, value] : values) {
    if (!used.contains(name) && !IsOptional(name, IsRun(job_template)))
      return InvalidInput("the job template lacks @" + name + "@");
  }
  return result.append(rest, end);
}

bool IsBroken(const std::string& text) {
  return text.find('\n') != std::string::npos;
}

// Between the double quotes in which a directive gives a value.
std::string InQuotes(std::string_view value) {
  std::string quoted;
  for (const char c : value) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted;
}

bool FillsNothingIn(const std::string& directory) {
  return directory.find('\\') != std::string::npos;
}

// A value of --output: the file `stem` + `pattern` + ".log" in the directory, in which "%%" stands for "%".
// With a backslash anywhere Slurm takes "%" for itself and two backslashes for one (sbatch(1), "filename
// pattern").
std::string LogFile(const std::string& directory, std::string_view stem, std::string_view pattern) {
  const bool literal = FillsNothingIn(directory);
  std::string path;
  for (const char c : directory) {
    if (c == (literal ? '\\' : '%')) path += c;
    path += c;
  }
  path.append("/").append(stem);
  return InQuotes(literal ? path + ".log" : path.append(pattern).append(".log"));
}

// Lines for what is asked for, in the order of the settings.
Result<std::string> Directives(std::vector<std::pair<std::string, std::string>> wanted,
                               const Cluster& cluster) {
  std::string lines;
  for (const auto& [name, value] : wanted) {
    if (value.empty()) continue;
    if (IsBroken(value))
      return InvalidInput("a " + cluster.name + " option cannot hold a line break: '" + value + "'");
    if (name == "extra" && !value.starts_with("-"))
      return InvalidInput("slurm.extra has '" + value + "': give options as on the command line of " +
                          ProgramOf(cluster.submit, cluster) + ", --exclusive");
    const auto line = cluster.directives.find(name);
    if (line == cluster.directives.end() || line->second.empty())
      return InvalidInput("slurm." + name + " = " + value + ": " + cluster.name +
                          " has no directive for it in its cluster file");
    lines += (lines.empty() ? "" : "\n") + Replaced(line->second, "@VALUE@", value);
  }
  return lines;
}

Status CheckOneLine(const Values& values) {
  for (const auto& [name, value] : values) {
    if (name != "SETUP" && name != "DIRECTIVES" && IsBroken(value))
      return InvalidInput("a job script cannot hold a line break, in a path neither: '" + value + "'");
  }
  return Ok{};
}

// Seconds before the time limit at which the job shall be told: two minutes, of a short limit a
// quarter.
long SignalMargin(long time_limit) {
  constexpr long kMargin = 120;
  constexpr long kShare = 4;
  return std::min(kMargin, time_limit / kShare);
}

// `job`: what the job itself wants of the cluster.
Result<std::string> Script(std::string_view job_template, Values values, const JobRequest& request,
                           std::vector<std::pair<std::string, std::string>> job, const Cluster& cluster) {
  std::vector<std::pair<std::string, std::string>> wanted = {{"partition", request.partition},
                                                             {"account", request.account},
                                                             {"qos", request.qos},
                                                             {"constraint", request.constraint},
                                                             {"memory", request.memory}};
  for (const std::string& option : request.extra) wanted.emplace_back("extra", option);
  wanted.insert(wanted.end(), job.begin(), job.end());
  TRY(const auto seconds, ParseTimeLimit(request.time_limit));
  values["TIME"] = request.time_limit;
  values["SECONDS"] = std::to_string(seconds);
  if (cluster.directives.contains("time_limit")) wanted.emplace_back("time_limit", values["SECONDS"]);
  TRY(values["DIRECTIVES"], Directives(wanted, cluster));
  values["SETUP"] = request.setup;
  values["MARGIN"] = std::to_string(SignalMargin(seconds));
  TRY(CheckOneLine(values));
  return Fill(job_template, values);
}

}  // namespace

std::string Replaced(std::string text, std::string_view name, std::string_view value) {
  if (const std::size_t at = text.find(name); at != std::string::npos) text.replace(at, name.size(), value);
  return text;
}

Result<std::string> WorkerScript(std::string_view job_template, const WorkerJob& job,
                                 const JobRequest& request, const Cluster& cluster) {
  const std::string slots = std::to_string(job.slots);
  const std::string access = ShellQuoted(job.access_file);
  JobRequest all = request;
  if (!IsRun(job_template) && FillsNothingIn(job.log_directory)) all.extra.emplace_back("--open-mode=append");
  const bool asks_for_cpus = IsRun(job_template) && job.slots > 1 && cluster.hosts.empty();
  // In the log's name %j is the job's id, %A_%a an array's and the task's; it is not for the shell.
  return Script(job_template,
                {{"JOB_NAME", job.name},
                 {"STEM", "worker"},
                 {"LOGS", ShellQuoted(job.log_directory)},
                 {"COMMAND", job.worker + " --access " + access + " --slots " + slots +
                                 " --allocation \"$job:0:$(uname -n)\""},
                 {"CPUS", slots},
                 {"SLOTS", slots},
                 {"LOG", LogFile(job.log_directory, "worker", job.array > 1 ? "-%A_%a" : "-%j")},
                 {"ACCESS", access},
                 {"WORKER", job.worker}},
                all,
                {{"workers_per_allocation", asks_for_cpus ? slots : ""},
                 {"array", job.array > 1 ? std::to_string(job.array) : ""}},
                cluster);
}

Result<std::string> MasterScript(std::string_view job_template, const MasterJob& job,
                                 const JobRequest& request, const Cluster& cluster) {
  std::string command;
  for (const std::string& argument : job.command)
    command += (command.empty() ? "" : " ") + ShellQuoted(argument);
  return Script(job_template,
                {{"JOB_NAME", job.name},
                 {"STEM", "master-job"},
                 {"LOGS", ShellQuoted(job.log_directory)},
                 {"COMMAND", command},
                 {"LOG", LogFile(job.log_directory, "master-job", "-%j")},
                 {"MASTER", command}},
                request, {}, cluster);
}

}  // namespace gauntlet::slurm
