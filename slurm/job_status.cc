#include "slurm/job_status.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <regex>

#include "base/split.h"

namespace gauntlet::slurm {
namespace {

bool IsOneOf(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

// The text up to the separator, which is taken away with it.
std::string_view TakeUntil(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view first = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  return first;
}

// D-H:M:S, H:M:S, M:S or M; after days, minutes and seconds may be left out.
std::optional<long> SecondsOf(std::string_view text) {
  static const std::regex kForm(R"((?:(\d{1,9})-)?(\d{1,9})(?::(\d{1,9}))?(?::(\d{1,9}))?)");
  std::cmatch match;
  if (!std::regex_match(text.data(), text.data() + text.size(), match, kForm)) return std::nullopt;
  const auto field = [&](std::size_t i) { return match[i].matched ? std::stol(match.str(i)) : 0L; };
  constexpr long kMinute = 60;
  constexpr long kHour = 60 * kMinute;
  constexpr long kDay = 24 * kHour;
  if (match[1].matched || match[4].matched)
    return field(1) * kDay + field(2) * kHour + field(3) * kMinute + field(4);
  return field(2) * kMinute + field(3);
}

}  // namespace

JobPhase PhaseOf(std::string_view state) {
  if (IsOneOf(state, {"PENDING", "REQUEUED", "REQUEUE_FED", "REQUEUE_HOLD", "SPECIAL_EXIT"}))
    return JobPhase::kQueued;
  if (IsOneOf(state, {"RUNNING", "CONFIGURING", "SUSPENDED", "STOPPED", "SIGNALING", "RESIZING"}))
    return JobPhase::kRunning;
  if (IsOneOf(state, {"COMPLETING", "STAGE_OUT"})) return JobPhase::kEnding;
  if (IsOneOf(state, {"COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "PREEMPTED", "BOOT_FAIL",
                      "DEADLINE", "REVOKED", "OUT_OF_MEMORY"}))
    return JobPhase::kEnded;
  return JobPhase::kUnknown;
}

bool NeverStarts(std::string_view reason) {
  return IsOneOf(reason, {"PartitionNodeLimit", "PartitionTimeLimit", "PartitionConfig", "BadConstraints",
                          "DependencyNeverSatisfied", "JobHeldUser", "JobHeldAdmin", "InvalidAccount",
                          "InvalidQOS", "AccountNotAllowed", "QOSNotAllowed", "JobLaunchFailure",
                          "launch failed requeued held", "launch_failed_requeued_held"});
}

Result<std::vector<JobStatus>> ParseQueue(std::string_view text) {
  std::vector<JobStatus> jobs;
  while (!text.empty()) {
    const std::string_view line = Trimmed(TakeUntil(text, '\n'));
    if (line.empty()) continue;
    constexpr auto kSeparators = 4;
    if (std::count(line.begin(), line.end(), '|') < kSeparators) {
      return Error{ErrorKind::kIo, "squeue printed '" + std::string(line.substr(0, 200)) +
                                       "', which is not of the form " + std::string(kQueueFormat)};
    }
    std::string_view rest = line;
    JobStatus job;
    job.id = Trimmed(TakeUntil(rest, '|'));
    job.state = Trimmed(TakeUntil(rest, '|'));
    job.phase = PhaseOf(job.state);
    job.nodes = Trimmed(TakeUntil(rest, '|'));
    job.reason = Trimmed(TakeUntil(rest, '|'));
    if (job.reason == "None") job.reason.clear();
    job.name = Trimmed(rest);
    jobs.push_back(std::move(job));
  }
  return jobs;
}

Result<std::string> ParseJobId(std::string_view text) {
  const std::string_view id = Trimmed(text.substr(0, text.find(';')));
  if (!id.empty() && std::all_of(id.begin(), id.end(), [](char c) { return c >= '0' && c <= '9'; }))
    return std::string(id);
  return Error{ErrorKind::kIo,
               "sbatch answered '" + std::string(Trimmed(text.substr(0, 200))) + "' instead of a job id"};
}

Result<long> ParseTimeLimit(std::string_view text) {
  const std::optional<long> seconds = SecondsOf(Trimmed(text));
  if (seconds && *seconds > 0) return *seconds;
  return InvalidInput("time limit '" + std::string(text) +
                      "': give minutes (30), hours:minutes:seconds (02:00:00) or days-hours:minutes:seconds");
}

}  // namespace gauntlet::slurm
