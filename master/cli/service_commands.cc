// gauntlet master, status, watch, stop: a campaign whose workers come from elsewhere.
#include <poll.h>

#include <chrono>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "master/cli/commands.h"
#include "master/cli/common_options.h"
#include "master/cli/run_campaign.h"
#include "master/cli/stop_signal.h"
#include "master/cli/table.h"

namespace gauntlet::master {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kWatchMilliseconds = 1000;
constexpr int kStopPollMilliseconds = 100;
constexpr std::size_t kShownWorkers = 20;

// Waits; false when Ctrl-C came.
bool Pause(int milliseconds) {
  poll(nullptr, 0, milliseconds);
  return !StopSignal::Requested();
}

std::string Seconds(double seconds) {
  return fmt::format("{:.1f} s", seconds);
}

std::string RunsOf(const Json& worker) {
  std::string text;
  for (const Json& run : worker["runs"]) {
    text += fmt::format("{}{} ({}{})", text.empty() ? "" : ", ", run["run"].get<std::uint64_t>(),
                        Seconds(run["seconds"]),
                        run["lease"] > 1 ? fmt::format(", lease {}", run["lease"].get<int>()) : "");
  }
  return text.empty() ? "-" : text;
}

std::string StatusText(const Json& status, const std::string& directory) {
  std::string text = fmt::format("{}: {}", directory, status.value("state", "unknown"));
  if (const Json& master = status.value("master", Json()); master.is_object()) {
    text += fmt::format(", master {} on {} (start number {}), {}", master["pid"].get<std::int64_t>(),
                        master["host"].get<std::string>(), master["epoch"].get<std::uint64_t>(),
                        master["encrypted"] == true ? "encrypted" : "plaintext");
  }
  text += "\n";
  if (status.contains("runs_done")) {
    text +=
        fmt::format("generation {}/{}, {} runs done, {} running, {} waiting, {:.1f}/s\n",
                    status.value("generation", 0), status.value("generations", 0),
                    FormatCount(status.value("runs_done", std::uint64_t{0})), status.value("runs_running", 0),
                    status.value("runs_queued", 0), status.value("runs_per_second", 0.0));
  }
  if (status.value("nondeterministic", 0) > 0) {
    text += fmt::format("NONDETERMINISTIC: {} runs ended differently on two workers, see log/master.log\n",
                        status["nondeterministic"].get<std::uint64_t>());
  }
  if (const Json& why = status.value("why_nothing_runs", Json()); why.is_string())
    text += "nothing runs: " + why.get<std::string>() + "\n";
  if (const double age = status.value("status_age_seconds", 0.0); age > 5.0)
    text += fmt::format("the master has said nothing for {:.0f} s: frozen, or its disk is slow\n", age);
  const Json& workers = status["worker_list"];
  if (workers.empty()) return text;
  Table table(
      {{"worker", Align::kLeft}, {"state", Align::kLeft}, {"heard", Align::kRight}, {"runs", Align::kLeft}});
  for (std::size_t i = 0; i < std::min(kShownWorkers, workers.size()); ++i) {
    const Json& worker = workers[i];
    table.AddRow({worker["worker"].get<std::string>(), worker["state"].get<std::string>(),
                  Seconds(worker["silent_seconds"]), RunsOf(worker)});
  }
  text += "\n" + table.ToText();
  if (workers.size() > kShownWorkers)
    text += fmt::format("and {} more workers (all with --json)\n", workers.size() - kShownWorkers);
  return text;
}

Result<std::string> Read(CommandContext& context, const StatusOptions& options) {
  Result<std::string> text = context.service.status(options.directory);
  if (!text || options.json) return text;
  const Json status = Json::parse(*text, nullptr, /*allow_exceptions=*/false);
  if (!status.is_object()) return Error{ErrorKind::kCorrupt, "the status does not parse"};
  return StatusText(status, options.directory);
}

}  // namespace

ExitCode RunMaster(CommandContext& context, const MasterOptions& options) {
  const CommonOptions& common = options.common;
  std::error_code ignored;
  const bool exists =
      !common.directory.empty() && std::filesystem::exists(common.directory + "/campaign.db", ignored);
  if (options.resume && common.directory.empty())
    return Fail(context, InvalidInput("--resume needs --dir: which campaign is to go on?"));
  const Result<Experiment> experiment = LoadExperimentWith(common, {});
  if (!experiment) return Fail(context, experiment.error());
  Result<std::string> directory = common.directory;
  if (!options.resume || !exists) directory = NewDirectory(common, *experiment);
  if (!directory) return Fail(context, directory.error());

  CampaignRun campaign;
  campaign.directory = *directory;
  campaign.workers = 0;
  campaign.bind = common.bind;
  campaign.insecure = common.insecure;
  campaign.run = [&](const SessionOptions& session) {
    return options.resume && exists ? context.service.resume(*directory, session)
                                    : context.service.start(*directory, *experiment, {}, session);
  };
  campaign.report = [&](const SessionReport& report) -> Status {
    PrintSummary(context, report.summary, *directory, common.json);
    return Ok{};
  };
  return RunCampaign(context, common, campaign);
}

ExitCode RunStatus(CommandContext& context, const StatusOptions& options) {
  const Result<std::string> text = Read(context, options);
  if (!text) return Fail(context, text.error());
  context.out << *text << std::flush;
  return kExitDone;
}

ExitCode RunWatch(CommandContext& context, const StatusOptions& options) {
  const StopSignal handlers;
  while (true) {
    const Result<bool> lives = context.service.lives(options.directory);
    if (!lives) return Fail(context, lives.error());
    const Result<std::string> text = Read(context, options);
    if (!text) return Fail(context, text.error());
    // The screen is cleared on a terminal; elsewhere the states follow each other.
    context.out << (context.out_is_terminal ? "\x1b[H\x1b[2J" : "") << *text << std::flush;
    if (!*lives || !Pause(kWatchMilliseconds)) return kExitDone;
  }
}

ExitCode RunStop(CommandContext& context, const StatusOptions& options) {
  Result<bool> lives = context.service.lives(options.directory);
  if (!lives) return Fail(context, lives.error());
  if (!*lives) {
    PrintMessage(context, fmt::format("no master serves {}: there is nothing to stop", options.directory));
    return kExitDone;
  }
  if (const Status asked = context.service.stop(options.directory); !asked)
    return Fail(context, asked.error());
  PrintMessage(context, "the master lets the runs that have begun end, then stops (Ctrl-C: wait no longer)");
  const StopSignal handlers;
  while (*lives) {
    if (!Pause(kStopPollMilliseconds)) return kExitDone;
    lives = context.service.lives(options.directory);
    if (!lives) return Fail(context, lives.error());
  }
  PrintMessage(context, "stopped");
  return kExitDone;
}

}  // namespace gauntlet::master
