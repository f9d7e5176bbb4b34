#include "master/session/search_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "master/campaign/observed_reproducibility.h"
#include "master/campaign/stored_search.h"
#include "proto/run_codec.h"
#include "proto/run_text.h"
#include "search/search_table.h"

namespace gauntlet {

SearchDriver::SearchDriver(const Parts& parts)
    : parts_(parts),
      has_generations_(parts.search.Progress().generations > 1),
      last_asked_(RunIdOf(parts.plan.id, 1) - 1),
      last_told_(last_asked_),
      saved_until_(last_asked_) {}

Status SearchDriver::Restore() {
  TRY(SavedProgress saved, RestoreSearch(id(), parts_.store, parts_.search));
  digest_ = saved.results;
  last_asked_ = last_told_ = saved_until_ = saved.last_run;
  TRY(const std::vector<SearchTotals> totals, parts_.store.LoadTotals());
  if (const auto mine = std::ranges::find(totals, id(), &SearchTotals::search); mine != totals.end())
    totals_ = *mine;
  return parts_.store.ForEachRun(id(), saved_until_, [this](const StoredRun& run) {
    stored_ahead_.emplace(run.id, run);
    return Ok{};
  });
}

double SearchDriver::PredictedLength(const EvaluationRequest& request) const {
  if (const auto own = ticks_.find(request.individual); own != ticks_.end()) return own->second;
  double longest = 0.0;
  for (const IndividualId parent : request.parents) {
    if (const auto found = ticks_.find(parent); found != ticks_.end())
      longest = std::max(longest, found->second);
  }
  return longest;
}

Status SearchDriver::Ask() {
  std::vector<RunRequest> submissions;
  for (EvaluationRequest& request : parts_.search.Ask()) {
    PendingEvaluation evaluation;
    const double length = PredictedLength(request);
    const proto::SeededSpecs specs(SpecOfRun(parts_.plan.experiment, request, 0));
    Fnv1a64 of_head;
    of_head.AddBytes(specs.head());
    evaluation.runs.reserve(request.replicates);
    for (std::uint32_t replicate = 0; replicate < request.replicates; ++replicate) {
      StoredRun run;
      run.id = ++last_asked_;
      run.search = id();
      run.individual = request.individual;
      run.evaluation = request.evaluation;
      run.replicate = replicate;
      run.generation = request.generation;
      run.seed = RunSeed(parts_.plan.experiment, request, replicate);
      run.spec = specs.Encode(run.seed);
      run.spec_hash = SpecHash(std::string_view(run.spec).substr(specs.head().size()), of_head);

      const auto stored = stored_ahead_.find(run.id);
      if (stored == stored_ahead_.end()) {
        submissions.push_back({run.id, run.spec, length});
        evaluation.runs.push_back({std::move(run), false});
      } else {
        if (stored->second.spec != run.spec) {
          return Error{
              ErrorKind::kCorrupt,
              fmt::format(
                  "run {} is stored with another spec than the search asks for: the campaign was made by "
                  "another version, or its files were changed",
                  proto::RunText(run.id))};
        }
        TRY(static_cast<RunOutcome&>(stored->second),
            OutcomeOf(stored->second, parts_.search.WantsMetrics(), parts_.search.WantsWays()));
        stored->second.spec.clear();
        stored->second.result.clear();
        evaluation.runs.push_back({std::move(stored->second), true});
        stored_ahead_.erase(stored);
      }
    }
    evaluation.request = std::move(request);
    Answer(evaluation);
    pending_.push_back(std::move(evaluation));
  }
  at_backend_ += submissions.size();
  if (!submissions.empty()) parts_.backend.Submit(std::move(submissions));
  return Ok{};
}

// An evaluation may be told much later, in its turn.
void SearchDriver::Answer(const PendingEvaluation& evaluation) const {
  if (parts_.feed == nullptr || !std::ranges::all_of(evaluation.runs, std::mem_fn(&PendingRun::durable)))
    return;
  std::vector<const StoredRun*> runs;
  for (const PendingRun& pending : evaluation.runs) runs.push_back(&pending.run);
  parts_.feed->Answer(evaluation.request, runs);
}

SearchDriver::PendingEvaluation* SearchDriver::FindEvaluation(RunId id) {
  // Runs of pending evaluations are numbered without gaps, each evaluation holding `replicates` of them.
  const auto holder = std::partition_point(
      pending_.begin(), pending_.end(),
      [id](const PendingEvaluation& evaluation) { return evaluation.runs.back().run.id < id; });
  return holder == pending_.end() || id < holder->runs.front().run.id ? nullptr : &*holder;
}

SearchDriver::PendingRun* SearchDriver::Find(RunId id) {
  PendingEvaluation* holder = FindEvaluation(id);
  return holder == nullptr ? nullptr : &holder->runs[id - holder->runs.front().run.id];
}

void SearchDriver::Store(FinishedRun finished) {
  PendingRun* pending = Find(finished.id);
  GAUNTLET_CHECK(pending != nullptr && !pending->durable, fmt::format("run {} finished twice", finished.id));
  StoredRun& run = pending->run;
  --at_backend_;
  if (has_generations_) ticks_[run.individual] = static_cast<double>(finished.result.ticks);
  if (parts_.on_run) parts_.on_run(run, finished);
  proto::EncodedSpec spec = std::exchange(run.spec, {});  // for the store alone
  run.message = finished.result.message;
  run.hash = finished.result.hash;
  run.worker = std::move(finished.worker);
  run.attempt = finished.attempt;
  run.verdict = finished.result.verdict;
  run.fitness = finished.result.fitness;
  run.total_failure = finished.result.failure.total;
  run.failure_type = finished.result.failure.type;
  StoredRun stored = run;
  stored.spec = std::move(spec);
  // Encoded anew: what a worker may have put in beside the result is not stored.
  stored.result = KeepsWays(parts_.plan.experiment)
                      ? proto::EncodeRunResult(finished.result, proto::TrajectoryEncoding::kLeaveOut)
                      : proto::EncodeWithoutWays(finished.result);
  parts_.store.AddRun(std::move(stored));
  if (parts_.search.WantsMetrics()) run.effects = SideEffectsOf(finished.result);
  if (parts_.search.WantsMetrics()) run.metrics = std::move(finished.result.metrics);
  if (parts_.search.WantsWays()) run.robots = std::move(finished.result.robots);
}

void SearchDriver::Committed(RunId id) {
  PendingRun* pending = Find(id);
  GAUNTLET_CHECK(pending != nullptr, fmt::format("run {} was committed but never asked for", id));
  pending->durable = true;
  totals_.Count(pending->run);
  Answer(*FindEvaluation(id));
}

void SearchDriver::TellCompleted() {
  while (!pending_.empty()) {
    PendingEvaluation& evaluation = pending_.front();
    // From the end, where what is missing usually stands: evaluations of thousands of runs are looked at
    // often.
    if (!std::all_of(evaluation.runs.rbegin(), evaluation.runs.rend(), std::mem_fn(&PendingRun::durable)))
      return;
    std::vector<RunOutcome> outcomes;
    for (PendingRun& pending : evaluation.runs) {
      digest_.Add(pending.run);
      outcomes.push_back(std::move(pending.run));
    }
    const EvaluationOutcome outcome =
        OutcomeOfRuns(evaluation.request.individual, evaluation.request.evaluation, std::move(outcomes));
    last_told_ = evaluation.runs.back().run.id;
    pending_.pop_front();
    parts_.search.Tell(outcome);
    if (parts_.search.AtBoundary()) SaveState();
  }
}

void SearchDriver::SaveState() {
  parts_.store.AddIndividuals(id(), parts_.search.TakeNewborns());
  SavedState state;
  state.search = id();
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
  best_fitness_ = kNone;
  std::map<IndividualId, double> ticks;
  for (const Individual& individual : parts_.search.Population()) {
    if (const auto known = ticks_.find(individual.id); known != ticks_.end()) ticks.insert(*known);
    if (!std::isfinite(individual.fitness)) continue;
    best_fitness_ = std::fmin(best_fitness_, individual.fitness);
    sum += individual.fitness;
    ++counted;
  }
  mean_fitness_ = counted > 0 ? sum / counted : kNone;
  ticks_ = std::move(ticks);
}

Status SearchDriver::Advance() {
  TellCompleted();
  TRY(Ask());
  TellCompleted();  // what a former session had stored may complete evaluations at once
  // A stream may learn that it has ended when all is told.
  if (finished() && saved_until_ < last_told_) SaveState();
  return Ok{};
}

std::uint64_t SearchDriver::runs_planned() const {
  if (parts_.search.Stream() != nullptr) return last_asked_ - (RunIdOf(id(), 1) - 1);
  return parts_.search.Progress().evaluations_planned *
         static_cast<std::uint64_t>(parts_.plan.experiment.search.replicates);
}

}  // namespace gauntlet
