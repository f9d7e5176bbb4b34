// gauntlet status: what a campaign does now; gauntlet watch: the same every second.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/tables/table.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/options/stop_signal.h"
#include "proto/json_text.h"
#include "proto/run_text.h"
#include "slurm/slurm_campaign.h"
#include "study/study_campaigns.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShownWorkers = 20;

struct StatusOptions {
  std::string directory;
  bool json = false;
};

std::string Seconds(double seconds) {
  return fmt::format("{:.1f} s", seconds);
}

std::string RunsOf(const Json& worker) {
  std::string text;
  std::vector<proto::RunId> waiting;  // behind those that run there
  for (const Json& run : worker["runs"]) {
    const auto id = run["run"].get<proto::RunId>();
    const auto attempt = run.value("attempt", std::uint64_t{1});
    if (run.value("state", "") == "waiting" && attempt == 1) {
      waiting.push_back(id);
      continue;
    }
    text += fmt::format("{}{} ({}{})", text.empty() ? "" : ", ", proto::RunText(id),
                        run.value("state", "") == "waiting" ? "next" : Seconds(run["seconds"]),
                        attempt > 1 ? fmt::format(", attempt {}", attempt) : "");
  }
  if (!waiting.empty()) text += fmt::format("{}next {}", text.empty() ? "" : ", ", proto::RunRanges(waiting));
  return text.empty() ? "-" : text;
}

// The jobs of a submitted campaign.
std::string JobsText(const Json& status) {
  const Json allocations = status.value("allocations", Json::array());
  if (allocations.empty()) return "";
  Table table({"job", "state", "reason", "node", ">workers"});
  for (const Json& allocation : allocations) {
    const std::string state = allocation["state"];
    const std::string name = allocation.value("role", "");
    table.AddRow({allocation["job"].get<std::string>() + (name.empty() ? "" : " " + name),
                  state + (allocation["cancelled"] == true ? ", cancelled" : ""),
                  allocation["reason"].get<std::string>(), allocation["nodes"].get<std::string>(),
                  fmt::format("{}", allocation["workers"].get<std::uint64_t>())});
  }
  return "\n" + table.ToText();
}

// The master's sentences name no path, for the directory may be elsewhere for whoever reads them.
std::string WithDirectory(std::string sentence, const std::string& directory) {
  constexpr std::string_view kPlaceholder = " DIR`";
  if (const std::size_t at = sentence.find(kPlaceholder); at != std::string::npos)
    sentence.replace(at, kPlaceholder.size(), " " + PastedPath(directory) + "`");
  return sentence;
}

// Why nothing runs, or less than could.
std::string WhyText(const Json& status, const std::string& directory) {
  if (const Json why = status.value("why_nothing_runs", Json()); why.is_string())
    return "nothing runs: " + WithDirectory(Printable(why.get<std::string>()), directory) + "\n";
  if (const Json trouble = status.value("pool_trouble", Json()); trouble.is_string())
    return "fewer workers than could be used: " + Printable(trouble.get<std::string>()) + "\n";
  return "";
}

std::string StatusText(const Json& status, const std::string& directory) {
  const auto count = [&status](const char* key) { return status.value(key, std::uint64_t{0}); };
  std::string text = fmt::format("{}: {}", directory, Printable(status.value("state", "unknown")));
  if (const Json& master = status.value("master", Json()); master.is_object()) {
    text += fmt::format(", master {} on {} (start number {}), {}", master["pid"].get<std::int64_t>(),
                        Printable(master["host"].get<std::string>()), master["epoch"].get<std::uint64_t>(),
                        master["encrypted"] == true ? "encrypted" : "plaintext");
  }
  text += "\n";
  if (status.contains("runs_done")) {
    const std::string searches = Printable(status.value("searches_in_words", ""));
    text += fmt::format("{}{}{} runs done, {} running, {} waiting, {:.1f}/s\n", searches,
                        searches.empty() ? "" : ", ", FormatCount(count("runs_done")), count("runs_running"),
                        count("runs_queued") + count("runs_ahead"), status.value("runs_per_second", 0.0));
  }
  if (count("nondeterministic") > 0) {
    text += fmt::format("NONDETERMINISTIC: {} runs ended differently on two workers, see log/master.log\n",
                        count("nondeterministic"));
  }
  if (const std::uint64_t lone = count("verdicts_of_one_worker"); lone > 0) {
    text += fmt::format(
        "{} runs were given up on the word of one worker each: there was no other to ask, see "
        "log/master.log\n",
        FormatCount(lone));
  }
  text += WhyText(status, directory);
  if (const double age = status.value("status_age_seconds", 0.0); age > 5.0)
    text += fmt::format("the master has said nothing for {:.0f} s: frozen, or its disk is slow\n", age);
  text += JobsText(status);
  const Json& workers = status["worker_list"];
  if (workers.empty()) return text;
  for (const Json& worker : workers) {
    if (const Json& reason = worker.value("quarantined", Json()); reason.is_string())
      text += fmt::format("worker {} is quarantined: {}\n", Printable(worker["worker"].get<std::string>()),
                          Printable(reason.get<std::string>()));
  }
  Table table({"worker", "state", ">heard", "runs"});
  for (std::size_t i = 0; i < std::min(kShownWorkers, workers.size()); ++i) {
    const Json& worker = workers[i];
    table.AddRow({worker["worker"].get<std::string>(), worker["state"].get<std::string>(),
                  Seconds(worker["silent_seconds"]), RunsOf(worker)});
  }
  text += "\n" + table.ToText();
  std::map<std::string, std::uint64_t> others;
  for (std::size_t i = kShownWorkers; i < workers.size(); ++i)
    ++others[workers[i]["state"].get<std::string>()];
  const Json not_listed = status.value("workers_not_listed", Json::object());
  for (const auto& [state, unlisted] : not_listed.items()) {
    if (unlisted != 0) others[state] += unlisted.get<std::uint64_t>();
  }
  std::vector<std::string> counts;
  for (const auto& [state, workers_in_it] : others)
    counts.push_back(fmt::format("{} {}", FormatCount(workers_in_it), state));
  if (!counts.empty()) text += fmt::format("and {} more workers\n", fmt::join(counts, ", "));
  return text;
}

// What the cluster has of a campaign or study that no master serves. Nothing when it was not submitted.
void AddJobs(CommandContext& context, const std::string& directory, Json& status) {
  const Result<std::optional<slurm::SlurmCampaign>> submitted = slurm::SlurmCampaign::Find(directory);
  if (!submitted) {
    // Somebody else's campaign may be looked at; whether the cluster has jobs of it is theirs to ask.
    status["pool_trouble"] = "The cluster was not asked: " + submitted.error().message;
    return;
  }
  if (!submitted->has_value()) return;
  const slurm::SlurmCampaign& campaign = **submitted;
  const Result<std::vector<slurm::JobStatus>> jobs = campaign.LivingJobs(*ClientOf(context, campaign));
  if (!jobs) {
    status["pool_trouble"] = jobs.error().message + slurm::NextStep(jobs.error().message, campaign.cluster());
    return;
  }
  status["allocations"] = Json::array();
  for (const slurm::JobStatus& job : *jobs) {
    const bool master = job.name == campaign.master_job_name();
    status["allocations"].push_back({{"job", job.id},
                                     {"role", master ? "master" : "workers"},
                                     {"state", job.state},
                                     {"reason", job.reason},
                                     {"nodes", job.nodes},
                                     {"workers", 0},
                                     {"cancelled", false}});
    if (!master || status.value("state", "") == "finished") continue;
    status["why_nothing_runs"] = fmt::format("job {}, which is to be the master, is {}{}", job.id, job.state,
                                             job.reason.empty() ? "" : " (" + job.reason + ")");
  }
}

bool IsServed(const Json& status) {
  const std::string state = status.value("state", "");
  return state != "stopped" && state != "finished";
}

// What a campaign does now, and the jobs of a submitted one that no master serves.
Result<Json> StatusOf(CommandContext& context, const std::string& directory) {
  TRY(const std::string text, context.campaigns.ReadStatus(directory));
  Json status = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!status.is_object()) return Error{ErrorKind::kCorrupt, "the status does not parse"};
  if (!IsServed(status)) AddJobs(context, directory, status);
  return status;
}

struct CurrentStatus {
  std::string text;  // for a person
  Json json;
  bool served = false;  // some master lives
};

Result<CurrentStatus> Look(CommandContext& context, const std::string& directory) {
  if (!IsStudy(directory)) {
    TRY(Json status, StatusOf(context, directory));
    return CurrentStatus{StatusText(status, directory), status, IsServed(status)};
  }
  CurrentStatus study{"", {{"campaigns", Json::array()}}};
  for (const std::string& campaign : CampaignsIn(directory)) {
    TRY(Json status, StatusOf(context, campaign));
    study.text += (study.text.empty() ? "" : "\n") + StatusText(status, campaign);
    study.served = study.served || IsServed(status);
    study.json["campaigns"].push_back({{"directory", campaign}, {"status", std::move(status)}});
  }
  if (study.text.empty()) study.text = directory + ": a study, of which no search has begun\n";
  // The jobs of a submitted study are its own, not its campaigns'.
  if (!study.served) AddJobs(context, directory, study.json);
  study.text += WhyText(study.json, directory) + JobsText(study.json);
  return study;
}

Result<ExitCode> RunStatus(CommandContext& context, const StatusOptions& options) {
  TRY(const CurrentStatus status, Look(context, options.directory));
  context.out << (options.json ? JsonText(status.json) : status.text) << std::flush;
  return kExitDone;
}

Result<ExitCode> RunWatch(CommandContext& context, const StatusOptions& options) {
  constexpr int kMilliseconds = 1000;
  const StopSignal handlers(/*announced=*/false);  // ends this command, not the campaign
  while (true) {
    TRY(const CurrentStatus status, Look(context, options.directory));
    // The screen is cleared on a terminal; elsewhere the states follow each other.
    context.out << (context.out_is_terminal ? "\x1b[H\x1b[2J" : "") << status.text << std::flush;
    if (!status.served || StopSignal::ComesWithin(kMilliseconds)) return kExitDone;
  }
}

}  // namespace

void AddStatus(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("status", "print what runs where and since when, or why nothing runs", RunStatus);
  AddDirectory(command, options.directory);
  command.add_flag("--json", options.json, "print everything as one JSON document");
  command.footer(
      R"(Reads the status that a living master writes every second, or, without a master, what is stored. For a
submitted campaign it also lists the jobs, with the cluster's state and reason. DIR may be that of a study: it then
tells of each of its campaigns.

Examples:
  gauntlet status DIR
  gauntlet status DIR --json | jq -r .why_nothing_runs)");
}

void AddWatch(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("watch", "print the status every second until the campaign's master ends", RunWatch);
  AddDirectory(command, options.directory);
  command.footer("Example:\n  gauntlet watch DIR");
}

}  // namespace gauntlet
