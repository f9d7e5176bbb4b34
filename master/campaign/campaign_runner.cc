#include "master/campaign/campaign_runner.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "master/dispatch/run_codec.h"
#include "sim/base/hash.h"

namespace gauntlet::master {
namespace {

constexpr int kSequenceBits = 40;
constexpr std::chrono::milliseconds kPollTime{100};
constexpr std::chrono::seconds kRateWindow{5};

}  // namespace

sim::SeedPurpose PurposeOf(SearchKind kind) {
  return kind == SearchKind::kCases ? sim::SeedPurpose::kEvaluate : sim::SeedPurpose::kSearch;
}

std::uint64_t SpecHash(std::string_view spec) {
  Fnv1a64 hash;
  hash.AddBytes(spec);
  return hash.value();
}

RunId RunIdOf(SearchId search, std::uint64_t sequence) {
  GAUNTLET_CHECK(search >= 1 && sequence >= 1 && sequence < (1ULL << kSequenceBits),
                 "run number out of range");
  return (static_cast<RunId>(search - 1) << kSequenceBits) + sequence;
}

CampaignRunner::CampaignRunner(const Parts& parts)
    : parts_(parts),
      last_asked_(RunIdOf(parts.search_id, 1) - 1),
      last_told_(last_asked_),
      saved_until_(last_asked_),
      best_fitness_(std::numeric_limits<double>::quiet_NaN()),
      mean_fitness_(std::numeric_limits<double>::quiet_NaN()) {}

Status CampaignRunner::Restore() {
  Result<std::optional<SavedState>> saved = parts_.store.LoadNewestState(parts_.search_id);
  if (!saved) return saved.error();
  if (saved->has_value()) {
    const SavedState& state = **saved;
    CanonicalDecoder decoder(state.state);
    if (Status restored = parts_.search.Restore(decoder); !restored) return restored;
    Result<ResultsDigest> digest = ResultsDigest::Restore(state.results_digest);
    if (!digest) return digest.error();
    digest_ = *digest;
    last_asked_ = last_told_ = saved_until_ = state.last_run;
  }
  Status read = parts_.store.ForEachRun(parts_.search_id, 0, [this](const StoredRun& run) {
    Count(run);
    if (run.id > saved_until_) stored_ahead_.emplace(run.id, run);
  });
  return read;
}

Status CampaignRunner::AskSearch() {
  std::vector<RunRequest> submissions;
  for (EvaluationRequest& request : parts_.search.Ask()) {
    PendingEvaluation evaluation;
    for (std::uint32_t replicate = 0; replicate < request.replicates; ++replicate) {
      StoredRun run;
      run.id = ++last_asked_;
      run.search = parts_.search_id;
      run.individual = request.individual;
      run.evaluation = request.evaluation;
      run.replicate = replicate;
      run.generation = request.generation;
      run.seed = sim::DeriveSeed(parts_.experiment.seed, parts_.purpose, parts_.search_id, request.individual,
                                 request.evaluation, replicate);
      sim::RunSpec spec;
      spec.test_case = request.test_case;
      spec.scenario = parts_.experiment.scenario;
      spec.scenario_parameters = parts_.experiment.scenario_parameters;
      spec.controller = parts_.experiment.controller;
      spec.controller_parameters = parts_.experiment.controller_parameters;
      spec.seed = run.seed;
      run.spec = EncodeRunSpec(spec);
      run.spec_hash = SpecHash(run.spec);

      const auto stored = stored_ahead_.find(run.id);
      if (stored == stored_ahead_.end()) {
        submissions.push_back({run.id, run.spec});
        evaluation.runs.push_back({std::move(run), false});
      } else {
        if (stored->second.spec != run.spec) {
          return Error{
              ErrorKind::kCorrupt,
              fmt::format(
                  "run {} is stored with another spec than the search asks for: the campaign was made by "
                  "another version, or its files were changed",
                  run.id)};
        }
        evaluation.runs.push_back({std::move(stored->second), true});
        stored_ahead_.erase(stored);
      }
    }
    evaluation.request = std::move(request);
    pending_.push_back(std::move(evaluation));
  }
  at_backend_ += submissions.size();
  if (!submissions.empty()) parts_.backend.Submit(std::move(submissions));
  return Ok{};
}

CampaignRunner::PendingRun* CampaignRunner::Find(RunId id) {
  // Runs of pending evaluations are numbered without gaps, each evaluation holding `replicates` of them.
  for (PendingEvaluation& evaluation : pending_) {
    const RunId first = evaluation.runs.front().run.id;
    if (id < first + evaluation.runs.size()) return id < first ? nullptr : &evaluation.runs[id - first];
  }
  return nullptr;
}

void CampaignRunner::Count(const StoredRun& run) {
  ++runs_done_;
  if (run.total_failure) ++total_failures_;
  if (run.verdict != static_cast<int>(sim::Verdict::kCompleted)) ++runs_failed_;
}

void CampaignRunner::StoreEvents() {
  for (const DispatchEvent& event : parts_.backend.TakeEvents()) {
    spdlog::info("{}: {}", event.kind, event.text);
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    parts_.store.AddEvent(
        {std::chrono::duration_cast<std::chrono::milliseconds>(now).count(), event.kind, event.text});
  }
}

void CampaignRunner::Store(FinishedRun finished) {
  PendingRun* pending = Find(finished.id);
  GAUNTLET_CHECK(pending != nullptr && !pending->durable, fmt::format("run {} finished twice", finished.id));
  StoredRun& run = pending->run;
  --at_backend_;
  run.result = std::move(finished.encoded);
  run.hash = finished.result.hash;
  run.worker = std::move(finished.worker);
  run.attempt = finished.attempt;
  run.verdict = static_cast<int>(finished.result.verdict);
  run.fitness = finished.result.fitness;
  run.total_failure = finished.result.failure.total;
  run.failure_type = finished.result.failure.type;
  parts_.store.AddRun(run);
  run.spec.clear();
  run.result.clear();
}

Status CampaignRunner::ApplyCommits() {
  Result<std::vector<RunId>> committed = parts_.store.Committed();
  if (!committed) return committed.error();
  if (committed->empty()) return Ok{};
  for (const RunId id : *committed) {
    PendingRun* pending = Find(id);
    GAUNTLET_CHECK(pending != nullptr, fmt::format("run {} was committed but never asked for", id));
    pending->durable = true;
    Count(pending->run);
  }
  parts_.backend.Acknowledge(*committed);
  return Ok{};
}

void CampaignRunner::TellCompleted() {
  while (!pending_.empty()) {
    const PendingEvaluation& evaluation = pending_.front();
    // From the end, where what is missing usually stands: evaluations of thousands of runs are looked at
    // often.
    if (std::any_of(evaluation.runs.rbegin(), evaluation.runs.rend(),
                    [](const PendingRun& pending) { return !pending.durable; })) {
      return;
    }
    EvaluationOutcome outcome;
    outcome.individual = evaluation.request.individual;
    outcome.evaluation = evaluation.request.evaluation;
    double sum = 0.0;
    std::uint32_t completed = 0;
    for (const PendingRun& pending : evaluation.runs) {
      if (pending.run.verdict == static_cast<int>(sim::Verdict::kCompleted)) {
        sum += pending.run.fitness;
        ++completed;
      }
      if (pending.run.total_failure) ++outcome.total_failures;
    }
    outcome.runs_failed = static_cast<std::uint32_t>(evaluation.runs.size()) - completed;
    outcome.completed = completed > 0;
    if (outcome.completed) outcome.fitness = sum / completed;
    for (const PendingRun& pending : evaluation.runs) digest_.Add(pending.run);
    last_told_ = evaluation.runs.back().run.id;
    pending_.pop_front();
    parts_.search.Tell(outcome);
  }
  if (!parts_.search.AtBoundary() || last_told_ == saved_until_) return;

  const std::vector<Individual> newborns = parts_.search.TakeNewborns();
  parts_.store.AddIndividuals(parts_.search_id, newborns);
  SavedState state;
  state.search = parts_.search_id;
  state.generation = parts_.search.Progress().generation;
  state.last_run = last_told_;
  CanonicalEncoder encoder;
  parts_.search.Save(encoder);
  state.state = encoder.Take();
  state.results_digest = digest_.bytes();
  parts_.store.SaveState(state);
  saved_until_ = last_told_;

  double sum = 0.0;
  int counted = 0;
  best_fitness_ = std::numeric_limits<double>::infinity();
  for (const Individual& individual : parts_.search.Population()) {
    if (!std::isfinite(individual.fitness)) continue;
    best_fitness_ = std::min(best_fitness_, individual.fitness);
    sum += individual.fitness;
    ++counted;
  }
  mean_fitness_ = counted > 0 ? sum / counted : std::numeric_limits<double>::quiet_NaN();
  if (counted == 0) best_fitness_ = mean_fitness_;
}

CampaignProgress CampaignRunner::Progress(TimePoint started) {
  const TimePoint now = parts_.clock.Now();
  rate_samples_.emplace_back(now, runs_done_);
  while (rate_samples_.size() > 2 && now - rate_samples_.front().first > kRateWindow)
    rate_samples_.pop_front();

  CampaignProgress progress;
  progress.search = parts_.search.Progress();
  progress.runs_done = runs_done_;
  progress.runs_planned =
      progress.search.evaluations_planned * static_cast<std::uint64_t>(parts_.experiment.search.replicates);
  progress.best_fitness = best_fitness_;
  progress.mean_fitness = mean_fitness_;
  progress.total_failures = total_failures_;
  progress.runs_failed = runs_failed_;
  progress.workers = parts_.backend.Statistics();
  progress.elapsed_seconds = std::chrono::duration<double>(now - started).count();
  const auto& [oldest, runs_then] = rate_samples_.front();
  const double seconds = std::chrono::duration<double>(now - oldest).count();
  if (seconds > 0.0) progress.runs_per_second = static_cast<double>(runs_done_ - runs_then) / seconds;
  if (progress.runs_per_second > 0.0 && progress.runs_planned >= runs_done_) {
    progress.remaining_seconds =
        static_cast<double>(progress.runs_planned - runs_done_) / progress.runs_per_second;
  }
  return progress;
}

Result<CampaignEnd> CampaignRunner::Run(const std::function<StopWish()>& stop,
                                        const std::function<void(const CampaignProgress&)>& on_progress) {
  const TimePoint started = parts_.clock.Now();
  TimePoint last_report = started - kPollTime;
  while (true) {
    if (Status applied = ApplyCommits(); !applied) return applied.error();
    TellCompleted();
    if (Status asked = AskSearch(); !asked) return asked.error();
    TellCompleted();  // what a former session had stored may complete evaluations at once
    if (const TimePoint now = parts_.clock.Now(); now - last_report >= kPollTime) {
      on_progress(Progress(started));
      last_report = now;
    }
    if (pending_.empty() && parts_.search.Progress().finished) break;
    const StopWish wish = stop();
    if (wish == StopWish::kAfterRuns) parts_.backend.StopLeasing();
    if (wish == StopWish::kNow || (wish == StopWish::kAfterRuns && parts_.backend.Statistics().busy == 0)) {
      if (Status flushed = parts_.store.Flush(); !flushed) return flushed.error();
      if (Status applied = ApplyCommits(); !applied) return applied.error();
      TellCompleted();
      if (Status flushed = parts_.store.Flush(); !flushed) return flushed.error();
      return CampaignEnd::kStopped;
    }
    if (pending_.empty()) continue;
    Result<std::vector<FinishedRun>> finished = parts_.backend.Poll(kPollTime);
    if (!finished) {
      if (Status flushed = parts_.store.Flush(); !flushed) return flushed.error();
      return finished.error();
    }
    for (FinishedRun& run : *finished) Store(std::move(run));
    // The search cannot go on before these are durable.
    if (!finished->empty() && at_backend_ == 0) parts_.store.Hurry();
    StoreEvents();
  }
  parts_.store.MarkFinished(parts_.search_id);
  if (Status flushed = parts_.store.Flush(); !flushed) return flushed.error();
  on_progress(Progress(started));
  return CampaignEnd::kFinished;
}

}  // namespace gauntlet::master
