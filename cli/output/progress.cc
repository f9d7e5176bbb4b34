#include "cli/output/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/tables/table.h"
#include "base/duration_text.h"

namespace gauntlet {
namespace {

constexpr Duration kPlainInterval = std::chrono::seconds(5);
constexpr Duration kLeastPlainInterval = std::chrono::seconds(1);

std::string Rate(double runs_per_second) {
  if (!std::isfinite(runs_per_second)) return "-";
  return runs_per_second < 9.95 ? fmt::format("{:.1f}", runs_per_second)
                                : FormatCount(static_cast<std::uint64_t>(std::llround(runs_per_second)));
}

std::string Runs(const CampaignProgress& progress) {
  return progress.runs_planned > 0
             ? fmt::format("{}/{}", FormatCount(progress.runs_done), FormatCount(progress.runs_planned))
             : FormatCount(progress.runs_done);
}

std::string Bar(double share, std::size_t width) {
  const auto full = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(width));
  std::string bar(full, '=');
  if (full < width) bar += '>';
  bar.resize(width, ' ');
  return "[" + bar + "]";
}

}  // namespace

std::string LiveProgressLine(const CampaignProgress& progress, std::size_t columns) {
  const WorkerStatistics& workers = progress.workers;
  // In the order of the line, with a rank: the highest rank is left out first.
  struct Part {
    int rank;
    std::string text;
  };
  constexpr int kBarRank = 6;
  std::vector<Part> parts;
  if (progress.each.searches > 1) {
    parts.push_back({1, fmt::format("{}/{} searches", progress.each.finished, progress.each.searches)});
  } else if (progress.search.generations > 1) {
    parts.push_back({1, fmt::format("gen {}/{}", progress.search.generation, progress.search.generations)});
  }
  if (progress.runs_planned > 0) parts.push_back({kBarRank, ""});
  parts.push_back({0, Runs(progress) + " runs"});
  parts.push_back({4, Rate(progress.runs_per_second) + "/s"});
  parts.push_back({3, fmt::format("best {} mean {}", FormatFitness(progress.best_fitness),
                                  FormatFitness(progress.mean_fitness))});
  parts.push_back({5, fmt::format("{} total failures", FormatCount(progress.total_failures))});
  if (progress.runs_failed > 0)
    parts.push_back({2, fmt::format("{} RUNS FAILED", FormatCount(progress.runs_failed))});
  parts.push_back({7, fmt::format("workers {}/{} busy", workers.busy, workers.connected)});
  if (progress.remaining_seconds) parts.push_back({2, FormatDuration(*progress.remaining_seconds) + " left"});

  constexpr std::size_t kLeastBar = 8;
  constexpr std::size_t kMostBar = 24;
  constexpr std::string_view kBetween = "  ";
  const auto width = [&] {
    std::size_t sum = 0;
    for (const Part& part : parts) {
      const std::size_t own = part.rank == kBarRank ? kLeastBar + 2 : DisplayWidth(part.text);
      sum += own + (sum > 0 ? kBetween.size() : 0);
    }
    return sum;
  };
  while (parts.size() > 1 && width() > columns) parts.erase(std::ranges::max_element(parts, {}, &Part::rank));
  if (const auto bar = std::ranges::find(parts, kBarRank, &Part::rank); bar != parts.end()) {
    const double done = static_cast<double>(progress.runs_done) / static_cast<double>(progress.runs_planned);
    bar->text = Bar(done, std::min(kMostBar, kLeastBar + (columns - width())));
  }
  std::string line;
  for (const Part& part : parts) line += (line.empty() ? "" : std::string(kBetween)) + part.text;
  return line.substr(0, columns);
}

std::string PlainProgressLine(const CampaignProgress& progress) {
  std::string line;
  if (const std::string words = progress.each.InWords(); !words.empty()) line += words + ", ";
  line += fmt::format("runs {} ({}/s), best {}, mean {}, total failures {}", Runs(progress),
                      Rate(progress.runs_per_second), FormatFitness(progress.best_fitness),
                      FormatFitness(progress.mean_fitness), FormatCount(progress.total_failures));
  if (progress.runs_failed > 0) line += fmt::format(", RUNS FAILED {}", FormatCount(progress.runs_failed));
  line += fmt::format(", workers {} ({} busy)", progress.workers.connected, progress.workers.busy);
  if (progress.workers.lost > 0) line += fmt::format(", {} lost", progress.workers.lost);
  if (progress.remaining_seconds)
    line += fmt::format(", {} left", FormatDuration(*progress.remaining_seconds));
  return line;
}

ProgressPrinter::ProgressPrinter(ProgressMode mode, const Clock& clock,
                                 std::function<void(const std::string&)> write,
                                 std::function<std::size_t()> columns)
    : mode_(mode), clock_(clock), write_(std::move(write)), columns_(std::move(columns)) {}

void ProgressPrinter::Update(const CampaignProgress& progress) {
  if (mode_ == ProgressMode::kNone) return;
  latest_ = progress;
  const TimePoint now = clock_.Now();
  if (mode_ == ProgressMode::kLive) {
    // One column stays free: some terminals wrap when the last one is written.
    const std::string line = LiveProgressLine(progress, std::max<std::size_t>(columns_(), 21) - 1);
    if (line == last_line_) return;
    last_line_ = line;
    write_("\r" + line + "\x1b[K");
    return;
  }
  const bool first = !last_time_;
  const bool due = !first && now - *last_time_ >= kPlainInterval;
  const bool generation =
      !first && progress.search.generation != last_generation_ && now - *last_time_ >= kLeastPlainInterval;
  if (!first && !due && !generation) return;
  last_time_ = now;
  last_generation_ = progress.search.generation;
  last_line_ = PlainProgressLine(progress);
  write_(last_line_ + "\n");
}

void ProgressPrinter::Finish() {
  if (!latest_) return;
  if (mode_ == ProgressMode::kLive) {
    write_("\r\x1b[K");
  } else if (const std::string line = PlainProgressLine(*latest_); line != last_line_) {
    write_(line + "\n");
  }
  latest_.reset();
  mode_ = ProgressMode::kNone;
}

ProgressMode ChooseProgressMode(bool wanted, bool is_terminal, const char* term) {
  if (!wanted) return ProgressMode::kNone;
  const bool can_redraw = term != nullptr && std::string_view(term) != "dumb" && *term != '\0';
  return is_terminal && can_redraw ? ProgressMode::kLive : ProgressMode::kPlain;
}

std::size_t TerminalColumns() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

}  // namespace gauntlet
