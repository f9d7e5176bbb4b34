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

// What a template need not name.
constexpr std::string_view kOptionalName = "MARGIN";

// Replaces each @NAME@; "@" in other places (--signal=B:TERM@120) stands.
Result<std::string> Fill(std::string_view text, const Values& values) {
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
    if (!used.contains(name) && name != kOptionalName)
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

Result<std::string> Directives(const JobRequest& request) {
  std::string lines;
  for (const auto& [option, value] : {std::pair{"partition", &request.partition},
                                      {"account", &request.account},
                                      {"qos", &request.qos},
                                      {"constraint", &request.constraint},
                                      {"mem", &request.memory}}) {
    if (IsBroken(*value)) return InvalidInput("a Slurm option cannot hold a line break: '" + *value + "'");
    if (!value->empty()) lines += std::string("#SBATCH --") + option + "=" + *value + "\n";
  }
  for (const std::string& option : request.extra) {
    if (IsBroken(option)) return InvalidInput("slurm.extra: an option cannot hold a line break");
    if (!option.starts_with("-"))
      return InvalidInput("slurm.extra has '" + option +
                          "': give sbatch options as on its command line, --exclusive");
    lines += "#SBATCH " + option + "\n";
  }
  if (!lines.empty()) lines.pop_back();
  return lines;
}

Status CheckOneLine(const Values& values) {
  for (const auto& [name, value] : values) {
    if (name != "SETUP" && name != "DIRECTIVES" && IsBroken(value))
      return InvalidInput("a job script cannot hold a line break, in a path neither: '" + value + "'");
  }
  return Ok{};
}

// Seconds before the time limit at which Slurm shall send its signal: two minutes, of a short limit a
// quarter.
long SignalMargin(const std::string& time_limit) {
  constexpr long kMargin = 120;
  constexpr long kShare = 4;
  const Result<long> seconds = ParseTimeLimit(time_limit);
  return seconds ? std::min(kMargin, *seconds / kShare) : kMargin;
}

Result<std::string> Script(std::string_view job_template, Values values, const JobRequest& request) {
  TRY(const auto directives, Directives(request));
  values["DIRECTIVES"] = directives;
  values["SETUP"] = request.setup;
  values["TIME"] = request.time_limit;
  values["MARGIN"] = std::to_string(SignalMargin(request.time_limit));
  TRY(CheckOneLine(values));
  return Fill(job_template, values);
}

}  // namespace

Result<std::string> WorkerScript(std::string_view job_template, const WorkerJob& job,
                                 const JobRequest& request) {
  // In the log's name %j is the job's id, %A_%a an array's and the task's; it is not for the shell.
  JobRequest all = request;
  if (job.array > 1) all.extra.push_back("--array=1-" + std::to_string(job.array));
  if (FillsNothingIn(job.log_directory)) all.extra.emplace_back("--open-mode=append");
  return Script(job_template,
                {{"JOB_NAME", job.name},
                 {"CPUS", std::to_string(job.slots)},
                 {"SLOTS", std::to_string(job.slots)},
                 {"LOG", LogFile(job.log_directory, "worker", job.array > 1 ? "-%A_%a" : "-%j")},
                 {"ACCESS", ShellQuoted(job.access_file)},
                 {"WORKER", job.worker}},
                all);
}

Result<std::string> MasterScript(std::string_view job_template, const MasterJob& job,
                                 const JobRequest& request) {
  std::string command;
  for (const std::string& argument : job.command)
    command += (command.empty() ? "" : " ") + ShellQuoted(argument);
  return Script(
      job_template,
      {{"JOB_NAME", job.name}, {"LOG", LogFile(job.log_directory, "master-job", "-%j")}, {"MASTER", command}},
      request);
}

}  // namespace gauntlet::slurm
