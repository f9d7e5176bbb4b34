#include "master/session/search_loop.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gauntlet {
namespace {

constexpr std::chrono::milliseconds kPollTime{200};
constexpr std::chrono::seconds kRateWindow{5};
// While workers have this many runs each before them, a commit may wait for more results, because a commit
// for every result is most of what the master costs. With fewer, the search is soon to be told.
constexpr std::size_t kRunsAheadOfAWorker = 8;
constexpr std::chrono::milliseconds kCommitSoon{20};
// A search waits at the end of each generation for its slowest run; others fill the gap.
constexpr std::size_t kSearchesAtOnce = 64;
// Cases of a stream that may be open.
constexpr std::size_t kOpenForASlot = 16;
constexpr std::size_t kLeastOpen = 64;

}  // namespace

Status SearchLoop::Restore() {
  TRY(const std::vector<StoredSearch> stored, parts_.store.LoadSearches());
  for (SearchDriver* search : parts_.searches) {
    TRY(search->Restore());
    const bool has_ended =
        search->finished() && std::ranges::any_of(stored, [search](const StoredSearch& one) {
          return one.id == search->id() && one.finished_with == search->last_told();
        });
    if (!has_ended) waiting_.push_back(search);
  }
  return Ok{};
}

// Lets every search that runs go on, and others begin where some have finished.
Status SearchLoop::Advance() {
  while (running_.size() < kSearchesAtOnce && !waiting_.empty()) {
    running_.push_back(waiting_.front());
    waiting_.pop_front();
  }
  for (SearchDriver* search : running_) {
    TRY(search->Advance());
    if (search->finished() && search->totals().runs > 0)
      parts_.store.MarkFinished(search->id(), search->last_told());
  }
  const std::size_t before = running_.size();
  std::erase_if(running_, std::mem_fn(&SearchDriver::finished));
  return running_.size() < before && !waiting_.empty() ? Advance() : Ok{};
}

void SearchLoop::StoreEvents() {
  for (const DispatchEvent& event : parts_.backend.TakeEvents()) {
    spdlog::info("{}: {}", event.kind, event.text);
    parts_.store.AddEvent({UnixMilliseconds(), event.kind, event.text});
  }
}

Status SearchLoop::ApplyCommits() {
  TRY(std::vector<RunId> committed, parts_.store.Committed());
  if (committed.empty()) return Ok{};
  for (const RunId id : committed) DriverOf(id).Committed(id);
  parts_.backend.Acknowledge(committed);
  return Ok{};
}

std::uint64_t SearchLoop::runs_done() const {
  std::uint64_t runs = 0;
  for (const SearchDriver* search : parts_.searches) runs += search->totals().runs;
  return runs;
}

CampaignProgress SearchLoop::Progress() {
  CampaignProgress progress;
  progress.search.finished = true;
  progress.best_fitness = std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  int counted = 0;
  for (const SearchDriver* search : parts_.searches) {
    const SearchProgress one = search->Progress();
    Add(one, progress.search);
    progress.each.Add(one);
    progress.runs_planned += search->runs_planned();
    progress.total_failures += search->totals().total_failures;
    progress.runs_failed += search->totals().runs_failed;
    if (!std::isfinite(search->best_fitness())) continue;
    progress.best_fitness = std::fmin(progress.best_fitness, search->best_fitness());
    sum += search->mean_fitness();
    ++counted;
  }
  progress.mean_fitness = counted > 0 ? sum / counted : std::numeric_limits<double>::quiet_NaN();
  progress.runs_done = runs_done();
  progress.workers = parts_.backend.Statistics();

  const TimePoint now = parts_.clock.Now();
  rate_samples_.emplace_back(now, progress.runs_done);
  while (rate_samples_.size() > 2 && now - rate_samples_.front().first > kRateWindow)
    rate_samples_.pop_front();
  const auto& [oldest, runs_then] = rate_samples_.front();
  const double seconds = std::chrono::duration<double>(now - oldest).count();
  if (seconds > 0.0) progress.runs_per_second = static_cast<double>(progress.runs_done - runs_then) / seconds;
  if (progress.runs_per_second > 0.0 && progress.runs_planned >= progress.runs_done) {
    progress.remaining_seconds =
        static_cast<double>(progress.runs_planned - progress.runs_done) / progress.runs_per_second;
  }
  return progress;
}

void SearchLoop::StoreResults(std::vector<FinishedRun> finished) {
  bool waited_for = false;  // a search cannot go on before its last results are durable
  for (FinishedRun& run : finished) {
    SearchDriver& search = DriverOf(run.id);
    search.Store(std::move(run));
    waited_for |= search.at_backend() == 0;
  }
  std::size_t ahead = 0;
  for (const SearchDriver* search : running_) ahead += search->at_backend();
  const auto workers = static_cast<std::size_t>(parts_.backend.Statistics().connected);
  if (waited_for)
    parts_.store.CommitWithin(std::chrono::milliseconds(0));
  else if (parts_.feed != nullptr || ahead < kRunsAheadOfAWorker * workers)
    parts_.store.CommitWithin(kCommitSoon);
}

// What is durable is told once more, and what follows from it is stored.
Status SearchLoop::EndSession() {
  TRY(parts_.store.Flush());
  TRY(ApplyCommits());
  for (SearchDriver* search : running_) search->TellCompleted();
  if (parts_.feed != nullptr) (void)parts_.feed->Turn(0);  // the answers that are there
  return parts_.store.Flush();
}

Status SearchLoop::TurnFeed() {
  if (parts_.feed == nullptr) return Ok{};
  const auto slots = static_cast<std::size_t>(parts_.backend.Statistics().slots);
  Status turned = parts_.feed->Turn(std::max(kLeastOpen, kOpenForASlot * slots));
  parts_.backend.WatchInput(parts_.feed->fd());
  if (turned) return Advance();
  TRY(parts_.store.Flush());
  return turned;
}

Result<CampaignEnd> SearchLoop::Run(const std::function<StopWish()>& stop,
                                    const std::function<void(const CampaignProgress&)>& on_progress) {
  TimePoint last_report = parts_.clock.Now() - kPollTime;
  while (true) {
    TRY(ApplyCommits());
    TRY(Advance());
    if (const TimePoint now = parts_.clock.Now(); now - last_report >= kPollTime) {
      on_progress(Progress());
      last_report = now;
    }
    TRY(TurnFeed());
    const bool searched = running_.empty();
    const bool drained = parts_.feed == nullptr || parts_.feed->Drained();
    if (searched && drained && parts_.backend.Statistics().audits_open == 0) break;
    const StopWish wish = stop();
    if (wish == StopWish::kAfterRuns) parts_.backend.StopLeasing();
    if (wish == StopWish::kNow || (wish == StopWish::kAfterRuns && parts_.backend.Statistics().busy == 0)) {
      TRY(EndSession());
      return searched ? CampaignEnd::kFinished : CampaignEnd::kStopped;
    }
    const bool waits = parts_.feed != nullptr || searched;
    if (!waits && std::ranges::none_of(running_, &SearchDriver::pending)) continue;
    const auto patience = parts_.feed == nullptr ? kPollTime : std::min(kPollTime, parts_.feed->patience());
    Result<std::vector<FinishedRun>> finished = parts_.backend.Poll(patience);
    if (!finished) {
      TRY(parts_.store.Flush());
      return finished.error();
    }
    StoreResults(*std::move(finished));
    StoreEvents();
  }
  TRY(parts_.store.Flush());
  on_progress(Progress());
  return CampaignEnd::kFinished;
}

}  // namespace gauntlet
