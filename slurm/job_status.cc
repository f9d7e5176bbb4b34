#include "slurm/job_status.h"

#include <algorithm>
#include <optional>
#include <regex>

#include "base/split.h"

namespace gauntlet::slurm {
namespace {

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

JobPhase PhaseOf(std::string_view state, const Cluster& cluster) {
  const auto row = cluster.states.find(std::string(state));
  return row == cluster.states.end() ? JobPhase::kUnknown : row->second;
}

bool NeverStarts(std::string_view word, const Cluster& cluster) {
  return std::ranges::find(cluster.never_starts, word) != cluster.never_starts.end();
}

std::string ProgramOf(const std::string& command, const Cluster& cluster) {
  const std::string& line = cluster.hosts.empty() ? command : cluster.connect;
  static const std::regex kWord("[A-Za-z0-9_./-]+");
  std::smatch match;
  return std::regex_search(line, match, kWord) ? match.str() : line;
}

Result<std::vector<JobStatus>> ParseQueue(std::string_view text, const Cluster& cluster) {
  std::vector<JobStatus> jobs;
  while (!text.empty()) {
    const std::string_view line = Trimmed(TakeUntil(text, '\n'));
    if (line.empty()) continue;
    if (std::ranges::count(line, '|') < std::ranges::count(kLookForm, '|'))
      return Error{ErrorKind::kIo, ProgramOf(cluster.look, cluster) + " printed '" +
                                       std::string(line.substr(0, 200)) + "', which is not of the form " +
                                       std::string(kLookForm)};
    std::string_view rest = line;
    JobStatus job;
    job.id = Trimmed(TakeUntil(rest, '|'));
    job.state = Trimmed(TakeUntil(rest, '|'));
    job.phase = PhaseOf(job.state, cluster);
    job.nodes = Trimmed(TakeUntil(rest, '|'));
    job.reason = Trimmed(TakeUntil(rest, '|'));
    if (job.reason == "None") job.reason.clear();
    job.name = Trimmed(rest);
    jobs.push_back(std::move(job));
  }
  return jobs;
}

Result<std::string> ParseJobId(std::string_view text, const Cluster& cluster) {
  std::cmatch match;
  if (std::regex_search(text.data(), text.data() + text.size(), match, std::regex(cluster.job_id)) &&
      match.length(1) > 0)
    return match.str(1);
  return Error{ErrorKind::kIo, ProgramOf(cluster.submit, cluster) + " answered '" +
                                   std::string(Trimmed(text.substr(0, 200))) + "' instead of a job id"};
}

Result<long> ParseTimeLimit(std::string_view text) {
  const std::optional<long> seconds = SecondsOf(Trimmed(text));
  if (seconds && *seconds > 0) return *seconds;
  return InvalidInput("time limit '" + std::string(text) +
                      "': give minutes (30), hours:minutes:seconds (02:00:00) or days-hours:minutes:seconds");
}

}  // namespace gauntlet::slurm
