#include "slurm/job_status.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

namespace gauntlet::slurm {
namespace {

template <std::size_t N>
bool IsOneOf(std::string_view word, const std::array<std::string_view, N>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

// The text up to the separator, which is taken away with it.
std::string_view TakeUntil(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view first = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  return first;
}

std::optional<long> Digits(std::string_view text) {
  constexpr std::size_t kMostDigits = 9;
  if (text.empty() || text.size() > kMostDigits) return std::nullopt;
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < 0) return std::nullopt;
  return value;
}

std::optional<long> SecondsOf(std::string_view text) {
  long days = 0;
  const bool with_days = text.find('-') != std::string_view::npos;
  if (with_days) {
    const std::optional<long> value = Digits(TakeUntil(text, '-'));
    if (!value) return std::nullopt;
    days = *value;
  }
  std::array<long, 3> fields{};
  std::size_t count = 0;
  bool more = true;
  while (more) {
    if (count == fields.size()) return std::nullopt;
    more = text.find(':') != std::string_view::npos;
    const std::optional<long> value = Digits(TakeUntil(text, ':'));
    if (!value) return std::nullopt;
    fields[count++] = *value;
  }
  constexpr long kMinute = 60;
  constexpr long kHour = 60 * kMinute;
  constexpr long kDay = 24 * kHour;
  if (with_days) return days * kDay + fields[0] * kHour + fields[1] * kMinute + fields[2];
  if (count == 1) return fields[0] * kMinute;
  if (count == 2) return fields[0] * kMinute + fields[1];
  return fields[0] * kHour + fields[1] * kMinute + fields[2];
}

}  // namespace

JobPhase PhaseOf(std::string_view state) {
  static constexpr std::array<std::string_view, 5> kQueued = {"PENDING", "REQUEUED", "REQUEUE_FED",
                                                              "REQUEUE_HOLD", "SPECIAL_EXIT"};
  static constexpr std::array<std::string_view, 6> kRunning = {"RUNNING", "CONFIGURING", "SUSPENDED",
                                                               "STOPPED", "SIGNALING",   "RESIZING"};
  static constexpr std::array<std::string_view, 2> kEnding = {"COMPLETING", "STAGE_OUT"};
  static constexpr std::array<std::string_view, 10> kEnded = {
      "COMPLETED", "FAILED",    "CANCELLED", "TIMEOUT", "NODE_FAIL",
      "PREEMPTED", "BOOT_FAIL", "DEADLINE",  "REVOKED", "OUT_OF_MEMORY"};
  if (IsOneOf(state, kQueued)) return JobPhase::kQueued;
  if (IsOneOf(state, kRunning)) return JobPhase::kRunning;
  if (IsOneOf(state, kEnding)) return JobPhase::kEnding;
  if (IsOneOf(state, kEnded)) return JobPhase::kEnded;
  return JobPhase::kUnknown;
}

bool NeverStarts(std::string_view reason) {
  static constexpr std::array<std::string_view, 14> kReasons = {"PartitionNodeLimit",
                                                                "PartitionTimeLimit",
                                                                "PartitionConfig",
                                                                "BadConstraints",
                                                                "DependencyNeverSatisfied",
                                                                "JobHeldUser",
                                                                "JobHeldAdmin",
                                                                "InvalidAccount",
                                                                "InvalidQOS",
                                                                "AccountNotAllowed",
                                                                "QOSNotAllowed",
                                                                "JobLaunchFailure",
                                                                "launch failed requeued held",
                                                                "launch_failed_requeued_held"};
  return IsOneOf(reason, kReasons);
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
