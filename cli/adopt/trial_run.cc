#include "cli/adopt/trial_run.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "base/parse_number.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "base/split.h"
#include "base/system/process_call.h"
#include "controllers/command/outcome.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
namespace command = controllers::command;

constexpr std::chrono::minutes kLongestTrial{10};
// The recorder prints it when the experiment begins.
constexpr std::string_view kBegins = "gauntlet: the experiment begins\n";
constexpr std::size_t kToldLines = 12;

std::string ReadAll(const std::string& path) {
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void PrintLastLines(const std::string& text, std::ostream& said) {
  std::vector<std::string> lines = Split(text, '\n');
  std::erase(lines, "");
  for (std::size_t i = lines.size() - std::min(lines.size(), kToldLines); i < lines.size(); ++i)
    said << Printable(lines[i]) << "\n";
  said << std::flush;
}

double Number(const std::string& text) {
  return ParseNumber<double>(text).value_or(0.0);
}

void ReadWorld(TrialRun& run) {
  for (const std::string& line : Split(ReadAll(run.folder + "/" + kWorldFile), '\n')) {
    const std::vector<std::string> fields = Split(line, '\t');
    if (fields[0] == "library" && fields.size() == 3) {
      run.libraries.push_back({fields[1], (fs::path(run.folder) / fields[2]).lexically_normal()});
    } else if (fields.size() == 10) {
      run.bodies.push_back({fields[1], fields[2], fields[0] == "robot", fields[3] == "1", Number(fields[4]),
                            Number(fields[5]), Number(fields[6]), Number(fields[7]), Number(fields[8]),
                            Number(fields[9])});
    }
  }
}

void ReadPoses(TrialRun& run) {
  run.trajectory = ReadAll(run.folder + "/" + kTrajectoryFile);
  for (const std::string& line : Split(run.trajectory, '\n')) {
    const std::vector<std::string> fields = Split(line, ',');
    if (fields.size() == 6 && ParseNumber<double>(fields[3]))
      run.poses.push_back(
          {Number(fields[3]), Number(fields[4]), Number(fields[5]), Number(fields[0]), fields[1]});
  }
}

// What ARGoS prints before tells of the machine, not of the swarm.
void KeepWhatFollowsTheBeginning(TrialRun& run) {
  const std::size_t begins = run.out.find(kBegins);
  if (begins != std::string::npos) run.out.erase(0, begins + kBegins.size());
}

}  // namespace

Result<TrialRun> RunTrial(const std::string& folder, const std::string& command, std::ostream& said) {
  TrialRun run;
  run.folder = folder;
  const std::string script = fmt::format("cd {} && exec {} >{} 2>{}", ShellQuoted(folder), command,
                                         command::kStdoutFile, command::kStderrFile);
  const auto begin = std::chrono::steady_clock::now();
  Result<CallOutput> done = CallProcess({"/bin/sh", "-c", script}, "", {.deadline = kLongestTrial});
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  run.out = ReadAll(folder + "/" + command::kStdoutFile);
  run.err = ReadAll(folder + "/" + command::kStderrFile);
  std::error_code failed;
  if (done && done->exit_code == 0 && fs::exists(folder + "/" + kTrajectoryFile, failed)) {
    KeepWhatFollowsTheBeginning(run);
    ReadWorld(run);
    ReadPoses(run);
    return run;
  }
  PrintLastLines(run.out + run.err, said);
  if (!done && done.error().kind == ErrorKind::kIo)
    return InvalidInput(fmt::format(
        "a run of the project did not end within {} minutes: is --length too long?", kLongestTrial.count()));
  if (!done) return done.error();
  constexpr int kBySignal = 128;  // as shells say it
  if (done->exit_code > kBySignal)
    return InvalidInput(fmt::format("argos3 was ended by signal {} ({})", done->exit_code - kBySignal,
                                    strsignal(done->exit_code - kBySignal)));
  return InvalidInput(done->exit_code == 0
                          ? "argos3 ended with exit code 0, but before the experiment did"
                          : fmt::format("argos3 ended with exit code {}: see above", done->exit_code));
}

}  // namespace gauntlet
